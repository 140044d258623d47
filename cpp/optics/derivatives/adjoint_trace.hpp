#pragma once
#include "../trace/lens_trace.hpp"
#include "dual_surface.hpp"

namespace REALCAM_NAMESPACE {

// Reverse-mode differentiation. The adjoints of the rays behind a surface are the derivatives of a scalar function by
// these rays. From them follow the adjoints of the rays before the surface and of the surface's own numbers. The
// adjoint of a vector is a vector of derivatives; `of_x` is the adjoint of x. Host code only: nvcc lacks the vector
// types of dual numbers.

/// Indices of a surface's numbers in its list of adjoints.
enum SurfaceNumber : int {
    kFrameOrigin = 0,  ///< three numbers each: frame of the surface relative to the previous one
    kFrameX = 3,
    kFrameY = 6,
    kFrameZ = 9,
    kFrameNumbers = 12,
    kCurvature = kFrameNumbers,
    kConicFactor,
    kSquaredIndexChange,
    kIndexSquared,
    kAspheric,  ///< coefficients of r^4, r^6, ...
    kSurfaceNumbers = kAspheric + kMaxAsphericTerms
};

/// Adjoints of N rays.
template <int N>
struct RayAdjoints {
    Vec3Lanes<double, N> origin, direction;
    Lanes<double, N> path;
};

/// N rays behind a surface, in its frame, and the sums of the adjoints of its numbers, lane by lane.
template <int N>
struct AdjointStep {
    Vec3Lanes<double, N> origin, direction;
    Lanes<double, N> sums[kSurfaceNumbers];

    void add(int number, int lane, double of_number) { sums[number][lane] += of_number; }
    void add(int first, int lane, Vec3d of_vector) {
        add(first, lane, of_vector.x), add(first + 1, lane, of_vector.y), add(first + 2, lane, of_vector.z);
    }
};

// A point of a surface S = 0, where the gradient of S points towards the film. `bend` returns the adjoint of the point,
// given that of the gradient. `add_numbers` adds the adjoints of the surface's own numbers, given that of the gradient
// and `fall`, the derivative of the function by -S.

struct ConicPoint {
    double curvature, conic_factor;
    Vec3d at;

    /// S = z - c/2 (x^2 + y^2 + (1 + k) z^2)
    Vec3d gradient() const { return {-curvature * at.x, -curvature * at.y, 1 - curvature * conic_factor * at.z}; }
    Vec3d bend(Vec3d of_gradient) const {
        return -curvature * Vec3d{of_gradient.x, of_gradient.y, conic_factor * of_gradient.z};
    }
    template <int N>
    void add_numbers(Vec3d of_gradient, double fall, AdjointStep<N>& step, int lane) const {
        const Vec3d scaled = {at.x, at.y, conic_factor * at.z};
        step.add(kCurvature, lane, 0.5 * fall * dot(scaled, at) - dot(scaled, of_gradient));
        step.add(kConicFactor, lane, curvature * at.z * (0.5 * fall * at.z - of_gradient.z));
    }
};

struct AspherePoint {
    double curvature, conic_factor;
    Vec3d at;
    double w, root;  ///< r^2, and the square root in the conic's sag
    double slope, change;  ///< twice the first and twice the second derivative of the sag by w

    AspherePoint(const SurfaceView<double>& surface, Vec3d point)
        : curvature(surface.curvature), conic_factor(surface.conic_factor), at(point) {
        w = at.x * at.x + at.y * at.y;
        const double steepness = conic_factor * curvature * curvature;
        root = std::sqrt(1 - steepness * w);
        const double per_w = surface.inverse_search_squared, u = w * per_w, from_middle = u - 0.5;
        double p = 0, p1 = 0, p2 = 0;  // polynomial, first derivative, half the second derivative
        REALCAM_UNROLL
        for (int i = kMaxAsphericTerms - 1; i >= 0; --i) {
            p2 = p2 * from_middle + p1;
            p1 = p1 * from_middle + p;
            p = p * from_middle + surface.aspheric[i];
        }
        const double inverse = 1 / root;
        slope = curvature * inverse + 2 * per_w * u * (2 * p + u * p1);
        change = 0.5 * curvature * steepness * inverse * inverse * inverse +
                 2 * per_w * per_w * (2 * p + 4 * u * p1 + 2 * u * u * p2);
    }

    /// S = z - sag
    Vec3d gradient() const { return {-slope * at.x, -slope * at.y, 1}; }
    Vec3d bend(Vec3d of_gradient) const {
        const double turn = 2 * change * (at.x * of_gradient.x + at.y * of_gradient.y);
        return {-slope * of_gradient.x - turn * at.x, -slope * of_gradient.y - turn * at.y, 0};
    }
    template <int N>
    void add_numbers(Vec3d of_gradient, double fall, AdjointStep<N>& step, int lane) const {
        const double across = at.x * of_gradient.x + at.y * of_gradient.y, inverse = 1 / root;
        const double sag = curvature * w / (1 + root), cube = inverse * inverse * inverse;
        step.add(kCurvature, lane, 0.5 * fall * (w + conic_factor * sag * sag) * inverse - across * cube);
        step.add(kConicFactor, lane,
                 0.5 * curvature * (fall * sag * sag * inverse - across * curvature * curvature * w * cube));
        double power = w;  // r^2, then r^4, ...: derivative of each term by w, over half its power
        REALCAM_UNROLL
        for (int i = 0; i < kMaxAsphericTerms; ++i) {
            step.add(kAspheric + i, lane, power * (fall * w - 2 * (i + 2) * across));
            power *= w;
        }
    }
};

/// Sag and slopes of a freeform at (x, y), with the derivatives carried by the freeform's numbers and by x and y.
FreeformSags<Dual8, 1> dual_sags(const DualSurface& surface, const Lanes<Dual8, 1>& x, const Lanes<Dual8, 1>& y);

/// Point of a freeform. Adjoints of its numbers are summed for the variables in the lanes of its dual surfaces.
struct FreeformPoint {
    const DualSurface* duals;
    int count;
    Dual8* sums;  ///< one per dual surface; `by` accumulates the adjoints of its lanes
    Vec3d at;
    FreeformSags<Dual8, 1> first;  ///< with derivatives by x and y in lanes 0 and 1

    FreeformPoint(const DualSurface* of, int number, Dual8* to, Vec3d point)
        : duals(of), count(number), sums(to), at(point) {
        Lanes<Dual8, 1> x = {at.x}, y = {at.y};
        x[0].by[0] = y[0].by[1] = 1;
        first = dual_sags(duals[0], x, y);
    }

    Vec3d gradient() const { return {-first.slope_x[0].value, -first.slope_y[0].value, 1}; }
    Vec3d bend(Vec3d of_gradient) const {
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

/// Converts the adjoints of one ray from behind a surface to before it, in the surface's frame. `o` and `p`: origin and
/// direction of the ray before the surface.
///
/// Because S(o + t p) = 0, t changes by -dS / (gradient . p). All other terms are the derivative of Snell's law
/// (refract), whose square roots are read off the refracted ray.
template <int N, class SurfacePoint>
inline void pull_crossing(const SurfacePoint& point, const SurfaceView<double>& surface, Vec3d o, Vec3d p,
                          RayAdjoints<N>& adjoints, AdjointStep<N>& step, int lane) {
    const Vec3d behind = step.direction[lane], of_behind = adjoints.direction[lane];
    const double of_path = adjoints.path[lane];
    const Vec3d gradient = point.gradient();
    const double inverse = 1 / length(gradient);
    const Vec3d normal = inverse * gradient;
    const double along = dot(p, normal), along_behind = dot(behind, normal), change = along_behind - along;
    // At the critical angle the derivative is infinite, and is taken as 0.
    const double share = select(along_behind != 0, dot(of_behind, normal) / along_behind, 0.0);
    const Vec3d of_normal = change * (of_behind - share * p);
    const Vec3d of_gradient = inverse * (of_normal - dot(of_normal, normal) * normal);
    const Vec3d of_at = adjoints.origin[lane] + point.bend(of_gradient);
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

/// Converts adjoints from the frame of a surface to that of the previous one, in which the rays `from` and `along` are.
template <int N>
inline void pull_frame(const FrameChange<double>& frame, const Vec3Lanes<double, N>& from,
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

/// A surface with the data for its adjoints.
struct AdjointSurface {
    SurfaceView<double> view;  ///< kind as its variables need; shift is 0 if the frame changes
    FrameChange<double> before;
    const DualSurface* duals;  ///< dual surfaces, for a freeform
    int dual_count;
    Dual8* form_sums;
};

/// Converts the adjoints of N rays from behind a surface to before it. `before`: the rays behind the previous surface.
template <int N>
inline void pull_surface(const AdjointSurface& surface, const AdjointStep<N>& before, AdjointStep<N>& step,
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
            pull_crossing(point, view, o[i], p[i], adjoints, step, i);
        }
    } else if (view.kind == SurfaceShape::asphere) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            pull_crossing(AspherePoint(view, step.origin[i]), view, o[i], p[i], adjoints, step, i);
    } else {
        // A sphere is a conic with the factor 1, and its gradient has the length 1.
        REALCAM_LANES
        for (int i = 0; i < N; ++i)
            pull_crossing(ConicPoint{view.curvature, view.conic_factor, step.origin[i]}, view, o[i], p[i], adjoints,
                          step, i);
    }
    if (frame.changes) {
        pull_frame(frame, before.origin, before.direction, adjoints, step);
        return;
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) step.add(kFrameOrigin + 2, i, -adjoints.origin.z[i]);
}

}  // namespace REALCAM_NAMESPACE
