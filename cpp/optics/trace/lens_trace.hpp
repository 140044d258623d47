#pragma once
#include <type_traits>

#include "asphere.hpp"
#include "freeform_search.hpp"
#include "index_cubic.hpp"
#include "lens_rays.hpp"
#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

/// Record of a trace, in addition to the rays. `NoRecord` is for rendering: rays that end are only marked, as vignetted
/// whatever the cause, and their origin and direction are then undefined (NaN at worst).
struct NoRecord {
    static constexpr bool enabled = false;
};
/// `PathRecord` is for analysis: exact causes, and a ray that ends keeps its last direction and lies on the last
/// surface that it hit.
template <class T, int N>
struct PathRecord {
    static constexpr bool enabled = true;
    Lanes<T, N> optical_path;  ///< sum of index times distance, mm; from the origin to the last surface hit
    Lanes<int, N> surface_index;  ///< surface at which the ray ended, in the lens system's order
};

/// Rays with a larger parameter count as misses. Its square still fits in float32.
template <class T>
inline constexpr T kFarthest = T(1e18);

/// Takes one lane across a surface whose intersection is known: rim, hole, refraction, coating, status.
template <LensKind lens_kind, class T, int N, class Boundary, class Record>
REALCAM_INLINE void cross_surface(const SurfaceView<T>& surface, const Boundary& boundary, LensRays<T, N>& rays,
                                  Record& record, int lane, Vec3<T> o, Vec3<T> p, SurfaceHit<T> hit, int failure) {
    const Vec3<T> at = o + hit.parameter * p;
    const T r2 = at.x * at.x + at.y * at.y;
    const Refraction<T> refracted =
        refract(p, hit.normal, hit.along_normal, boundary.squared_index_change(lane), surface.direction_sign_out);
    if constexpr (Boundary::is_coated) boundary.pass(lane, hit.along_normal, sqrt_or_zero(refracted.radicand));

    const int before = rays.status[lane];
    const bool alive = before == static_cast<int>(RayStatus::ok);
    const bool clear = (r2 <= surface.rim_squared) & ((lens_kind == LensKind::plain) | (r2 >= surface.hole_squared));
    // A ray parallel to a plane meets it at infinity. Plain lenses already reject it by rim and near cap.
    constexpr bool always_near = lens_kind == LensKind::plain && !Record::enabled;
    const bool met = alive & hit.met() & (always_near | (std::fabs(hit.parameter) <= kFarthest<T>));
    const bool passes = met & clear & (refracted.radicand >= T(0));
    if constexpr (Record::enabled) {
        const int cause = select(met,
                                 select(clear, static_cast<int>(RayStatus::total_internal_reflection),
                                        static_cast<int>(RayStatus::vignetted)),
                                 failure);
        rays.origin.set(lane, select(met, at, o));
        rays.direction.set(lane, select(passes, refracted.direction, p));
        rays.status[lane] = select(alive & !passes, cause, before);
        record.optical_path[lane] += select(met, surface.index_squared * hit.parameter, T(0));
        record.surface_index[lane] = select(alive, surface.surface_index, record.surface_index[lane]);
    } else {
        rays.origin.set(lane, at);
        rays.direction.set(lane, refracted.direction);
        rays.status[lane] = select(passes, before, static_cast<int>(RayStatus::vignetted));
    }
}

template <LensKind lens_kind, class T, int N, class Boundary, class Record>
REALCAM_HD inline void cross_sphere(const SurfaceView<T>& surface, const Boundary& boundary, LensRays<T, N>& rays,
                                    Record& record) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        Vec3<T> o = rays.origin[i];
        const Vec3<T> p = rays.direction[i];
        o.z -= surface.shift;
        const SurfaceHit<T> hit = intersect_sphere(o, p, surface.curvature, surface.direction_sign_in);
        cross_surface<lens_kind>(surface, boundary, rays, record, i, o, p, hit, static_cast<int>(RayStatus::missed));
    }
}

template <class T, int N, class Boundary, class Record>
REALCAM_HD inline void cross_conic(const SurfaceView<T>& surface, const Boundary& boundary, LensRays<T, N>& rays,
                                   Record& record) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        Vec3<T> o = rays.origin[i];
        const Vec3<T> p = rays.direction[i];
        o.z -= surface.shift;
        const T approach = to_vertex_plane(o, p);
        SurfaceHit<T> hit =
            intersect_conic(o + approach * p, p, surface.curvature, surface.conic_factor, surface.direction_sign_in);
        hit.parameter += approach;
        cross_surface<LensKind::rotational>(surface, boundary, rays, record, i, o, p, hit,
                                            static_cast<int>(RayStatus::missed));
    }
}

/// Intersections of N rays with an asphere.
template <class T, int N>
struct AsphereHits {
    Lanes<T, N> parameter;
    Lanes<T, N> slope;  ///< d height / d r, over r
    Lanes<T, N> slack;  ///< tolerance minus residual of the search
};

/// Newton's method without a bracket, for the rays that cross the surface once. All other rays, and those that do not
/// reach their tolerance, get a slack that is NaN or negative. Returns the number of these rays that are still alive.
template <class T, int N>
REALCAM_HD inline int find_single_crossings(const SurfaceView<T>& surface, const LensRays<T, N>& rays,
                                            AsphereHits<T, N>& hits) {
    Lanes<T, N> per_height, plane, change, spread, height, inverse_rise;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const HeightRay<T> ray = height_ray(surface, rays.origin[i], rays.direction[i]);
        T inverse = 0;
        const T z = start_height(surface, ray, inverse);
        // NaN never meets its tolerance, but does not keep the other lanes searching.
        height[i] = select(crosses_once(surface, ray), z, std::numeric_limits<T>::quiet_NaN());
        inverse_rise[i] = inverse;
        per_height[i] = ray.per_height;
        plane[i] = ray.plane, change[i] = ray.change, spread[i] = ray.spread;
    }
    int left = 0;
    for (int count = 0; count < kHeightSteps; ++count) {
        int searching = 0;
        left = 0;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const HeightRay<T> ray{per_height[i], plane[i], change[i], spread[i]};
            const Vec3<T> o = rays.origin[i];
            // Evaluated at the point to which the ray will be moved: the normal has to belong to that point, however
            // far away o is.
            const T parameter = (height[i] - o.z) * per_height[i];
            const Vec3<T> at = o + parameter * rays.direction[i];
            const T z = at.z, from = o.z;
            const Sag<T> sag = asphere_sag(surface, at.x * at.x + at.y * at.y);
            const T f = z - sag.height, slope = T(2) * sag.derivative;
            const T rise = T(1) - slope * surface.search_squared * ray.half_derivative(z);
            // A Newton step for the reciprocal, instead of a division.
            const T inverse = inverse_rise[i] * (T(2) - rise * inverse_rise[i]);
            // The tolerance of improve_search without its lateral part.
            const T slack = T(4) * std::numeric_limits<T>::epsilon() *
                                (std::fabs(from) + std::fabs(z - from) + sag.size +
                                 T(0.0625) * (surface.sag_max - surface.sag_min)) -
                            std::fabs(f);
            hits.parameter[i] = parameter;
            hits.slope[i] = slope;
            hits.slack[i] = slack;
            height[i] = select(slack < T(0), z - f * inverse, height[i]);
            inverse_rise[i] = inverse;
            const int alive = static_cast<int>(rays.status[i] == 0);
            searching |= alive & static_cast<int>(slack < T(0));
            left += alive & static_cast<int>(!(slack >= T(0)));
        }
        if (searching == 0) break;
    }
    return left;
}

/// Bracketed search for the rays whose crossing is not yet found. They are compacted into consecutive lanes, so that a
/// few rays take little time and many are vectorised.
template <class T, int N>
REALCAM_HD inline void search_in_brackets(const SurfaceView<T>& surface, const LensRays<T, N>& rays,
                                          AsphereHits<T, N>& hits) {
    // Zero-initialised, because gcc warns of lanes that may be read before they are written.
    AsphereSearch<T, N> search{};
    Vec3Lanes<T, N> origin{}, direction{};
    Lanes<T, N> outside{};
    int lane_of[N], count = 0;
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] != 0 || hits.slack[i] >= T(0)) continue;
        origin.set(count, rays.origin[i]);
        direction.set(count, rays.direction[i]);
        lane_of[count++] = i;
    }
    REALCAM_LANES
    for (int i = 0; i < count; ++i)
        outside[i] = begin_search(surface, origin[i], direction[i], search.t[i], search.below[i], search.above[i]);
    for (int i = 0; i < count; ++i) {
        if (!(outside[i] > T(0))) continue;
        const bool found =
            find_bracket(surface, origin[i], direction[i], search.t[i], search.below[i], search.above[i]);
        // A ray that passes outside the search radius hits the surface's continuation, and is vignetted there.
        const bool through = outside[i] < kSideways<T> / 2;
        if (!found && !through) search.t[i] = search.below[i] = search.above[i] = std::numeric_limits<T>::quiet_NaN();
    }
    for (int step = 0; step < kMaxAsphereSteps<T>; ++step) {
        const bool halve = step >= kNewtonSteps && step % 2 == 0;
        int searching = 0;
        REALCAM_LANES
        for (int i = 0; i < count; ++i) {
            improve_search(surface, origin[i], direction[i], halve, search.t[i], search.below[i], search.above[i],
                           search.residual[i], search.tolerance[i]);
            searching |= static_cast<int>(search.residual[i] > search.tolerance[i]);
        }
        if (searching == 0) break;
    }
    for (int i = 0; i < count; ++i) {
        const int lane = lane_of[i];
        const Vec3<T> at = origin[i] + search.t[i] * direction[i];
        hits.parameter[lane] = search.t[i];
        hits.slope[lane] = T(2) * asphere_sag(surface, at.x * at.x + at.y * at.y).derivative;
        hits.slack[lane] = search.tolerance[i] - search.residual[i];
    }
}

template <class T, int N, class Boundary, class Record>
REALCAM_HD inline void cross_asphere(const SurfaceView<T>& surface, const Boundary& boundary, LensRays<T, N>& rays,
                                     Record& record) {
    int ended = 0;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.origin.z[i] -= surface.shift;
        ended += static_cast<int>(rays.status[i] != 0);
    }
    if (ended == N) return;
    AsphereHits<T, N> hits;
    if (find_single_crossings(surface, rays, hits) > 0) search_in_brackets(surface, rays, hits);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3<T> o = rays.origin[i];
        const Vec3<T> p = rays.direction[i];
        const SurfaceHit<T> hit = asphere_hit(surface, o, p, hits.parameter[i], hits.slope[i], hits.slack[i]);
        // Without a bracket the slack is NaN.
        const int failure = select(hits.slack[i] < T(0), static_cast<int>(RayStatus::no_convergence),
                                   static_cast<int>(RayStatus::missed));
        cross_surface<LensKind::rotational>(surface, boundary, rays, record, i, o, p, hit, failure);
    }
}

template <class T, int N, class Boundary, class Record>
REALCAM_HD inline void cross_freeform(const SurfaceView<T>& surface, const FreeformView<T>& form,
                                      const Boundary& boundary, LensRays<T, N>& rays, Record& record) {
    int ended = 0;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.origin.z[i] -= surface.shift;
        ended += static_cast<int>(rays.status[i] != 0);
    }
    if (ended == N) return;
    FreeformHits<T, N> hits;
    find_freeform_crossings(surface, form, rays, hits);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3<T> p = rays.direction[i];
        const SurfaceHit<T> hit = freeform_hit(surface.direction_sign_in, p, hits.parameter[i], hits.slope_x[i],
                                               hits.slope_y[i], hits.slack[i]);
        const int failure = select(hits.slack[i] < T(0), static_cast<int>(RayStatus::no_convergence),
                                   static_cast<int>(RayStatus::missed));
        cross_surface<LensKind::any>(surface, boundary, rays, record, i, rays.origin[i], p, hit, failure);
    }
}

/// Blocks rays that hit an iris blade. The opening is bounded by n equal arcs of curvature q, whose midpoints have the
/// distance h from the axis. A point is open if q (r^2 + h^2) + 2 (1 - q h) a - 2 h <= 0, where a is its largest extent
/// towards any blade.
template <class T, int N>
REALCAM_HD inline void cross_iris(const Iris<T>& iris, LensRays<T, N>& rays) {
    Lanes<T, N> extent;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) extent[i] = -std::numeric_limits<T>::max();
    for (int blade = 0; blade < iris.blades; ++blade) {
        const T cos = iris.cos[blade], sin = iris.sin[blade];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T a = rays.origin.x[i] * cos + rays.origin.y[i] * sin;
            extent[i] = select(a > extent[i], a, extent[i]);
        }
    }
    const T h = iris.apothem, q = iris.curvature;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const T r2 = rays.origin.x[i] * rays.origin.x[i] + rays.origin.y[i] * rays.origin.y[i];
        const bool open = q * (r2 + h * h) + T(2) * (T(1) - q * h) * extent[i] - T(2) * h <= T(0);
        rays.status[i] = select((rays.status[i] == 0) & !open, static_cast<int>(RayStatus::vignetted), rays.status[i]);
    }
}

template <class T, int N>
REALCAM_HD inline void change_frame(const FrameChange<T>& change, LensRays<T, N>& rays) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        rays.origin.set(i, change.point(rays.origin[i]));
        rays.direction.set(i, change.direction(rays.direction[i]));
    }
}

/// Traces N rays through a lens, surface by surface.
///
/// Origins are relative to the vertex of the first surface in the order of the light on entry, and to the vertex of the
/// last one on return. Directions are optical ones in the lens frame, before and after (LensPath::entry_index). For
/// lenses that are not centred, and for other frames, see LensPath.
/// Rays whose status is not ok on entry stay ended. There is no branch on a lane, so that the compiler vectorises the
/// loops. `lens_kind`: the lens's own, or one further down in the enumeration. `media`: OneWavelength, ManyWavelengths
/// or CoatedMedia.
template <LensKind lens_kind, class T, int N, class Record = NoRecord, class Media = OneWavelength>
REALCAM_HD inline void trace_lens(const LensView<T>& lens, LensRays<T, N>& rays, Record&& record = {},
                                  const Media& media = {}) {
    for (int k = 0; k < lens.count; ++k) {
        const SurfaceView<T> surface = lens.surfaces[k];  // a copy: lane stores cannot alias it
        const auto boundary = media.at(surface, k);
        if constexpr (lens_kind == LensKind::any) {
            if (lens.free.frames && lens.free.frames[k].before.changes) {
                const FrameChange<T> before = lens.free.frames[k].before;
                change_frame(before, rays);
            }
        }
        if (lens_kind == LensKind::plain) {
            cross_sphere<lens_kind>(surface, boundary, rays, record);
        } else {
            switch (surface.kind) {
                case SurfaceShape::sphere: cross_sphere<lens_kind>(surface, boundary, rays, record); break;
                case SurfaceShape::conic: cross_conic(surface, boundary, rays, record); break;
                case SurfaceShape::asphere: cross_asphere(surface, boundary, rays, record); break;
                case SurfaceShape::freeform:
                    if constexpr (lens_kind == LensKind::any)
                        cross_freeform(surface, lens.free.freeforms[k], boundary, rays, record);
                    break;
            }
            if (surface.has_blades) cross_iris(lens.iris, rays);
            if constexpr (lens_kind == LensKind::any)
                if (lens.free.apertures && lens.free.apertures[k].is_shaped)
                    cross_aperture(lens.free.apertures[k], rays.origin, rays.status,
                                   static_cast<int>(RayStatus::vignetted));
        }
        // With a record, the origin of a ray that has ended must still become relative to the last vertex.
        if constexpr (N == 1 && !std::remove_reference_t<Record>::enabled)
            if (rays.status[0] != 0) return;
    }
    if constexpr (lens_kind == LensKind::any) {
        if (lens.free.frames && lens.count > 0 && lens.free.frames[lens.count - 1].out.changes) {
            const FrameChange<T> out = lens.free.frames[lens.count - 1].out;
            change_frame(out, rays);
        }
    }
}

/// Traces N rays through a lens whose kind is known only at run time.
template <class T, int N, class Record = NoRecord, class Media = OneWavelength>
REALCAM_HD inline void trace_lens(const LensView<T>& lens, LensRays<T, N>& rays, Record&& record = {},
                                  const Media& media = {}) {
    if (lens.kind == LensKind::any)
        trace_lens<LensKind::any>(lens, rays, record, media);
    else
        trace_lens<LensKind::rotational>(lens, rays, record, media);
}

}  // namespace REALCAM_NAMESPACE
