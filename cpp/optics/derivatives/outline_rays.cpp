#include "outline_rays.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../trace/open_iris.hpp"

namespace realcam {

OutlineRays::OutlineRays(const LensSystem& lens, double wavelength_nm)
    : lens_(lens, LightDirection::to_scene, wavelength_nm, film_path_ends(lens, LightDirection::to_scene)),
      view_(lens_.view()),
      film_distance_(lens.film_distance),
      squared_index_(lens_.entry_index * lens_.entry_index),
      stop_index_(lens.stop_index()) {
    for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
        if (!lens.surfaces[k].aperture_shape.is_plain())
            throw InputError("derivatives of pictures need circular apertures; surface " + std::to_string(k + 1) +
                             " of lens \"" + lens.name + "\" has one of another shape");
    stop_is_rim_ = view_.iris.blades == 0;
    if (stop_is_rim_) return;
    // An opening inside the rim scales with the radius, so that these differences are exact.
    const double rim = lens.stop().clear_semi_diameter, step = 1e-3 * lens.stop_semi_diameter;
    const auto at = [&](double change) { return open_iris(lens.iris, lens.stop_semi_diameter + change, rim); };
    apothem_rate_ = (at(step).apothem - at(-step).apothem) / (2 * step);
    curvature_rate_ = (at(step).curvature - at(-step).curvature) / (2 * step);
}

OutlineRays::Edge OutlineRays::edge_at(const SurfaceView<double>& surface, Vec2d at) const {
    const double radius = hypotenuse(at.x, at.y);
    const Vec2d outwards = radius > 0 ? Vec2d{at.x / radius, at.y / radius} : Vec2d{1, 0};
    const bool is_stop = surface.surface_index == stop_index_;
    Edge edge{std::sqrt(surface.rim_squared) - radius, outwards, is_stop && stop_is_rim_ ? 1.0 : 0.0};
    if (surface.hole_squared > 0) {
        const double distance = radius - std::sqrt(surface.hole_squared);
        if (distance < edge.distance) edge = {distance, {-outwards.x, -outwards.y}, 0};
    }
    if (!surface.has_blades) return edge;
    // The opening of cross_iris: f = q (r^2 + h^2) + 2 (1 - q h) a - 2 h is negative inside.
    const Iris<double>& iris = view_.iris;
    int blade = 0;
    double extent = -std::numeric_limits<double>::max();
    for (int i = 0; i < iris.blades; ++i) {
        const double a = at.x * iris.cos[i] + at.y * iris.sin[i];
        if (a > extent) extent = a, blade = i;
    }
    const double h = iris.apothem, q = iris.curvature, bend = 2 * (1 - q * h);
    const double f = q * (radius * radius + h * h) + bend * extent - 2 * h;
    const Vec2d gradient = {2 * q * at.x + bend * iris.cos[blade], 2 * q * at.y + bend * iris.sin[blade]};
    const double inverse = 1 / hypotenuse(gradient.x, gradient.y), distance = -f * inverse;
    if (distance >= edge.distance) return edge;
    const double f_rate = curvature_rate_ * (radius * radius + h * h) + 2 * q * h * apothem_rate_ -
                          2 * (curvature_rate_ * h + q * apothem_rate_) * extent - 2 * apothem_rate_;
    return {distance, {inverse * gradient.x, inverse * gradient.y}, -f_rate * inverse};
}

TangentPath::Rays OutlineRays::start(const DirectionLine (&lines)[kLanes], const double (&t)[kLanes]) const {
    TangentPath::Rays rays;
    for (int i = 0; i < kLanes; ++i) {
        const DirectionLine& line = lines[i];
        const Vec2d q = {line.start.x + t[i] * line.step.x, line.start.y + t[i] * line.step.y};
        const double squared_z = squared_index_ - q.x * q.x - q.y * q.y;
        const bool exists = squared_z > 0;
        const Vec3d along = exists ? Vec3d{q.x, q.y, -std::sqrt(squared_z)} : Vec3d{0, 0, -std::sqrt(squared_index_)};
        rays.status[i] = exists ? 0 : static_cast<int>(RayStatus::vignetted);
        rays.origin.set(i, {line.film.x, line.film.y, film_distance_});
        rays.direction.set(i, along);
        rays.direction_tangent.set(
            i, {line.step.x, line.step.y, -(along.x * line.step.x + along.y * line.step.y) / along.z});
    }
    return rays;
}

// target_clones compiles only inlined code for each instruction set, hence `flatten`.
__attribute__((flatten)) REALCAM_CLONES void OutlineRays::trace(const DirectionLine (&lines)[kLanes],
                                                                const double (&t)[kLanes],
                                                                const WavelengthsInDouble* wavelengths,
                                                                int (&passes)[kLanes]) const {
    TangentPath::Rays rays = start(lines, t);
    auto& without_tangents = static_cast<LensRays<double, kLanes>&>(rays);
    if (wavelengths)
        trace_lens(view_, without_tangents, NoRecord{}, *wavelengths);
    else
        trace_lens(view_, without_tangents);
    for (int i = 0; i < kLanes; ++i) passes[i] = rays.status[i] == 0;
}

OutlineRays::NearestRim OutlineRays::nearest_rim(const std::vector<TangentPath::Crossing>& crossings, int lane) const {
    NearestRim nearest{{std::numeric_limits<double>::max(), {1, 0}, 0}, 0, 0};
    for (int k = 0; k < view_.count; ++k) {
        const Vec3d at = crossings[static_cast<std::size_t>(k)].origin[lane];
        const Edge edge = edge_at(view_.surfaces[k], {at.x, at.y});
        if (edge.distance < nearest.edge.distance) nearest = {edge, k, 0};
    }
    const auto& crossing = crossings[static_cast<std::size_t>(nearest.surface)];
    const Vec3d p = crossing.direction[lane], moved = crossing.origin_tangent[lane];
    const double rise = moved.z / p.z;
    const Vec2d normal = nearest.edge.normal;
    nearest.speed = normal.x * (moved.x - rise * p.x) + normal.y * (moved.y - rise * p.y);
    return nearest;
}

__attribute__((flatten)) REALCAM_CLONES void OutlineRays::measure(const DirectionLine (&lines)[kLanes],
                                                                  const double (&t)[kLanes],
                                                                  const WavelengthsInDouble* wavelengths,
                                                                  double (&clearance)[kLanes]) const {
    TangentPath::Rays with_tangents = start(lines, t);
    auto& rays = static_cast<LensRays<double, kLanes>&>(with_tangents);
    for (double& distance : clearance) distance = std::numeric_limits<double>::max();
    for (int k = 0; k < view_.count; ++k) {
        const SurfaceView<double>& surface = view_.surfaces[k];
        if (view_.free.frames && view_.free.frames[k].before.changes) change_frame(view_.free.frames[k].before, rays);
        const FreeformView<double>* freeform = view_.free.freeforms ? view_.free.freeforms + k : nullptr;
        SurfaceView<double> without_rim = surface;
        without_rim.rim_squared = std::numeric_limits<double>::max();
        without_rim.hole_squared = -1;
        without_rim.has_blades = 0;
        const LensView<double> one{&without_rim, 1, LensKind::any, {}, {nullptr, freeform, nullptr}};
        if (wavelengths)
            trace_lens<LensKind::any>(one, rays, NoRecord{},
                                      WavelengthsInDouble{wavelengths->surfaces + k, wavelengths->variable});
        else
            trace_lens<LensKind::any>(one, rays);
        const double rim = std::sqrt(surface.rim_squared);
        if (surface.has_blades || surface.hole_squared > 0) {
            for (int i = 0; i < kLanes; ++i)
                clearance[i] = std::min(clearance[i], edge_at(surface, {rays.origin.x[i], rays.origin.y[i]}).distance);
        } else {
            REALCAM_LANES
            for (int i = 0; i < kLanes; ++i) {
                const double x = rays.origin.x[i], y = rays.origin.y[i], distance = rim - std::sqrt(x * x + y * y);
                clearance[i] = select(distance < clearance[i], distance, clearance[i]);
            }
        }
    }
    for (int i = 0; i < kLanes; ++i)
        if (rays.status[i] != 0) clearance[i] = -std::numeric_limits<double>::infinity();
}

bool OutlineRays::refine(const DirectionLine (&lines)[kLanes], const WavelengthsInDouble* wavelengths,
                         const double (&low)[kLanes], const double (&high)[kLanes], const int (&low_passes)[kLanes],
                         double (&t)[kLanes]) const {
    constexpr int kSteps = 8;
    constexpr double kError = 1e-8;  // of the interval
    double open[kLanes], shut[kLanes], last[kLanes], last_clearance[kLanes], clearance[kLanes];
    for (int i = 0; i < kLanes; ++i) {
        open[i] = low_passes[i] ? low[i] : high[i], shut[i] = low_passes[i] ? high[i] : low[i];
        last[i] = open[i], t[i] = shut[i];
    }
    measure(lines, last, wavelengths, last_clearance);
    bool is_done = false;
    for (int step = 0; step < kSteps && !is_done; ++step) {
        measure(lines, t, wavelengths, clearance);
        is_done = true;
        for (int i = 0; i < kLanes; ++i) {
            (clearance[i] > 0 ? open : shut)[i] = t[i];
            // The secant method, and a halving where it leaves the interval.
            double next = t[i] - clearance[i] * (t[i] - last[i]) / (clearance[i] - last_clearance[i]);
            if (clearance[i] == 0) next = t[i];
            const bool is_inside = (next - open[i]) * (next - shut[i]) <= 0;
            last[i] = t[i], last_clearance[i] = clearance[i];
            t[i] = is_inside ? next : 0.5 * (open[i] + shut[i]);
            // The error of a step is about the product of the last two, in units of the pupil.
            is_done = is_done && std::fabs(t[i] - last[i]) <= 1e-5 * std::fabs(high[i] - low[i]);
        }
    }
    // Rays on both sides prove the edge.
    int passes[kLanes], blocked[kLanes];
    for (int i = 0; i < kLanes; ++i) {
        const double error = kError * (low_passes[i] ? high[i] - low[i] : low[i] - high[i]);
        open[i] = t[i] - error, shut[i] = t[i] + error;
    }
    trace(lines, open, wavelengths, passes);
    trace(lines, shut, wavelengths, blocked);
    for (int i = 0; i < kLanes; ++i)
        if (high[i] > low[i] && (!passes[i] || blocked[i])) return false;
    return true;
}

int OutlineRays::find(const TangentPath& path, const DirectionLine (&lines)[kLanes], double end,
                      const WavelengthsInDouble* wavelengths, OutlinePoint (&points)[kMostPoints][kLanes]) const {
    constexpr int kProbes = 6;  // intervals in which one change is sought
    constexpr int kHalvings = 26;  // leave 1e-8 of an interval, also where no rim is
    for (auto& lanes : points)
        for (OutlinePoint& point : lanes) point = {};
    double low[kMostPoints][kLanes], high[kMostPoints][kLanes];
    int low_passes[kMostPoints][kLanes], counts[kLanes] = {}, last[kLanes], most = 0;
    double t[kLanes] = {};
    trace(lines, t, wavelengths, last);
    for (int probe = 1; probe <= kProbes; ++probe) {
        int passes[kLanes];
        for (double& at : t) at = end * probe / kProbes;
        trace(lines, t, wavelengths, passes);
        for (int i = 0; i < kLanes; ++i) {
            if (passes[i] != last[i] && counts[i] < kMostPoints) {
                const int n = counts[i]++;
                low[n][i] = end * (probe - 1) / kProbes, high[n][i] = t[i], low_passes[n][i] = last[i];
                most = std::max(most, n + 1);
            }
            last[i] = passes[i];
        }
    }
    int unexplained = 0;
    for (int n = 0; n < most; ++n) {
        for (int i = 0; i < kLanes; ++i)
            if (counts[i] <= n) low[n][i] = high[n][i] = 0, low_passes[n][i] = 1;
        if (!refine(lines, wavelengths, low[n], high[n], low_passes[n], t)) {
            for (int halving = 0; halving < kHalvings; ++halving) {
                int passes[kLanes];
                for (int i = 0; i < kLanes; ++i) t[i] = 0.5 * (low[n][i] + high[n][i]);
                trace(lines, t, wavelengths, passes);
                for (int i = 0; i < kLanes; ++i) (passes[i] == low_passes[n][i] ? low : high)[n][i] = t[i];
            }
            for (int i = 0; i < kLanes; ++i) t[i] = low_passes[n][i] ? low[n][i] : high[n][i];
        }
        TangentPath::Rays rays = start(lines, t);
        std::vector<TangentPath::Crossing> crossings;
        path.record(rays, crossings, wavelengths);
        for (int i = 0; i < kLanes; ++i) {
            if (counts[i] <= n) continue;
            const NearestRim rim = nearest_rim(crossings, i);
            const Vec3d p = crossings[static_cast<std::size_t>(rim.surface)].direction[i];
            // Rays that are flatter than a steep surface pass its rim's plane outside the rim if they pass the surface
            // inside it.
            const double side = (rim.speed > 0) == (low_passes[n][i] != 0) ? 1 : -1;
            const Vec2d normal = {side * rim.edge.normal.x, side * rim.edge.normal.y};
            OutlinePoint& point = points[n][i];
            point = {t[i],
                     rim.surface,
                     {normal.x, normal.y, -(normal.x * p.x + normal.y * p.y) / p.z},
                     rim.edge.stop_rate,
                     1 / std::fabs(rim.speed),
                     rays.origin[i],
                     rays.direction[i]};
            // The edge is known to 1e-8 of the pupil's size.
            const double size = std::sqrt(view_.surfaces[point.surface].rim_squared);
            if (!(std::fabs(rim.edge.distance) < 1e-5 * size) || !std::isfinite(point.inverse_speed)) {
                point = {};
                ++unexplained;
            }
        }
    }
    return unexplained;
}

}  // namespace realcam
