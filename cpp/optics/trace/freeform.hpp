#pragma once
#include <cstdint>
#include <limits>

#include "../../math/lanes.hpp"
#include "../prescription/lens_limits.hpp"

namespace REALCAM_NAMESPACE {

/// Number of terms x^i y^j with i + j <= kMaxXyDegree.
inline constexpr int kXyCoefficients = (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;

/// A surface that is neither a conic nor an even asphere, prepared for tracing: its sag is the base plus the radial,
/// Forbes and xy terms. Lengths in mm, in the frame of the vertex; r^2 = x^2 + y^2. The search region is the
/// intersection of a rectangle with a circle about the vertex. Outside it the sag is that of a point of the region's
/// edge: the point is clamped to the rectangle, then moved radially to the circle.
template <class T>
struct alignas(16) FreeformView {
    T middle_x, middle_y, half_x, half_y;  ///< centre and half-sides of the rectangle
    T reach, inverse_reach;  ///< radius of the circle, and its inverse
    T sag_min, sag_max;  ///< bounds of the sag in the search region
    T curvature_x, curvature_y;  ///< curvatures of the base in the xz and yz planes, 1/mm
    T conic_factor_x, conic_factor_y;  ///< 1 + k in these planes; a toroid reads only that of y
    T term_size;  ///< sum of the coefficients' absolute values, mm: the terms may cancel, their rounding errors do not
    std::int32_t is_toroid;  ///< 0: the base is a biconic
    std::int32_t section_terms, radial_terms, forbes_terms;  ///< number of coefficients in the arrays below
    std::int32_t xy_degree;  ///< largest i + j of the xy terms; -1: no xy terms
    T section[kMaxAsphericTerms];  ///< toroid: coefficients of v^4, v^6, ... in its yz section, v = y / reach
    T radial[kMaxRadialTerms];  ///< coefficients of u, u^2, ..., u = r / reach
    /// Forbes polynomial: coefficients of the powers of 2 w - 1, w = r^2 forbes_scale. The sum is multiplied by w, and
    /// by (1 - w) / sqrt(1 - c^2 r^2) if is_bfs is 1, by w if it is 0.
    T forbes[kMaxForbesTerms];
    T forbes_scale, forbes_curvature_squared;  ///< 1 / (normalisation radius)^2, and c^2; 1/mm^2
    T is_bfs;  ///< 1: Q^bfs, 0: Q^con (Forbes 2007)
    /// Coefficients of x^i y^j / reach^(i + j): for j from the degree down to 0, i from the degree - j down to 0.
    T xy[kXyCoefficients];
};

/// Sag of N points, mm, its derivatives with respect to x and y, and the sum of its terms' absolute values, mm.
template <class T, int N>
struct FreeformSags {
    Lanes<T, N> height, slope_x, slope_y, size;
};

namespace freeform_detail {

// Dual numbers bring their own overloads.
using std::fabs;
using std::sqrt;

/// A point clamped to the search region, and the effect of the clamping on the derivatives.
template <class T>
struct InsidePoint {
    T x, y;  ///< the clamped point
    T derivative_x,
        derivative_y;  ///< 0 if the rectangle has clamped the coordinate, so that the sag is constant; else 1
    T shrink;  ///< factor by which the circle has shortened the distance from the vertex; 1: unchanged
};

/// Clamps a point to the rectangle, then to the circle.
template <class T>
REALCAM_INLINE InsidePoint<T> inside_point(const FreeformView<T>& form, T x, T y) {
    const T dx = x - form.middle_x, dy = y - form.middle_y;
    const T in_x = select(dx > form.half_x, form.half_x, select(dx < -form.half_x, -form.half_x, dx));
    const T in_y = select(dy > form.half_y, form.half_y, select(dy < -form.half_y, -form.half_y, dy));
    const T cx = select(in_x == dx, x, form.middle_x + in_x), cy = select(in_y == dy, y, form.middle_y + in_y);
    const T r2 = cx * cx + cy * cy, limit = form.reach * form.reach;
    const T shrink = select(r2 > limit, form.reach / sqrt(select(r2 > limit, r2, T(1))), T(1));
    return {shrink * cx, shrink * cy, select(in_x == dx, T(1), T(0)), select(in_y == dy, T(1), T(0)), shrink};
}

/// Square root for a denominator: bounded away from 0, so that no slope is infinite.
template <class T>
REALCAM_INLINE T root_of(T radicand) {
    const T smallest = std::numeric_limits<T>::epsilon();
    return sqrt(select(radicand > smallest, radicand, smallest));
}

/// Sets height, slopes and size to those of the base: a biconic, or a toroid with the terms of its section. `x`, `y`:
/// points inside the search region, here and in the following functions.
template <class T, int N>
REALCAM_HD inline void set_base(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    const T cx = form.curvature_x, cy = form.curvature_y;
    if (!form.is_toroid) {
        const T qx = form.conic_factor_x * cx * cx, qy = form.conic_factor_y * cy * cy;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T root = root_of(T(1) - qx * x[i] * x[i] - qy * y[i] * y[i]);
            const T denominator = T(1) + root, numerator = cx * x[i] * x[i] + cy * y[i] * y[i];
            const T base = quotient(numerator, denominator), bend = quotient(base, root * denominator);
            out.height[i] = base;
            out.slope_x[i] = x[i] * (quotient(T(2) * cx, denominator) + bend * qx);
            out.slope_y[i] = y[i] * (quotient(T(2) * cy, denominator) + bend * qy);
            out.size[i] = fabs(base) + form.term_size;
        }
        return;
    }
    Lanes<T, N> terms, slopes;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) terms[i] = slopes[i] = T(0);
    for (int k = form.section_terms - 1; k >= 0; --k) {
        const T coefficient = form.section[k];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T v = form.inverse_reach * y[i], v2 = v * v;
            slopes[i] = slopes[i] * v2 + terms[i];
            terms[i] = terms[i] * v2 + coefficient;
        }
    }
    const T qy = form.conic_factor_y * cy * cy;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const T v = form.inverse_reach * y[i], v2 = v * v, root = root_of(T(1) - qy * y[i] * y[i]);
        const T section = quotient(cy * y[i] * y[i], T(1) + root) + v2 * v2 * terms[i];
        const T section_slope =
            quotient(cy * y[i], root) + form.inverse_reach * T(2) * v * v2 * (T(2) * terms[i] + v2 * slopes[i]);
        // Circle of revolution, whose radius is reduced by the section's sag; this form does not cancel for small c_x.
        const T radius = T(1) - cx * section;  // in units of 1 / c_x
        const T root_x = root_of(radius * radius - cx * cx * x[i] * x[i]);
        const T base = quotient(section * (T(1) + radius) + cx * x[i] * x[i], T(1) + root_x);
        out.height[i] = base;
        out.slope_x[i] = quotient(cx * x[i], root_x);
        out.slope_y[i] = quotient(radius * section_slope, root_x);
        out.size[i] = fabs(base) + fabs(section) + form.term_size;
    }
}

/// Adds the terms of r, r^2, ...
template <class T, int N>
REALCAM_HD inline void add_radial(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    Lanes<T, N> u, sum, slope;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        u[i] = form.inverse_reach * sqrt(x[i] * x[i] + y[i] * y[i]);
        sum[i] = slope[i] = T(0);
    }
    for (int k = form.radial_terms - 1; k >= 0; --k) {
        const T coefficient = form.radial[k];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            slope[i] = slope[i] * u[i] + sum[i];
            sum[i] = sum[i] * u[i] + coefficient;
        }
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        // sum + u slope is the derivative of u sum with respect to u. At the tip of a cone the slope counts as 0.
        const T inverse_reach_squared = form.inverse_reach * form.inverse_reach;
        const T slope_over_r =
            quotient((sum[i] + u[i] * slope[i]) * inverse_reach_squared, select(u[i] > T(0), u[i], T(1)));
        out.height[i] += u[i] * sum[i];
        out.slope_x[i] += slope_over_r * x[i];
        out.slope_y[i] += slope_over_r * y[i];
    }
}

/// Adds the Forbes polynomial.
template <class T, int N>
REALCAM_HD inline void add_forbes(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    Lanes<T, N> sum, slope;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) sum[i] = slope[i] = T(0);
    for (int k = form.forbes_terms - 1; k >= 0; --k) {
        const T coefficient = form.forbes[k];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T t = T(2) * form.forbes_scale * (x[i] * x[i] + y[i] * y[i]) - T(1);  // 2 w - 1
            slope[i] = slope[i] * t + sum[i];
            sum[i] = sum[i] * t + coefficient;
        }
    }
    const T bfs = form.is_bfs, con = T(1) - form.is_bfs;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const T w = form.forbes_scale * (x[i] * x[i] + y[i] * y[i]);
        const T q = form.forbes_curvature_squared / form.forbes_scale;  // c^2 r^2 = q w
        const T root = root_of(T(1) - q * w), inverse = quotient(T(1), root);
        const T factor = w * (bfs * (T(1) - w) * inverse + con * w);
        const T factor_slope =
            bfs * inverse * (T(1) - T(2) * w + T(0.5) * q * w * (T(1) - w) * inverse * inverse) + con * T(2) * w;
        const T slope_by_w = factor_slope * sum[i] + factor * T(2) * slope[i];
        out.height[i] += factor * sum[i];
        out.slope_x[i] += T(2) * form.forbes_scale * slope_by_w * x[i];
        out.slope_y[i] += T(2) * form.forbes_scale * slope_by_w * y[i];
    }
}

/// Adds the terms of x^i y^j: a Horner scheme in y, whose coefficients are Horner schemes in x.
template <class T, int N>
REALCAM_HD inline void add_xy(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    Lanes<T, N> sum, sum_slope_x, sum_slope_y, inner, inner_slope;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) sum[i] = sum_slope_x[i] = sum_slope_y[i] = T(0);
    const T* coefficient = form.xy;
    for (int j = form.xy_degree; j >= 0; --j) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) inner[i] = inner_slope[i] = T(0);
        for (int k = form.xy_degree - j; k >= 0; --k) {
            const T next = *coefficient++;
            REALCAM_LANES
            for (int i = 0; i < N; ++i) {
                inner_slope[i] = inner_slope[i] * (form.inverse_reach * x[i]) + inner[i];
                inner[i] = inner[i] * (form.inverse_reach * x[i]) + next;
            }
        }
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T v = form.inverse_reach * y[i];
            sum_slope_y[i] = sum_slope_y[i] * v + sum[i];
            sum[i] = sum[i] * v + inner[i];
            sum_slope_x[i] = sum_slope_x[i] * v + inner_slope[i];
        }
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        out.height[i] += sum[i];
        out.slope_x[i] += form.inverse_reach * sum_slope_x[i];
        out.slope_y[i] += form.inverse_reach * sum_slope_y[i];
    }
}

}  // namespace freeform_detail

/// Computes the sag and the slopes of a freeform surface at N points, inside or outside the search region.
template <class T, int N>
REALCAM_HD inline void freeform_sags(const FreeformView<T>& form, const Lanes<T, N>& x, const Lanes<T, N>& y,
                                     FreeformSags<T, N>& out) {
    using namespace freeform_detail;
    Lanes<T, N> in_x, in_y;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const InsidePoint<T> inside = inside_point(form, x[i], y[i]);
        in_x[i] = inside.x;
        in_y[i] = inside.y;
    }
    set_base<T, N>(form, in_x, in_y, out);
    if (form.radial_terms > 0) add_radial<T, N>(form, in_x, in_y, out);
    if (form.forbes_terms > 0) add_forbes<T, N>(form, in_x, in_y, out);
    if (form.xy_degree >= 0) add_xy<T, N>(form, in_x, in_y, out);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const InsidePoint<T> inside = inside_point(form, x[i], y[i]);
        // Outside the circle the sag is constant along the radius: only the tangential slope remains, and it decreases
        // with the distance.
        const bool is_outside = inside.shrink < T(1);
        const T radial_slope = quotient(out.slope_x[i] * inside.x + out.slope_y[i] * inside.y, form.reach * form.reach);
        const T tangential_x = inside.shrink * (out.slope_x[i] - radial_slope * inside.x);
        const T tangential_y = inside.shrink * (out.slope_y[i] - radial_slope * inside.y);
        out.slope_x[i] = inside.derivative_x * select(is_outside, tangential_x, out.slope_x[i]);
        out.slope_y[i] = inside.derivative_y * select(is_outside, tangential_y, out.slope_y[i]);
    }
}

}  // namespace REALCAM_NAMESPACE
