#pragma once
#include <cmath>

#include "../../math/lanes.hpp"
#include "../trace/lens_view.hpp"

namespace REALCAM_NAMESPACE {

// Numbers of a surface by which rays are differentiated, and points of surfaces without freeform terms, for derivatives
// on every device. The adjoint of a quantity is the derivative of a scalar function by it.

/// Numbers of a surface that have adjoints, as indices of AdjointStep::sums.
enum SurfaceNumber : int {
    kFrameOrigin = 0,  ///< frame of the surface relative to the previous one: origin and axes, three numbers each
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

/// N rays behind a surface, in its frame, and for each number of the surface the sum of its adjoints over rays,
/// separately for each lane.
template <int N>
struct AdjointStep {
    Vec3Lanes<double, N> origin, direction;
    Lanes<double, N> sums[kSurfaceNumbers];

    /// Adds to the adjoint of a number.
    REALCAM_INLINE void add(int number, int lane, double of_number) { sums[number][lane] += of_number; }
    /// Adds to the adjoints of three consecutive numbers, from `first` on.
    REALCAM_INLINE void add(int first, int lane, Vec3d of_vector) {
        add(first, lane, of_vector.x), add(first + 1, lane, of_vector.y), add(first + 2, lane, of_vector.z);
    }
};

// The classes of points describe a point of a surface S = 0, where the gradient of S points towards the film; that of
// freeforms is in adjoint_trace.hpp.
//   gradient()                    gradient of S at the point
//   point_adjoint(of_gradient)    adjoint of the point due to that of the gradient
//   add_numbers(of_gradient, fall, step, lane)  adds the adjoints of the surface's own numbers to `step`; `fall` is the
//                                 derivative of the scalar function by -S

/// Point of a sphere or conic.
struct ConicPoint {
    double curvature, conic_factor;  ///< c and 1 + k
    Vec3d at;  ///< position in the surface's frame, mm

    /// Gradient of S = z - c/2 (x^2 + y^2 + (1 + k) z^2).
    REALCAM_INLINE Vec3d gradient() const {
        return {-curvature * at.x, -curvature * at.y, 1 - curvature * conic_factor * at.z};
    }
    REALCAM_INLINE Vec3d point_adjoint(Vec3d of_gradient) const {
        return -curvature * Vec3d{of_gradient.x, of_gradient.y, conic_factor * of_gradient.z};
    }
    template <int N>
    REALCAM_INLINE void add_numbers(Vec3d of_gradient, double fall, AdjointStep<N>& step, int lane) const {
        const Vec3d scaled = {at.x, at.y, conic_factor * at.z};
        step.add(kCurvature, lane, 0.5 * fall * dot(scaled, at) - dot(scaled, of_gradient));
        step.add(kConicFactor, lane, curvature * at.z * (0.5 * fall * at.z - of_gradient.z));
    }
};

/// Point of an even asphere.
struct AspherePoint {
    double curvature, conic_factor;  ///< c and 1 + k
    Vec3d at;  ///< position in the surface's frame, mm
    double w;  ///< r^2
    double root;  ///< sqrt(1 - (1 + k) c^2 w) in the conic's sag
    double slope, change;  ///< twice the first and twice the second derivative of the sag by w

    REALCAM_INLINE AspherePoint(const SurfaceView<double>& surface, Vec3d point)
        : curvature(surface.curvature), conic_factor(surface.conic_factor), at(point) {
        w = at.x * at.x + at.y * at.y;
        const double steepness = conic_factor * curvature * curvature;
        root = std::sqrt(1 - steepness * w);
        const double per_w = surface.inverse_search_squared, u = w * per_w, from_middle = u - 0.5;
        double p = 0, p1 = 0, p2 = 0;  // polynomial, its first, and half its second derivative
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

    /// Gradient of S = z - sag.
    REALCAM_INLINE Vec3d gradient() const { return {-slope * at.x, -slope * at.y, 1}; }
    REALCAM_INLINE Vec3d point_adjoint(Vec3d of_gradient) const {
        const double factor = 2 * change * (at.x * of_gradient.x + at.y * of_gradient.y);
        return {-slope * of_gradient.x - factor * at.x, -slope * of_gradient.y - factor * at.y, 0};
    }
    template <int N>
    REALCAM_INLINE void add_numbers(Vec3d of_gradient, double fall, AdjointStep<N>& step, int lane) const {
        const double across = at.x * of_gradient.x + at.y * of_gradient.y, inverse = 1 / root;
        const double sag = curvature * w / (1 + root), cube = inverse * inverse * inverse;
        step.add(kCurvature, lane, 0.5 * fall * (w + conic_factor * sag * sag) * inverse - across * cube);
        step.add(kConicFactor, lane,
                 0.5 * curvature * (fall * sag * sag * inverse - across * curvature * curvature * w * cube));
        double power = w;  // r^2, then r^4, ...: derivative of each term by w, divided by half its power
        REALCAM_UNROLL
        for (int i = 0; i < kMaxAsphericTerms; ++i) {
            step.add(kAspheric + i, lane, power * (fall * w - 2 * (i + 2) * across));
            power *= w;
        }
    }
};

}  // namespace REALCAM_NAMESPACE
