#pragma once
#include "../trace/lens_trace.hpp"
#include "dual_surface.hpp"
#include "surface_points.hpp"

namespace REALCAM_NAMESPACE {

// Reverse-mode differentiation (backpropagation) of the ray trace, surface by surface. The adjoint of a quantity x is
// the derivative of a scalar function by x; it is called `of_x`, and is a vector if x is one. From the adjoints of the
// rays behind a surface, the functions below compute those of the rays in front of it and those of the surface's own
// numbers. In a surface's frame, o and p are origin and optical direction of a ray (a direction of the length of the
// refractive index). Host code only: nvcc lacks the vector types of dual numbers.

/// Adjoints of N rays.
template <int N>
struct RayAdjoints {
    Vec3Lanes<double, N> origin, direction;
    Lanes<double, N> path;
};

/// Returns the contribution of a frame to the derivative by the variable in a lane. `adjoints`: adjoints of the frame's
/// origin and axes.
template <class Frame>
double sum_of_frame(const Vec3d* adjoints, const Frame& frame, std::size_t lane) {
    double sum = 0;
    const Vec3<Dual8>* const parts[] = {&frame.origin, &frame.x, &frame.y, &frame.z};
    for (const Vec3<Dual8>* part : parts)
        sum += dot(*adjoints++, {part->x.by[lane], part->y.by[lane], part->z.by[lane]});
    return sum;
}

/// Returns the contribution of a surface to the derivative by the variable in a lane. `adjoints`: adjoints of the
/// surface's numbers (SurfaceNumber).
inline double sum_of_surface(const double* adjoints, const DualSurface& surface, std::size_t lane) {
    const SurfaceView<Dual8>& view = surface.view;
    double sum = adjoints[kFrameOrigin + 2] * view.shift.by[lane] + adjoints[kCurvature] * view.curvature.by[lane] +
                 adjoints[kConicFactor] * view.conic_factor.by[lane] +
                 adjoints[kSquaredIndexChange] * view.squared_index_change.by[lane] +
                 adjoints[kIndexSquared] * view.index_squared.by[lane];
    if (surface.before.changes) {
        Vec3d of_frame[4];
        for (int part = 0; part < 4; ++part)
            of_frame[part] = {adjoints[3 * part], adjoints[3 * part + 1], adjoints[3 * part + 2]};
        sum += sum_of_frame(of_frame, surface.before, lane);
    }
    if (surface.powers[lane] != 0) sum += adjoints[kAspheric + surface.powers[lane] / 2 - 2];
    return sum;
}

/// Returns sag and slopes of a freeform at (x, y), with derivatives in the lanes of the surface's numbers and of x and
/// y.
FreeformSags<Dual8, 1> dual_sags(const DualSurface& surface, const Lanes<Dual8, 1>& x, const Lanes<Dual8, 1>& y);

/// Point of a freeform. Instead of adjoints of its many numbers, the derivatives by its variables are summed, one in
/// each lane of its dual surfaces.
struct FreeformPoint {
    const DualSurface* duals;  ///< the surface's dual surfaces, which hold eight variables each
    int count;  ///< number of dual surfaces
    Dual8* sums;  ///< one per dual surface; `by` accumulates the adjoints of its lanes
    Vec3d at;  ///< position in the surface's frame, mm
    FreeformSags<Dual8, 1> first;  ///< sag and slopes of the first dual surface; lanes 0 and 1: derivatives by x and y

    FreeformPoint(const DualSurface* dual_surfaces, int dual_count, Dual8* adjoint_sums, Vec3d point)
        : duals(dual_surfaces), count(dual_count), sums(adjoint_sums), at(point) {
        Lanes<Dual8, 1> x = {at.x}, y = {at.y};
        x[0].by[0] = y[0].by[1] = 1;
        first = dual_sags(duals[0], x, y);
    }

    Vec3d gradient() const { return {-first.slope_x[0].value, -first.slope_y[0].value, 1}; }
    Vec3d point_adjoint(Vec3d of_gradient) const {
        const Dual8::Derivatives sum = of_gradient.x * first.slope_x[0].by + of_gradient.y * first.slope_y[0].by;
        return {-sum[0], -sum[1], 0};
    }
    template <int N>
    void add_numbers(Vec3d of_gradient, double fall, AdjointStep<N>&, int) const {
        const Lanes<Dual8, 1> x = {at.x}, y = {at.y};
        for (int i = 0; i < count; ++i) {
            const FreeformSags<Dual8, 1> sag = i > 0 ? dual_sags(duals[i], x, y) : first;
            sums[i].by +=
                fall * sag.height[0].by - of_gradient.x * sag.slope_x[0].by - of_gradient.y * sag.slope_y[0].by;
        }
    }
};

/// Converts the adjoints of one ray from behind a surface to in front of it, in the surface's frame, and adds those of
/// the surface's numbers to `step`. `o` and `p`: origin and optical direction of the ray in front of the surface;
/// `step` contains the ray behind it.
///
/// Because S(o + t p) = 0, the ray parameter t changes by -dS / (gradient . p). The other terms are the derivative of
/// Snell's law (refract), whose square root is the normal component of the refracted ray.
template <int N, class SurfacePoint>
inline void pull_back_intersection(const SurfacePoint& point, const SurfaceView<double>& surface, Vec3d o, Vec3d p,
                                   RayAdjoints<N>& adjoints, AdjointStep<N>& step, int lane) {
    const Vec3d behind = step.direction[lane], of_behind = adjoints.direction[lane];
    const double of_path = adjoints.path[lane];
    const Vec3d gradient = point.gradient();
    const double inverse = 1 / length(gradient);
    const Vec3d normal = inverse * gradient;
    const double along = dot(p, normal), along_behind = dot(behind, normal), change = along_behind - along;
    // At the critical angle the derivative is infinite; it is replaced by 0.
    const double share = select(along_behind != 0, dot(of_behind, normal) / along_behind, 0.0);
    const Vec3d of_normal = change * (of_behind - share * p);
    const Vec3d of_gradient = inverse * (of_normal - dot(of_normal, normal) * normal);
    const Vec3d of_at = adjoints.origin[lane] + point.point_adjoint(of_gradient);
    const double squared = dot(p, p), t = dot(step.origin[lane] - o, p) / squared;
    const double fall = (dot(of_at, p) + surface.index_squared * of_path) / dot(gradient, p);
    const Vec3d of_o = of_at - fall * gradient;
    adjoints.origin.set(lane, of_o);
    adjoints.direction.set(lane,
                           of_behind + share * surface.squared_index_change * p - share * change * normal + t * of_o);
    step.add(kSquaredIndexChange, lane, 0.5 * share * squared);
    step.add(kIndexSquared, lane, of_path * t);
    point.add_numbers(of_gradient, fall, step, lane);
}

/// Converts adjoints from the frame of a surface to that of the previous surface, and adds those of the frame's numbers
/// to `step`. `from`, `along`: origins and directions of the rays in the previous frame.
template <int N>
inline void pull_back_frame(const FrameChange<double>& frame, const Vec3Lanes<double, N>& from,
                            const Vec3Lanes<double, N>& along, RayAdjoints<N>& adjoints, AdjointStep<N>& step) {
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec3d of_o = adjoints.origin[i], of_p = adjoints.direction[i];
        const Vec3d offset = from[i] - frame.origin, p = along[i];
        const Vec3d of_origin = of_o.x * frame.x + of_o.y * frame.y + of_o.z * frame.z;
        step.add(kFrameOrigin, i, -of_origin);
        step.add(kFrameX, i, of_o.x * offset + of_p.x * p);
        step.add(kFrameY, i, of_o.y * offset + of_p.y * p);
        step.add(kFrameZ, i, of_o.z * offset + of_p.z * p);
        adjoints.origin.set(i, of_origin);
        adjoints.direction.set(i, of_p.x * frame.x + of_p.y * frame.y + of_p.z * frame.z);
    }
}

/// Surface with the data for its adjoints.
struct AdjointSurface {
    SurfaceView<double> view;  ///< its kind is the one that the variables require; shift is 0 if the frame changes
    FrameChange<double> before;  ///< from the frame of the previous surface to that of this one
    const DualSurface* duals;  ///< dual surfaces of a freeform
    int dual_count;
    Dual8* form_sums;  ///< see FreeformPoint::sums
};

/// Converts the adjoints of N rays from behind a surface to behind the previous surface, and adds those of the
/// surface's numbers to `step`. `before`: the rays behind the previous surface; `step`: the rays behind this surface.
template <int N>
inline void pull_back_surface(const AdjointSurface& surface, const AdjointStep<N>& before, AdjointStep<N>& step,
                              RayAdjoints<N>& adjoints) {
    const SurfaceView<double> view = surface.view;
    const FrameChange<double> frame = surface.before;
    Vec3Lanes<double, N> o, p;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        Vec3d from = before.origin[i];
        from.z -= view.shift;
        o.set(i, from);
        p.set(i, before.direction[i]);
    }
    if (frame.changes) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            o.set(i, frame.point(o[i]));
            p.set(i, frame.direction(p[i]));
        }
    }
    if (view.kind == SurfaceShape::freeform) {
        for (int i = 0; i < N; ++i) {
            const FreeformPoint point(surface.duals, surface.dual_count, surface.form_sums, step.origin[i]);
            pull_back_intersection(point, view, o[i], p[i], adjoints, step, i);
        }
    } else if (view.kind == SurfaceShape::asphere) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            pull_back_intersection(AspherePoint(view, step.origin[i]), view, o[i], p[i], adjoints, step, i);
    } else {
        // A sphere is a conic with the conic factor 1.
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            pull_back_intersection(ConicPoint{view.curvature, view.conic_factor, step.origin[i]}, view, o[i], p[i],
                                   adjoints, step, i);
    }
    if (frame.changes) {
        pull_back_frame(frame, before.origin, before.direction, adjoints, step);
        return;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) step.add(kFrameOrigin + 2, i, -adjoints.origin.z[i]);
}

}  // namespace REALCAM_NAMESPACE
