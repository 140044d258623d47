#include "point_bundle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../../math/hypotenuse.hpp"
#include "../prescription/glass_resonances.hpp"
#include "plane_waves.hpp"
#include "wavefront.hpp"

namespace realcam {

PointBundle::PointBundle(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, double film_distance,
                         const RayLoop& loop, int probe_rays)
    : mirrored(lens.is_rotational() && !field.film && (lens.iris.blades == 0 || lens.is_wide_open())),
      object(with_known_glasses(lens, wavelength_nm), wavelength_nm, field),
      path_(lens, LightDirection::to_film, wavelength_nm, film_path_ends(lens, LightDirection::to_film)),
      open_(AimingPath::open(path_)),
      real_(AimingPath::real(path_)) {
    index = lens.indices(wavelength_nm).back();
    wave_number = 2e6 * std::numbers::pi * index / wavelength_nm;
    const FieldRays rays = probe(lens, wavelength_nm, field, probe_rays, loop);  // may increase probe_rays
    plane_ = rays.on_film(rays.chief, film_distance).z;
    chief_entry = rays.chief.entry;
    const FilmRay at_chief = on_film(rays.chief.origin, rays.chief.direction, rays.chief.path);
    chief = {mirrored ? 0 : at_chief.at.x, at_chief.at.y};
    chief_path_ = at_chief.path;
    chief_direction_ = at_chief.direction;
    curvature_ = wavefront_detail::reference_curvature(lens, wavelength_nm, rays, film_distance, ExitPupil::real);
    if (!std::isfinite(curvature_))
        throw InputError("psf: the exit pupil of lens \"" + lens.name + "\" lies in the film plane");
    measure(rays, probe_rays);
}

WaveRay PointBundle::as_wave(const FilmRay& ray) const {
    const Vec2<double> q = ray.at;
    const double tilt = chief_direction_.x * q.x + chief_direction_.y * q.y, square = q.x * q.x + q.y * q.y;
    // |q + R d| - R and its gradient, with d the chief ray's direction, in a form that also holds for R = infinity.
    const double root = std::sqrt(1 + curvature_ * (2 * tilt + curvature_ * square));
    const double sphere = (2 * tilt + curvature_ * square) / (1 + root);
    const Vec2<double> slope = {ray.direction.x - (chief_direction_.x + curvature_ * q.x) / root,
                                ray.direction.y - (chief_direction_.y + curvature_ * q.y) / root};
    return {slope, ray.path - sphere - slope.x * q.x - slope.y * q.y};
}

double PointBundle::energy(Entry entry) const {
    const double d = object.inverse_distance;
    return std::pow(1 + (entry.x * entry.x + entry.y * entry.y) * d * d, -1.5);
}

const LensSystem& PointBundle::with_known_glasses(const LensSystem& lens, double wavelength_nm) {
    check_wavelength_in_glasses(lens, wavelength_nm, "psf");
    return lens;
}

FieldRays PointBundle::probe(const LensSystem& lens, double wavelength_nm, const FieldPoint& field, int& probe_rays,
                             const RayLoop& loop) {
    try {
        FieldRays rays = field_rays(lens, wavelength_nm, field, square_grid(probe_rays, loop), loop);
        std::size_t passing = 0;
        for (std::size_t i = 0; i < rays.rays.size(); ++i) passing += rays.passes(i);
        if (passing >= min_passing(probe_rays)) return rays;
    } catch (const InputError&) {
        // If a denser probe cannot help, field_rays throws the same error again below.
    }
    probe_rays = kDenseProbeRays;
    return field_rays(lens, wavelength_nm, field, square_grid(probe_rays, loop), loop);
}

void PointBundle::measure(const FieldRays& rays, int probe_rays) {
    Entry low = {kInfinity, kInfinity}, high = {-kInfinity, -kInfinity};
    Vec2<double> stop_low = low, stop_high = high;  // in units of the stop's radius
    slope_low = low, slope_high = high;
    spot = centroid = {0, 0};
    double weight = 0;
    for (std::size_t i = 0; i < rays.rays.size(); ++i) {
        if (!rays.passes(i)) continue;
        const AimedRay& ray = rays.rays[i];
        const auto widen = [](Vec2<double>& lowest, Vec2<double>& highest, Vec2<double> v) {
            lowest = {std::min(lowest.x, v.x), std::min(lowest.y, v.y)};
            highest = {std::max(highest.x, v.x), std::max(highest.y, v.y)};
        };
        widen(low, high, ray.entry);
        widen(stop_low, stop_high, {rays.pattern[i].x, rays.pattern[i].y});
        const FilmRay found = from_chief(true, ray.origin, ray.direction, ray.path);
        widen(slope_low, slope_high, as_wave(found).slope);
        spot = {std::max(spot.x, std::fabs(found.at.x)), std::max(spot.y, std::fabs(found.at.y))};
        centroid = {centroid.x + found.at.x, centroid.y + found.at.y};
        weight += 1;
    }
    centroid = {centroid.x / weight, centroid.y / weight};
    middle = {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    // Margin beyond the outermost rays, and a small one in case all rays lie on one line. The light may continue by
    // almost a cell of the probe on either side.
    const double min_margin = 1e-3 * hypotenuse(high.x - low.x, high.y - low.y);
    const auto half_side = [&](double extent, double extent_on_stop) {
        const double cells = 0.5 * probe_rays * extent_on_stop;  // between the outermost rays
        const double margin = std::max(2.0 / probe_rays, cells > 0.5 ? 2 / cells : 0.0);
        return (1 + margin) * 0.5 * extent + min_margin;
    };
    if (mirrored) middle.x = centroid.x = 0;
    reach = {half_side(high.x - low.x, stop_high.x - stop_low.x), half_side(high.y - low.y, stop_high.y - stop_low.y)};
}

FilmRay PointBundle::on_film(Vec3d origin, Vec3d direction, double path) const {
    const double parameter = (plane_ - origin.z) / direction.z, n = length(direction);
    const Vec3d at = origin + parameter * direction;
    return {true, {at.x, at.y}, (1 / n) * direction, path / index + parameter * n};
}

FilmRay PointBundle::from_chief(bool passes, Vec3d origin, Vec3d direction, double path) const {
    FilmRay ray = on_film(origin, direction, path);
    ray.passes = passes;
    ray.at = {ray.at.x - chief.x, ray.at.y - chief.y};
    ray.path -= chief_path_;
    return ray;
}

namespace {

/// Number of segments of a smooth edge between two neighbouring scan lines.
constexpr int kSegmentsPerEdge = 8;

/// Point on the edge of the light, with the slope of its wave.
struct EdgePoint {
    PointBundle::Entry entry;
    Vec2<double> slope;
};

/// Traces the ray at distance r of a scan line.
EdgePoint edge_point(const PointBundle& bundle, const QuadratureArm& arm, double r) {
    const PointBundle::Entry entries[1] = {arm.at(bundle, r)};
    FilmRay found[1];
    bundle.trace(entries, found);
    return {entries[0], bundle.as_wave(found[0]).slope};
}

/// Returns the mirror image of a point, at -x.
EdgePoint mirrored(const EdgePoint& p) {
    return {{-p.entry.x, p.entry.y}, {-p.slope.x, p.slope.y}};
}

/// Interpolates between the middle two of four equally spaced points, by the cubic through them; t from 0 to 1.
EdgePoint between(const std::array<EdgePoint, 4>& p, double t) {
    const double weight[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                              (t + 1) * t * (t - 1) / 6};
    EdgePoint point{{0, 0}, {0, 0}};
    for (int k = 0; k < 4; ++k) {
        const EdgePoint& from = p[static_cast<std::size_t>(k)];
        point.entry = {point.entry.x + weight[k] * from.entry.x, point.entry.y + weight[k] * from.entry.y};
        point.slope = {point.slope.x + weight[k] * from.slope.x, point.slope.y + weight[k] * from.slope.y};
    }
    return point;
}

/// Returns the edge of the light as segments that join its points on neighbouring radial scan lines. Where the edge
/// continues on both sides, it is subdivided by cubic interpolation: the area of a polygon of 32 straight segments
/// would be 0.6% too small. An interval that exists on only one of the two lines is closed by a segment along that
/// line. `lines`: scan lines; those of a mirrored bundle cover half of it.
std::vector<EdgePiece> edge_segments(const PointBundle& bundle, const std::vector<QuadratureArm>& lines) {
    // Inner and outer edge of each interval. If the light begins at the centre, the inner edges coincide there.
    using Edges = std::vector<std::array<EdgePoint, 2>>;
    std::vector<Edges> arms;
    for (const QuadratureArm& arm : lines) {
        Edges edges;
        for (const RadialInterval& interval : arm.intervals)
            edges.push_back({edge_point(bundle, arm, interval.from), edge_point(bundle, arm, interval.to)});
        arms.push_back(std::move(edges));
    }
    if (bundle.mirrored)
        for (std::size_t s = lines.size(); s-- > 0;) {
            Edges edges = arms[s];
            for (auto& edge : edges) edge = {mirrored(edge[0]), mirrored(edge[1])};
            arms.push_back(std::move(edges));
        }
    std::vector<EdgePiece> segments;
    const auto add = [&](const EdgePoint& a, const EdgePoint& b) {
        if (a.entry.x != b.entry.x || a.entry.y != b.entry.y)
            segments.push_back({{a.entry, b.entry}, {a.slope, b.slope}});
    };
    for (std::size_t s = 0; s < arms.size(); ++s) {
        const auto at = [&](std::size_t k) -> const Edges& { return arms[(s + k) % arms.size()]; };
        const Edges &before = at(arms.size() - 1), &here = at(0), &next = at(1), &beyond = at(2);
        const std::size_t paired = std::min(here.size(), next.size());
        const std::size_t smooth = std::min({before.size(), paired, beyond.size()});
        for (std::size_t i = 0; i < paired; ++i)
            for (std::size_t side : {0, 1}) {
                const int parts = i < smooth ? kSegmentsPerEdge : 1;
                EdgePoint from = here[i][side];
                for (int k = 1; k <= parts; ++k) {
                    const EdgePoint to = k == parts
                                             ? next[i][side]
                                             : between({before[i][side], here[i][side], next[i][side], beyond[i][side]},
                                                       static_cast<double>(k) / parts);
                    add(from, to);
                    from = to;
                }
            }
        for (const Edges* longer : {&here, &next})
            for (std::size_t i = paired; i < longer->size(); ++i) add((*longer)[i][0], (*longer)[i][1]);
    }
    return segments;
}

/// Returns the distance behind the film plane at which two rays close to the chief ray, on opposite sides of it, cross,
/// mm; NaN if one of them does not reach the film. Their distance from the chief ray is a thousandth of the bundle's
/// half-side: the error due to aberrations decreases with its square, and rounding stays below 1e-10 of the focus.
double close_focus(const PointBundle& bundle, bool tangential) {
    const double step = 1e-3 * std::max(bundle.reach.x, bundle.reach.y);
    const PointBundle::Entry chief = bundle.chief_entry;
    const PointBundle::Entry entries[2] = {{chief.x + (tangential ? 0 : step), chief.y + (tangential ? step : 0)},
                                           {chief.x - (tangential ? 0 : step), chief.y - (tangential ? step : 0)}};
    FilmRay rays[2];
    bundle.trace(entries, rays);
    if (!rays[0].passes || !rays[1].passes) return std::numeric_limits<double>::quiet_NaN();
    const auto height = [&](const FilmRay& ray) { return tangential ? ray.at.y : ray.at.x; };
    const auto rise = [&](const FilmRay& ray) {
        return (tangential ? ray.direction.y : ray.direction.x) / ray.direction.z;
    };
    return -(height(rays[0]) - height(rays[1])) / (rise(rays[0]) - rise(rays[1]));
}

}  // namespace

TracedBundle traced_bundle(const PointBundle& bundle, BundleSampling sampling, const RayLoop& loop) {
    const std::vector<QuadratureArm> arms = quadrature_arms(bundle, sampling.arms, loop);
    const std::vector<QuadratureRay> parts = quadrature_rays(bundle, arms, sampling.nodes);
    TracedBundle result{{}, edge_segments(bundle, arms), close_focus(bundle, true), close_focus(bundle, false)};
    loop.append_all(result.rays, parts.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const PointBundle::Entry entries[1] = {parts[i].entry};
            FilmRay found[1];
            bundle.trace(entries, found);
            const std::optional<LocalWave> local = local_wave(bundle, parts[i].entry);
            const double density = bundle.energy(parts[i].entry);
            result.rays[i] = {parts[i].entry,
                              parts[i].area * density,
                              found[0].at,
                              found[0].direction,
                              bundle.as_wave(found[0]),
                              local ? std::sqrt(density / std::fabs(local->determinant())) : 0.0};
        }
    });
    double sum = 0;
    for (const BundleRay& ray : result.rays) sum += ray.energy;
    for (BundleRay& ray : result.rays) ray.energy *= (bundle.mirrored ? 0.5 : 1) / sum;
    if (!bundle.mirrored) return result;
    const std::size_t half = result.rays.size();
    for (std::size_t i = 0; i < half; ++i) {
        BundleRay ray = result.rays[i];
        ray.entry.x = -ray.entry.x;
        ray.at.x = -ray.at.x;
        ray.direction.x = -ray.direction.x;
        ray.wave.slope.x = -ray.wave.slope.x;
        result.rays.push_back(ray);
    }
    return result;
}

}  // namespace realcam
