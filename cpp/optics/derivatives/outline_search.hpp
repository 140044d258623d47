#pragma once
#include <cmath>
#include <limits>

#include "tangent_trace.hpp"

namespace REALCAM_NAMESPACE {

// Search for points of the outline of a lens's pupil by real rays, on every device.

/// Line of directions at a film point, along which the edge of the pupil is searched: optical direction cosines
/// start + t step towards the scene, in the film's frame.
struct DirectionLine {
    Vec2d film;  ///< film point, mm
    Vec2d start, step;
};

/// Point of the pupil's outline at a film point: a ray that grazes a rim, and passes all others.
struct OutlinePoint {
    double t = 0;  ///< position on the line; 0: no point was found
    int surface = 0;  ///< index of the surface on the path towards the scene
    /// Tangent of the ray's optical direction, in the surface's frame, for TangentPath::trace: its x and y are the unit
    /// normal of the rim, towards the rays that it blocks.
    Vec3d tangent = {0, 0, 0};
    double stop_rate = 0;  ///< motion of the rim along the normal per growth of the diaphragm's radius; 0 except on it
    double rim_rate = 0;  ///< motion of the rim along the normal per growth of the rims' scale (RimDistance)
    double inverse_speed = 0;  ///< inverse of the speed, per t, with which the ray moves across the rim, 1/mm
    Vec3d origin = {0, 0, 0}, direction = {0, 0, 0};  ///< ray in front of the lens, in the camera's frame: mm, optical
                                                      ///< direction
};

/// Largest number of outline points on one line that are found: a pupil with a central obstruction has two.
inline constexpr int kMostOutlinePoints = 2;

/// Lens with the data for the search of its pupil's outline.
struct OutlineLens {
    LensView<double> lens;  ///< for light from the film to the scene
    double film_distance, squared_index;  ///< of the film, mm, and of the medium in front of it
    bool stop_is_rim;  ///< the diaphragm is round
    int stop_index;
    double apothem_rate, curvature_rate;  ///< rates of the blades, per growth of the diaphragm's radius

    /// Starts rays with tangents along the lines at t.
    template <int N>
    REALCAM_INLINE TangentRays<N> start(const DirectionLine (&lines)[N], const double (&t)[N]) const {
        TangentRays<N> rays;
        for (int i = 0; i < N; ++i) {
            const DirectionLine& line = lines[i];
            const Vec2d q = {line.start.x + t[i] * line.step.x, line.start.y + t[i] * line.step.y};
            const double squared_z = squared_index - q.x * q.x - q.y * q.y;
            const bool exists = squared_z > 0;
            const Vec3d along =
                exists ? Vec3d{q.x, q.y, -std::sqrt(squared_z)} : Vec3d{0, 0, -std::sqrt(squared_index)};
            rays.status[i] = exists ? 0 : static_cast<int>(RayStatus::vignetted);
            rays.origin.set(i, {line.film.x, line.film.y, film_distance});
            rays.direction.set(i, along);
            rays.tangents[0].direction.set(i, tangent_of_cosines(along, line.step));
        }
        return rays;
    }
};

/// Distance of a point to the nearest edge of a surface's opening: positive inside.
struct RimDistance {
    double distance;
    Vec2d normal;  ///< unit vector, away from the opening
    double stop_rate;  ///< see OutlinePoint
    /// Motion per growth of a common factor of the rims of all surfaces but the stop; 0 on the stop and at central
    /// obstructions.
    double rim_rate;

    /// `at`: x and y in the surface's frame, mm.
    REALCAM_HD RimDistance(const OutlineLens& lens, const SurfaceView<double>& surface, Vec2d at) {
        const double radius = std::sqrt(at.x * at.x + at.y * at.y);
        const Vec2d outwards = radius > 0 ? Vec2d{at.x / radius, at.y / radius} : Vec2d{1, 0};
        distance = std::sqrt(surface.rim_squared) - radius;
        normal = outwards;
        const bool is_stop = surface.surface_index == lens.stop_index;
        stop_rate = is_stop && lens.stop_is_rim ? 1 : 0;
        rim_rate = is_stop ? 0 : std::sqrt(surface.rim_squared);
        if (surface.hole_squared > 0) {
            const double from_hole = radius - std::sqrt(surface.hole_squared);
            if (from_hole < distance)
                distance = from_hole, normal = {-outwards.x, -outwards.y}, stop_rate = rim_rate = 0;
        }
        if (surface.has_blades) meet_blades(lens, radius, at);
    }

private:
    /// Moves the edge to that of the blades where it is nearer. The opening of cross_iris:
    /// f = q (r^2 + h^2) + 2 (1 - q h) a - 2 h is negative inside.
    REALCAM_HD void meet_blades(const OutlineLens& lens, double radius, Vec2d at) {
        const Iris<double>& iris = lens.lens.iris;
        int blade = 0;
        double extent = -std::numeric_limits<double>::max();
        for (int i = 0; i < iris.blades; ++i) {
            const double a = at.x * iris.cos[i] + at.y * iris.sin[i];
            if (a > extent) extent = a, blade = i;
        }
        const double h = iris.apothem, q = iris.curvature, bend = 2 * (1 - q * h);
        const double f = q * (radius * radius + h * h) + bend * extent - 2 * h;
        const Vec2d gradient = {2 * q * at.x + bend * iris.cos[blade], 2 * q * at.y + bend * iris.sin[blade]};
        const double inverse = 1 / std::sqrt(gradient.x * gradient.x + gradient.y * gradient.y);
        if (-f * inverse >= distance) return;
        const double f_rate = lens.curvature_rate * (radius * radius + h * h) + 2 * q * h * lens.apothem_rate -
                              2 * (lens.curvature_rate * h + q * lens.apothem_rate) * extent - 2 * lens.apothem_rate;
        distance = -f * inverse;
        normal = {inverse * gradient.x, inverse * gradient.y};
        stop_rate = -f_rate * inverse;
    }
};

/// Sets `clearance` to the distance of each line's ray at t from the nearest edge, mm: positive for rays that pass, and
/// minus infinity for rays that miss a surface or are totally reflected. `surfaces`: those of the same lens, without
/// rims; `media(k)`: policy of trace_lens for surface k.
template <LensKind kind, int N, class MediaAt>
REALCAM_HD inline void measure_clearance(const OutlineLens& lens, const TangentLens& surfaces, MediaAt&& media,
                                         const DirectionLine (&lines)[N], const double (&t)[N],
                                         double (&clearance)[N]) {
    TangentRays<N> with_tangents = lens.start(lines, t);
    auto& rays = static_cast<LensRays<double, N>&>(with_tangents);
    for (double& distance : clearance) distance = std::numeric_limits<double>::max();
    for (int k = 0; k < surfaces.count; ++k) {
        const TangentSurface& surface = surfaces.surfaces[k];
        const SurfaceView<double>& opening = lens.lens.surfaces[k];
        if (surface.before.changes) change_frame(surface.before, rays);
        cross_surface<kind>(surface, media(k), rays);
        if (opening.has_blades || opening.hole_squared > 0) {
            for (int i = 0; i < N; ++i) {
                const double distance = RimDistance(lens, opening, {rays.origin.x[i], rays.origin.y[i]}).distance;
                clearance[i] = select(distance < clearance[i], distance, clearance[i]);
            }
        } else {
            const double rim = std::sqrt(opening.rim_squared);
            REALCAM_LANES
            for (int i = 0; i < N; ++i) {
                const double x = rays.origin.x[i], y = rays.origin.y[i], distance = rim - std::sqrt(x * x + y * y);
                clearance[i] = select(distance < clearance[i], distance, clearance[i]);
            }
        }
    }
    for (int i = 0; i < N; ++i)
        if (rays.status[i] != 0) clearance[i] = -std::numeric_limits<double>::infinity();
}

/// Rim that is nearest to a ray, and its edge there.
struct NearestRim {
    double distance = std::numeric_limits<double>::max();  ///< see RimDistance
    double stop_rate = 0, rim_rate = 0;  ///< see OutlinePoint
    int surface = 0;  ///< see OutlinePoint
    Vec3d tangent = {0, 0, 0};
    double speed = 0;  ///< with which the ray approaches the edge in the rim's plane, per t, mm
};

/// Finds the nearest rims of N rays with tangents along their lines, and traces them to the front of the lens.
/// `record`: see find_outline.
template <int N, class Record>
REALCAM_GPU_CALL void find_nearest_rims(const OutlineLens& lens, Record& record, TangentRays<N>& rays,
                                        NearestRim (&rims)[N]) {
    for (NearestRim& rim : rims) rim = {};
    record(rays, [&](int k, const auto& origins, const auto& directions, const auto& tangents) {
        for (int i = 0; i < N; ++i) {
            const Vec3d at = origins[i];
            const RimDistance edge(lens, lens.lens.surfaces[k], {at.x, at.y});
            if (!(edge.distance < rims[i].distance)) continue;
            const Vec3d p = directions[i], moved = tangents[i];
            const double rise = moved.z / p.z;
            NearestRim& rim = rims[i];
            rim.distance = edge.distance;
            rim.surface = k;
            rim.tangent = tangent_of_cosines(p, edge.normal);
            rim.speed = edge.normal.x * (moved.x - rise * p.x) + edge.normal.y * (moved.y - rise * p.y);
            // A rim that grows along a curved surface also moves along z.
            const double in_plane = std::fabs(rim.speed / (edge.normal.x * moved.x + edge.normal.y * moved.y));
            rim.stop_rate = in_plane * edge.stop_rate, rim.rim_rate = in_plane * edge.rim_rate;
        }
    });
}

/// Interval of a line in which light begins or ends to pass; both ends are 0 for a lane without one.
struct EdgeInterval {
    double low, high;
    bool low_passes;

    REALCAM_INLINE double open() const { return low_passes ? low : high; }
    REALCAM_INLINE double shut() const { return low_passes ? high : low; }
};

/// Finds the edges in intervals by the secant method, and sets t. Returns false if an edge is not known to 1e-8 of its
/// interval: where no rim explains it, or an interval has several edges. `trace`, `measure`: see find_outline.
template <int N, class Trace, class Measure>
REALCAM_HD inline bool refine_edges(const DirectionLine (&lines)[N], const EdgeInterval (&edges)[N], Trace& trace,
                                    Measure& measure, double (&t)[N]) {
    constexpr int kSteps = 8;
    constexpr double kError = 1e-8;  // of the interval
    double open[N], shut[N], last[N], last_clearance[N], clearance[N];
    for (int i = 0; i < N; ++i) {
        open[i] = last[i] = edges[i].open();
        shut[i] = t[i] = edges[i].shut();
    }
    measure(lines, last, last_clearance);
    bool is_done = false;
    for (int step = 0; step < kSteps && !is_done; ++step) {
        measure(lines, t, clearance);
        is_done = true;
        for (int i = 0; i < N; ++i) {
            (clearance[i] > 0 ? open : shut)[i] = t[i];
            // The secant method, and a halving where it leaves the interval.
            double next = t[i] - clearance[i] * (t[i] - last[i]) / (clearance[i] - last_clearance[i]);
            if (clearance[i] == 0) next = t[i];
            const bool is_inside = (next - open[i]) * (next - shut[i]) <= 0;
            last[i] = t[i], last_clearance[i] = clearance[i];
            t[i] = is_inside ? next : 0.5 * (open[i] + shut[i]);
            // The error of a step is about the product of the last two, in units of the pupil.
            is_done = is_done && std::fabs(t[i] - last[i]) <= 1e-5 * std::fabs(edges[i].high - edges[i].low);
        }
    }
    // Rays on both sides prove the edge.
    int passes[N], blocked[N];
    for (int i = 0; i < N; ++i) {
        const double error = kError * (edges[i].shut() - edges[i].open());
        open[i] = t[i] - error, shut[i] = t[i] + error;
    }
    trace(lines, open, passes);
    trace(lines, shut, blocked);
    bool is_edge = true;
    for (int i = 0; i < N; ++i)
        if (edges[i].high > edges[i].low) is_edge = is_edge && passes[i] && !blocked[i];
    return is_edge;
}

/// Searches N lines from t = 0 to `end` for points of the outline. Returns the number of edges that no rim explains,
/// such as those of total internal reflection. `trace(lines, t, passes)` sets `passes` to 1 for each lane whose ray at
/// t passes the lens, else to 0. `measure(lines, t, clearance)` is measure_clearance. `record(rays, visit)` traces rays
/// and their tangents to the front of the lens, and calls visit(k, origins, directions, tangents of the origins) for
/// each surface.
template <int N, class Trace, class Measure, class Record>
REALCAM_HD inline int find_outline(const OutlineLens& lens, const DirectionLine (&lines)[N], double end, Trace&& trace,
                                   Measure&& measure, Record&& record, OutlinePoint (&points)[kMostOutlinePoints][N]) {
    constexpr int kProbes = 6;  // intervals in which one change is sought
    constexpr int kHalvings = 26;  // leave 1e-8 of an interval, also where no rim is
    for (auto& lanes : points)
        for (OutlinePoint& point : lanes) point = {};
    EdgeInterval edges[kMostOutlinePoints][N];
    int counts[N] = {}, last[N], most = 0;
    double t[N] = {};
    trace(lines, t, last);
    for (int probe = 1; probe <= kProbes; ++probe) {
        int passes[N];
        for (double& at : t) at = end * probe / kProbes;
        trace(lines, t, passes);
        for (int i = 0; i < N; ++i) {
            if (passes[i] != last[i] && counts[i] < kMostOutlinePoints) {
                const int n = counts[i]++;
                edges[n][i] = {end * (probe - 1) / kProbes, t[i], last[i] != 0};
                most = most > n + 1 ? most : n + 1;
            }
            last[i] = passes[i];
        }
    }
    int unexplained = 0;
    for (int n = 0; n < most; ++n) {
        for (int i = 0; i < N; ++i)
            if (counts[i] <= n) edges[n][i] = {0, 0, true};
        if (!refine_edges(lines, edges[n], trace, measure, t)) {
            for (int halving = 0; halving < kHalvings; ++halving) {
                int passes[N];
                for (int i = 0; i < N; ++i) t[i] = 0.5 * (edges[n][i].low + edges[n][i].high);
                trace(lines, t, passes);
                for (int i = 0; i < N; ++i) {
                    EdgeInterval& edge = edges[n][i];
                    ((passes[i] != 0) == edge.low_passes ? edge.low : edge.high) = t[i];
                }
            }
            for (int i = 0; i < N; ++i) t[i] = edges[n][i].open();
        }
        TangentRays<N> rays = lens.start(lines, t);
        NearestRim rims[N];
        find_nearest_rims(lens, record, rays, rims);
        for (int i = 0; i < N; ++i) {
            if (counts[i] <= n) continue;
            const NearestRim& rim = rims[i];
            // The edge is known to 1e-8 of the pupil's size.
            const double size = std::sqrt(lens.lens.surfaces[rim.surface].rim_squared);
            const double inverse_speed = 1 / std::fabs(rim.speed);
            // Rays that are flatter than a steep surface pass its rim's plane outside the rim if they pass the surface
            // inside it.
            const double side = (rim.speed > 0) == edges[n][i].low_passes ? 1 : -1;
            if (std::fabs(rim.distance) < 1e-5 * size && std::isfinite(inverse_speed) && std::isfinite(rim.rim_rate))
                points[n][i] = {t[i],         rim.surface,   side * rim.tangent, rim.stop_rate,
                                rim.rim_rate, inverse_speed, rays.origin[i],     rays.direction[i]};
            else
                ++unexplained;
        }
    }
    return unexplained;
}

}  // namespace REALCAM_NAMESPACE
