#pragma once
#include "../trace/lens_trace.hpp"
#include "surface_points.hpp"

namespace REALCAM_NAMESPACE {

// Derivatives at fixed scene rays. The map from the rays of the scene to those that reach the film is symplectic, so
// that each number of a camera has a Hamiltonian H(x, q): the change of the optical path between fixed ends, per change
// of the number, as a function of the film point x and the optical direction cosines q of the ray that arrives there.
// If the number changes, a fixed scene ray moves on the film by dx = -dH/dq and dq = dH/dx (Hamilton 1828; Stone and
// Forbes, "Differential ray tracing in inhomogeneous media", JOSA A 14, 2824, 1997, for the adjoint form). A rigid
// displacement v of a surface has H = -(p' - p) . v, a change of its sag s has H = -(p' - p)_z s, and a change of the
// refractive index of a medium has the length of the ray in the medium, where p and p' are the optical directions in
// front of and behind the surface.
//
// So one ray that is traced from the film, with its derivative (tangent) along a direction w of q, yields -w . dH/dq =
// w . dx by all numbers of the camera. Nothing of the ray must be stored. A ray that has a second tangent yields the
// derivatives by the camera's pose along another direction.

/// Index of the film as the start of rays; that of the last surface, whose rim they meet first, is 0.
inline constexpr int kStartOnFilm = -1;

/// Derivatives of the origins and optical directions of N rays along one direction in the space of rays.
template <int N>
struct RayTangents {
    Vec3Lanes<double, N> origin, direction;
};

/// N rays with M tangents each, in the frame of the current surface. The derivatives by the camera's pose are those
/// along the last tangent, and all others those along the first.
template <int N, int M = 1>
struct TangentRays : LensRays<double, N> {
    RayTangents<N> tangents[M];
};

/// Tangent of an optical direction whose x and y change by w, and whose length does not change.
REALCAM_INLINE Vec3d tangent_of_cosines(Vec3d direction, Vec2d w) {
    return {w.x, w.y, -(direction.x * w.x + direction.y * w.y) / direction.z};
}

/// Adds the contributions to -dH of the frame of the plane on which a ray starts. Adjoints are those of the frame's
/// origin and axes. `at`: the start point, which has no tangent; `direction_tangent`: tangent of the ray's optical
/// direction, in the direction of the trace towards the scene.
template <int N>
REALCAM_INLINE void add_start(Vec3d at, Vec3d direction_tangent, AdjointStep<N>& step, int lane) {
    // The ray's direction is opposite to that of the light, whose path to a displaced end grows by -p . v.
    step.add(kFrameOrigin, lane, direction_tangent);
    step.add(kFrameX, lane, at.x * direction_tangent);
    step.add(kFrameY, lane, at.y * direction_tangent);
    step.add(kFrameZ, lane, at.z * direction_tangent);
}

/// Computes the tangents of one ray behind a surface from those in front of it, and adds the contributions of the
/// surface's frame and numbers, and of the medium in front of it, to `step`. `o`, `p`: the ray in front of the surface;
/// `rays` holds the ray behind it and its tangents in front of it, both in the surface's frame. `index_squared`: that
/// of SurfaceView, in front of the surface.
///
/// The direction behind a surface is p' = p + k G, with the gradient G of the surface. Because |p| and |p'| are the
/// refractive indices, which the tangent does not change, dk = -k (dp . G + p' . dG) / (p' . G).
template <int N, int M, class SurfacePoint>
REALCAM_INLINE void push_tangents(const SurfacePoint& point, double index_squared, Vec3d o, Vec3d p,
                                  TangentRays<N, M>& rays, AdjointStep<N>& step, int lane) {
    const Vec3d at = rays.origin[lane], behind = rays.direction[lane];
    const Vec3d gradient = point.gradient(), bend = behind - p;
    const double t = dot(at - o, p) / dot(p, p);
    const double along = dot(behind, gradient), strength = dot(bend, gradient) / dot(gradient, gradient);
    REALCAM_UNROLL
    for (int m = 0; m < M; ++m) {
        RayTangents<N>& tangents = rays.tangents[m];
        const Vec3d tangent = tangents.direction[lane];
        const Vec3d moved = tangents.origin[lane] + t * tangent;
        const double t_tangent = -dot(gradient, moved) / dot(gradient, p);
        const Vec3d at_tangent = moved + t_tangent * p;
        const Vec3d gradient_tangent = point.point_adjoint(at_tangent);  // the second derivatives are symmetric
        // At the critical angle the derivative is infinite; it is replaced by 0.
        const double strength_tangent =
            select(along != 0, -strength * (dot(tangent, gradient) + dot(behind, gradient_tangent)) / along, 0.0);
        const Vec3d bend_tangent = strength_tangent * gradient + strength * gradient_tangent;
        tangents.origin.set(lane, at_tangent);
        tangents.direction.set(lane, tangent + bend_tangent);
        if (m > 0) continue;
        step.add(kFrameOrigin, lane, bend_tangent);
        step.add(kFrameX, lane, at_tangent.x * bend + at.x * bend_tangent);
        step.add(kFrameY, lane, at_tangent.y * bend + at.y * bend_tangent);
        step.add(kFrameZ, lane, at_tangent.z * bend + at.z * bend_tangent);
        // H by n is the length n t. The index of the ray's wavelength may differ from that of the view.
        step.add(kIndexSquared, lane, -0.5 * t_tangent * std::sqrt(dot(p, p) / index_squared));
        point.add_numbers(-strength * at_tangent, strength_tangent, step, lane);
    }
}

/// ManyWavelengths for rays in double precision.
struct WavelengthsInDouble {
    const IndexCubic* surfaces;  ///< n'^2 / n^2 - 1 of each surface, in the order of the trace
    const float* variable;  ///< value of the WavelengthVariable of each ray

    struct Boundary {
        ManyWavelengths::Boundary in_float;
        static constexpr bool is_coated = false;
        REALCAM_INLINE double squared_index_change(int lane) const {
            return static_cast<double>(in_float.squared_index_change(lane));
        }
    };
    template <class Surface>
    REALCAM_INLINE Boundary at(const Surface&, int index) const {
        return {{surfaces[index], variable}};
    }
};

/// Surface with the data for the tangents of rays that cross it.
struct TangentSurface {
    SurfaceView<double> traced;  ///< without rims
    SurfaceView<double> view;  ///< its kind is the one that the variables require
    FrameChange<double> before;  ///< from the frame of the previous surface to that of this one
    const FreeformView<double>* freeform;  ///< for FreeformTangents, in the host's memory; null unless it is one
};

/// Lens with the data for the tangents of rays from the film to the scene.
struct TangentLens {
    const TangentSurface* surfaces;
    int count;
    FrameChange<double> exit;  ///< from the last surface's frame to the camera's
};

/// Policy of trace_tangents for lenses without freeforms. Another one is FreeformTangents.
struct NoFreeforms {
    static constexpr bool enabled = false;
};

/// Calls f(point of the surface, lane) for the points of N rays. `forms`: NoFreeforms or FreeformTangents.
template <int N, class Forms, class F>
REALCAM_INLINE void for_surface_points(const TangentSurface& surface, const Vec3Lanes<double, N>& at,
                                       const Forms& forms, F&& f) {
    const SurfaceView<double> view = surface.view;
    if constexpr (Forms::enabled) {
        if (view.kind == SurfaceShape::freeform) {
            for (int i = 0; i < N; ++i) f(forms.point(at[i], i), i);
            return;
        }
    }
    if (view.kind == SurfaceShape::asphere) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) f(AspherePoint(view, at[i]), i);
    } else {
        // A sphere is a conic with the conic factor 1.
        REALCAM_LANES
        for (int i = 0; i < N; ++i) f(ConicPoint{view.curvature, view.conic_factor, at[i]}, i);
    }
}

/// Replaces rays that have missed a surface, or were totally reflected, by one that passes, without tangents. `o`,
/// `p`: rays in front of the surface. Returns false if no ray passes.
template <int N, int M>
REALCAM_HD inline bool replace_ended(TangentRays<N, M>& rays, Vec3Lanes<double, N>& o, Vec3Lanes<double, N>& p) {
    int passing = 0;
    while (passing < N && rays.status[passing] != 0) ++passing;
    if (passing == N) return false;
    for (int i = 0; i < N; ++i) {
        if (rays.status[i] == 0) continue;
        rays.origin.set(i, rays.origin[passing]);
        rays.direction.set(i, rays.direction[passing]);
        for (RayTangents<N>& tangents : rays.tangents)
            tangents.origin.set(i, {0, 0, 0}), tangents.direction.set(i, {0, 0, 0});
        rays.status[i] = 0;
        o.set(i, o[passing]);
        p.set(i, p[passing]);
    }
    return true;
}

/// Traces N rays, which are in a surface's frame, through this surface, which blocks none of them. `media`: policy of
/// trace_lens for this surface. Not REALCAM_INLINE: GCC's `flatten` stops at functions that are always inlined.
template <LensKind kind, int N, class Media>
REALCAM_HD inline void cross_surface(const TangentSurface& surface, const Media& media, LensRays<double, N>& rays) {
    // The directions of the blades are not set: there are none, and this would be the largest store of a GPU's thread.
    LensView<double> one;
    one.surfaces = &surface.traced, one.count = 1, one.kind = kind;
    one.iris.blades = 0, one.iris.apothem = one.iris.curvature = 0;
    one.free.freeforms = surface.freeform;
    trace_lens<kind>(one, rays, NoRecord{}, media);
}

/// Converts tangents to another frame.
template <int N, int M>
REALCAM_INLINE void turn_tangents(const FrameChange<double>& frame, TangentRays<N, M>& rays) {
    REALCAM_UNROLL
    for (int m = 0; m < M; ++m) {
        RayTangents<N>& tangents = rays.tangents[m];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            tangents.origin.set(i, frame.direction(tangents.origin[i]));
            tangents.direction.set(i, frame.direction(tangents.direction[i]));
        }
    }
}

/// Traces N rays and their tangents through one surface, which blocks none of them, and adds the contributions of its
/// numbers to `step`. `media`: policy of trace_lens for this surface. `forms`: NoFreeforms or FreeformTangents.
template <int N, int M, class Media, class Forms>
REALCAM_HD inline void trace_tangents(const TangentSurface& surface, const Media& media, const Forms& forms,
                                      TangentRays<N, M>& rays, AdjointStep<N>& step) {
    const FrameChange<double> frame = surface.before;
    Vec3Lanes<double, N> o, p;
    if (frame.changes) {
        change_frame(frame, static_cast<LensRays<double, N>&>(rays));
        turn_tangents(frame, rays);
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        Vec3d from = rays.origin[i];
        from.z -= surface.traced.shift;
        o.set(i, from);
        p.set(i, rays.direction[i]);
    }
    cross_surface<Forms::enabled ? LensKind::any : LensKind::rotational>(surface, media,
                                                                         static_cast<LensRays<double, N>&>(rays));
    int ended = 0;
    for (int i = 0; i < N; ++i) ended |= rays.status[i];
    if (ended != 0 && !replace_ended(rays, o, p)) return;
    for_surface_points(surface, rays.origin, forms, [&](const auto& point, int i) {
        push_tangents(point, surface.view.index_squared, o[i], p[i], rays, step, i);
    });
}

/// Traces rays and their tangents from the film to the scene, as TangentPath::trace says. `rim_tangents`: M for each
/// lane, whose tangents lie side by side. `media(k)`: policy of trace_lens for surface k. The contributions to -dH go
/// to `sums`, which has
///   surface(k), film()   AdjointStep<N>& of a surface, and of the start on the film
///   forms(k)             NoFreeforms or FreeformTangents
///   pose(i)              Lanes<double, N>& of the camera's translation and rotation, six in all
///   finish(k, rays)      called when surface k (kStartOnFilm: the start) is done, with the rays behind it
template <int N, int M, class MediaAt, class Sums>
REALCAM_HD inline void trace_tangents_to_scene(const TangentLens& lens, MediaAt&& media, TangentRays<N, M>& rays,
                                               const int* starts, const Vec3d* rim_tangents, Sums& sums) {
    for (int i = 0; i < N; ++i) {
        if (!starts) add_start({rays.origin.x[i], rays.origin.y[i], 0}, rays.tangents[0].direction[i], sums.film(), i);
        REALCAM_UNROLL
        for (int m = 0; m < M; ++m) {
            if (starts) rays.tangents[m].direction.set(i, {0, 0, 0});
            rays.tangents[m].origin.set(i, {0, 0, 0});
        }
    }
    sums.finish(kStartOnFilm, rays);
    for (int k = 0; k < lens.count; ++k) {
        const TangentSurface& surface = lens.surfaces[k];
        AdjointStep<N>& step = sums.surface(k);
        const auto forms = sums.forms(k);
        trace_tangents(surface, media(k), forms, rays, step);
        if (starts)
            for_surface_points(surface, rays.origin, forms, [&](const auto& point, int i) {
                if (starts[i] != k) return;
                REALCAM_UNROLL
                for (int m = 0; m < M; ++m) rays.tangents[m].direction.set(i, rim_tangents[M * i + m]);
                const Vec3d tangent = rim_tangents[M * i];
                add_start(rays.origin[i], tangent, step, i);
                // The rim moves along z with the surface's sag there.
                point.add_numbers(Vec3d{0, 0, 0}, tangent.z / point.gradient().z, step, i);
            });
        sums.finish(k, rays);
    }
    change_frame(lens.exit, static_cast<LensRays<double, N>&>(rays));
    turn_tangents(lens.exit, rays);
    const RayTangents<N>& of_pose = rays.tangents[M - 1];
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3d o = rays.origin[i], p = rays.direction[i], o_tangent = of_pose.origin[i],
                    p_tangent = of_pose.direction[i];
        const Vec3d moment = cross(o_tangent, p) + cross(o, p_tangent);
        sums.pose(0)[i] += p_tangent.x, sums.pose(1)[i] += p_tangent.y, sums.pose(2)[i] += p_tangent.z;
        sums.pose(3)[i] += moment.x, sums.pose(4)[i] += moment.y, sums.pose(5)[i] += moment.z;
    }
}

}  // namespace REALCAM_NAMESPACE
