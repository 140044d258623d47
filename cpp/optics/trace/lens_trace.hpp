#pragma once
#include <type_traits>

#include "asphere.hpp"
#include "freeform_search.hpp"
#include "index_cubic.hpp"
#include "lens_rays.hpp"
#include "lens_view.hpp"
#include "refraction.hpp"

namespace REALCAM_NAMESPACE {

// Sequential ray trace through a lens, surface by surface, for N rays at once. In this folder o is a ray's origin in
// the frame of the surface's vertex, mm, p its optical direction (see refraction.hpp), and t the parameter of o + t p.

/// Record of a trace, in addition to the rays. `NoRecord` is for rendering: the status of a ray that ends is vignetted
/// whatever the cause, and its origin and direction are then undefined (NaN at worst).
struct NoRecord {
    static constexpr bool enabled = false;
};
/// `PathRecord` is for analysis: exact causes, and a ray that ends keeps its last direction and lies on the last
/// surface that it hit.
template <class T, int N>
struct PathRecord {
    static constexpr bool enabled = true;
    Lanes<T, N> optical_path;  ///< sum of index times distance, mm; from the origin to the last surface hit
    Lanes<int, N>
        surface_index;  ///< surface at which the ray ended, else the last one; from 0 at the front of the lens
};

/// Largest ray parameter of an intersection, mm; rays with a larger one count as misses. Its square still fits in
/// float32.
template <class T>
inline constexpr T kFarthest = T(1e18);

/// Continues one ray behind a surface whose intersection `hit` is known: tests the rim and the hole, refracts the ray,
/// multiplies its transmittance (Boundary::pass of a coated surface), and sets its origin, direction and status.
/// `boundary`: what the media policy of trace_lens returned for this surface. `o`, `p`: origin and optical direction of
/// the incoming ray. `failure`: RayStatus of a ray without an intersection.
template <LensKind lens_kind, class T, int N, class Boundary, class Record>
REALCAM_INLINE void cross_surface(const SurfaceView<T>& surface, const Boundary& boundary, LensRays<T, N>& rays,
                                  Record& record, int lane, Vec3<T> o, Vec3<T> p, SurfaceHit<T> hit, int failure) {
    const Vec3<T> point = o + hit.parameter * p;
    const T r2 = point.x * point.x + point.y * point.y;
    const Refraction<T> refracted =
        refract(p, hit.normal, hit.along_normal, boundary.squared_index_change(lane), surface.direction_sign_out);
    if constexpr (Boundary::is_coated) boundary.pass(lane, hit.along_normal, sqrt_or_zero(refracted.radicand));

    const int status_before = rays.status[lane];
    const bool alive = status_before == static_cast<int>(RayStatus::ok);
    const bool clear = (r2 <= surface.rim_squared) & ((lens_kind == LensKind::plain) | (r2 >= surface.hole_squared));
    // A ray parallel to a plane meets it at infinity. In spherical lenses the tests of the rim and of SurfaceHit::met
    // already reject it.
    constexpr bool always_near = lens_kind == LensKind::plain && !Record::enabled;
    const bool met = alive & hit.met() & (always_near | (std::fabs(hit.parameter) <= kFarthest<T>));
    const bool passes = met & clear & (refracted.radicand >= T(0));
    if constexpr (Record::enabled) {
        const int cause = select(met,
                                 select(clear, static_cast<int>(RayStatus::total_internal_reflection),
                                        static_cast<int>(RayStatus::vignetted)),
                                 failure);
        rays.origin.set(lane, select(met, point, o));
        rays.direction.set(lane, select(passes, refracted.direction, p));
        rays.status[lane] = select(alive & !passes, cause, status_before);
        record.optical_path[lane] += select(met, surface.index_squared * hit.parameter, T(0));
        record.surface_index[lane] = select(alive, surface.surface_index, record.surface_index[lane]);
    } else {
        rays.origin.set(lane, point);
        rays.direction.set(lane, refracted.direction);
        rays.status[lane] = select(passes, status_before, static_cast<int>(RayStatus::vignetted));
    }
}

/// Traces N rays through a sphere or plane.
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

/// Traces N rays through a conic of revolution.
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
    Lanes<T, N> parameter;  ///< ray parameter of the intersection, mm
    Lanes<T, N> slope;  ///< (d sag / d r) / r = 2 d sag / d (r^2), 1/mm
    Lanes<T, N> slack;  ///< tolerance minus residual of the search, mm; negative or NaN: no intersection is found
};

/// Intersects the rays that certainly cross the surface exactly once, by Newton's method without a bracket. With z as
/// the variable, r^2 is a quadratic in z on the ray (HeightRay), and the root of f(z) = z - sag(r^2(z)) is searched
/// for. All other rays, and those that do not reach their tolerance, get a slack that is NaN or negative. Returns the
/// number of these rays whose status is ok.
template <class T, int N>
REALCAM_HD inline int find_single_crossings(const SurfaceView<T>& surface, const LensRays<T, N>& rays,
                                            AsphereHits<T, N>& hits) {
    // The members of the HeightRay of each lane, the current z, and about 1 / (df/dz) there.
    Lanes<T, N> per_height, constant, linear, quadratic, height, inverse_rise;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const HeightRay<T> ray = height_ray(surface, rays.origin[i], rays.direction[i]);
        T inverse = 0;
        const T z = start_height(surface, ray, inverse);
        // A height of NaN never reaches its tolerance, and does not prolong the loop of the other lanes either.
        height[i] = select(crosses_once(surface, ray), z, std::numeric_limits<T>::quiet_NaN());
        inverse_rise[i] = inverse;
        per_height[i] = ray.per_height;
        constant[i] = ray.constant, linear[i] = ray.linear, quadratic[i] = ray.quadratic;
    }
    int unresolved = 0;
    for (int count = 0; count < kHeightSteps; ++count) {
        int searching = 0;
        unresolved = 0;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const HeightRay<T> ray{per_height[i], constant[i], linear[i], quadratic[i]};
            const Vec3<T> o = rays.origin[i];
            // The sag is evaluated at the rounded point to which the ray will be moved: the normal has to belong to
            // that point, however far away o is.
            const T parameter = (height[i] - o.z) * per_height[i];
            const Vec3<T> point = o + parameter * rays.direction[i];
            const T z = point.z, from = o.z;
            const Sag<T> sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
            const T f = z - sag.height, slope = T(2) * sag.derivative;
            // df/dz. Its reciprocal is updated by a Newton step instead of a division.
            const T rise = T(1) - slope * surface.search_squared * ray.half_derivative(z);
            const T inverse = inverse_rise[i] * (T(2) - rise * inverse_rise[i]);
            // The tolerance of improve_search without its lateral part, and so a stricter one.
            const T slack = kRoundingErrors<T> * (std::fabs(from) + std::fabs(z - from) + sag.size +
                                                  kSagRangeWeight<T> * (surface.sag_max - surface.sag_min)) -
                            std::fabs(f);
            hits.parameter[i] = parameter;
            hits.slope[i] = slope;
            hits.slack[i] = slack;
            height[i] = select(slack < T(0), z - f * inverse, height[i]);
            inverse_rise[i] = inverse;
            const int alive = static_cast<int>(rays.status[i] == 0);
            searching |= alive & static_cast<int>(slack < T(0));
            unresolved += alive & static_cast<int>(!(slack >= T(0)));
        }
        if (searching == 0) break;
    }
    return unresolved;
}

/// Searches, with brackets, for the intersections of the rays whose slack is still negative or NaN. These rays are
/// compacted into consecutive lanes, so that a few rays take little time and many are vectorised.
template <class T, int N>
REALCAM_HD inline void search_in_brackets(const SurfaceView<T>& surface, const LensRays<T, N>& rays,
                                          AsphereHits<T, N>& hits) {
    // Zero-initialised, because gcc warns of lanes that may be read before they are written.
    AsphereSearch<T, N> search{};
    Vec3Lanes<T, N> origin{}, direction{};
    Lanes<T, N> outside{};
    int lane_of[N], count = 0;  // lane in `rays` of each compacted ray, and their number
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
        // Without a bracket on the surface itself, the search goes on with that of begin_search. It ends on the
        // surface's continuation outside the search radius, where the ray is vignetted. For sideways rays that bracket
        // need not hold a crossing in the required direction: they count as misses.
        const bool is_sideways = !(outside[i] < kSideways<T> / 2);
        if (!found && is_sideways)
            search.t[i] = search.below[i] = search.above[i] = std::numeric_limits<T>::quiet_NaN();
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
        const Vec3<T> point = origin[i] + search.t[i] * direction[i];
        hits.parameter[lane] = search.t[i];
        hits.slope[lane] = T(2) * asphere_sag(surface, point.x * point.x + point.y * point.y).derivative;
        hits.slack[lane] = search.tolerance[i] - search.residual[i];
    }
}

/// Traces N rays through an even asphere.
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
        // A slack of NaN means that there is no bracket.
        const int failure = select(hits.slack[i] < T(0), static_cast<int>(RayStatus::no_convergence),
                                   static_cast<int>(RayStatus::missed));
        cross_surface<LensKind::rotational>(surface, boundary, rays, record, i, o, p, hit, failure);
    }
}

/// Traces N rays through a freeform surface.
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

/// Blocks rays that hit an iris blade: their status becomes vignetted. Origins lie in the plane of the stop. The
/// opening is bounded by n equal arcs of curvature q, whose midpoints have the distance h from the axis. A point is
/// open if q (r^2 + h^2) + 2 (1 - q h) a - 2 h <= 0, where a is its largest extent towards any blade.
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

/// Transforms the origins and directions of N rays to another frame.
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
/// Axes are those of the lens frame. On entry, origins are relative to the vertex of the first surface in the order of
/// the light; on return, to that of the last one. Directions have the length of the refractive index of their medium,
/// on entry LensPath::entry_index. For lenses that are not centred, and for other frames, see LensPath.
///
/// Rays whose status is not ok on entry are not traced. No branch depends on a lane, so that the compiler vectorises
/// the loops.
///
/// `lens_kind`: the lens's own kind, or a more general one, which gives the same rays. `media`: policy that supplies
/// the refractive indices and coatings of each surface: OneWavelength, ManyWavelengths or CoatedMedia.
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
