#pragma once
#include <cstdint>
#include <limits>

#include "../../math/lanes.hpp"
#include "../prescription/lens_limits.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kXyCoefficients = (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;

/// A surface that is neither a conic nor an even asphere, prepared for tracing. Lengths in mm. The search region is the
/// intersection of a rectangle with a circle about the vertex; outside it the surface continues from the region's edge.
template <class T>
struct alignas(16) FreeformView {
    T middle_x, middle_y, half_x, half_y;  ///< centre and half-sides of the rectangle
    T reach, inverse_reach;  ///< radius of the circle, and its inverse
    T sag_min, sag_max;  ///< bounds of the sag in the search region
    T curvature_x, curvature_y, conic_factor_x, conic_factor_y;
    T term_size;  ///< sum of the coefficients' absolute values: the terms may cancel, their rounding errors do not
    std::int32_t is_toroid;  ///< 0: the base is a biconic
    std::int32_t section_terms, radial_terms, forbes_terms;
    std::int32_t xy_degree;  ///< -1: no xy terms
    T section[kMaxAsphericTerms];  ///< toroid: coefficients of v^4, v^6, ..., v = y / reach
    T radial[kMaxRadialTerms];  ///< coefficients of u, u^2, ..., u = r / reach
    /// Forbes polynomial: coefficients of the powers of 2 w - 1, w = r^2 forbes_scale. The sum is multiplied by w, and
    /// by (1 - w) / sqrt(1 - c^2 r^2) if is_bfs is 1, by w if it is 0.
    T forbes[kMaxForbesTerms];
    T forbes_scale, forbes_curvature_squared, is_bfs;
    /// Coefficients of x^i y^j / reach^(i + j): for j from the degree down to 0, i from the degree - j down to 0.
    T xy[kXyCoefficients];
};

/// Sag of N points, its derivatives with respect to x and y, and the sum of its terms' absolute values.
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
    T x, y;  ///< inside
    T keeps_x, keeps_y;  ///< 0 if the rectangle has clamped the coordinate
    T across;  ///< factor by which the circle has shortened the distance from the vertex; 1: unchanged
};

template <class T>
REALCAM_INLINE InsidePoint<T> inside_point(const FreeformView<T>& form, T x, T y) {
    const T dx = x - form.middle_x, dy = y - form.middle_y;
    const T in_x = select(dx > form.half_x, form.half_x, select(dx < -form.half_x, -form.half_x, dx));
    const T in_y = select(dy > form.half_y, form.half_y, select(dy < -form.half_y, -form.half_y, dy));
    const T cx = select(in_x == dx, x, form.middle_x + in_x), cy = select(in_y == dy, y, form.middle_y + in_y);
    const T r2 = cx * cx + cy * cy, limit = form.reach * form.reach;
    const T across = select(r2 > limit, form.reach / sqrt(select(r2 > limit, r2, T(1))), T(1));
    return {across * cx, across * cy, select(in_x == dx, T(1), T(0)), select(in_y == dy, T(1), T(0)), across};
}

/// Square root for a denominator: bounded away from 0, so that no slope is infinite.
template <class T>
REALCAM_INLINE T root_of(T radicand) {
    const T least = std::numeric_limits<T>::epsilon();
    return sqrt(select(radicand > least, radicand, least));
}

template <class T, int N>
REALCAM_HD inline void set_base(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    const T cx = form.curvature_x, cy = form.curvature_y;
    if (!form.is_toroid) {
        const T qx = form.conic_factor_x * cx * cx, qy = form.conic_factor_y * cy * cy;
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T root = root_of(T(1) - qx * x[i] * x[i] - qy * y[i] * y[i]);
            const T over = T(1) + root, top = cx * x[i] * x[i] + cy * y[i] * y[i];
            const T base = quotient(top, over), bend = quotient(base, root * over);
            out.height[i] = base;
            out.slope_x[i] = x[i] * (quotient(T(2) * cx, over) + bend * qx);
            out.slope_y[i] = y[i] * (quotient(T(2) * cy, over) + bend * qy);
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
        const T along =
            quotient(cy * y[i], root) + form.inverse_reach * T(2) * v * v2 * (T(2) * terms[i] + v2 * slopes[i]);
        // Circle of revolution, whose radius is reduced by the section's sag; this form does not cancel for small c_x.
        const T rest = T(1) - cx * section, ring = root_of(rest * rest - cx * cx * x[i] * x[i]);
        const T base = quotient(section * (T(1) + rest) + cx * x[i] * x[i], T(1) + ring);
        out.height[i] = base;
        out.slope_x[i] = quotient(cx * x[i], ring);
        out.slope_y[i] = quotient(rest * along, ring);
        out.size[i] = fabs(base) + fabs(section) + form.term_size;
    }
}

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
        const T per_r = form.inverse_reach * form.inverse_reach;
        const T over_u = quotient((sum[i] + u[i] * slope[i]) * per_r, select(u[i] > T(0), u[i], T(1)));
        out.height[i] += u[i] * sum[i];
        out.slope_x[i] += over_u * x[i];
        out.slope_y[i] += over_u * y[i];
    }
}

template <class T, int N>
REALCAM_HD inline void add_forbes(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    Lanes<T, N> sum, slope;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) sum[i] = slope[i] = T(0);
    for (int k = form.forbes_terms - 1; k >= 0; --k) {
        const T coefficient = form.forbes[k];
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T middle = T(2) * form.forbes_scale * (x[i] * x[i] + y[i] * y[i]) - T(1);
            slope[i] = slope[i] * middle + sum[i];
            sum[i] = sum[i] * middle + coefficient;
        }
    }
    const T bfs = form.is_bfs, con = T(1) - form.is_bfs;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const T w = form.forbes_scale * (x[i] * x[i] + y[i] * y[i]);
        const T bent = form.forbes_curvature_squared / form.forbes_scale;  // c^2 r^2 = bent w
        const T root = root_of(T(1) - bent * w), inverse = quotient(T(1), root);
        const T factor = w * (bfs * (T(1) - w) * inverse + con * w);
        const T factor_slope =
            bfs * inverse * (T(1) - T(2) * w + T(0.5) * bent * w * (T(1) - w) * inverse * inverse) + con * T(2) * w;
        const T by_w = factor_slope * sum[i] + factor * T(2) * slope[i];
        out.height[i] += factor * sum[i];
        out.slope_x[i] += T(2) * form.forbes_scale * by_w * x[i];
        out.slope_y[i] += T(2) * form.forbes_scale * by_w * y[i];
    }
}

/// Horner scheme in y, whose coefficients are Horner schemes in x.
template <class T, int N>
REALCAM_HD inline void add_xy(const FreeformView<T>& form, const T* x, const T* y, FreeformSags<T, N>& out) {
    Lanes<T, N> sum, by_x, by_y, row, row_slope;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) sum[i] = by_x[i] = by_y[i] = T(0);
    const T* coefficient = form.xy;
    for (int j = form.xy_degree; j >= 0; --j) {
        REALCAM_LANES
        for (int i = 0; i < N; ++i) row[i] = row_slope[i] = T(0);
        for (int k = form.xy_degree - j; k >= 0; --k) {
            const T next = *coefficient++;
            REALCAM_LANES
            for (int i = 0; i < N; ++i) {
                row_slope[i] = row_slope[i] * (form.inverse_reach * x[i]) + row[i];
                row[i] = row[i] * (form.inverse_reach * x[i]) + next;
            }
        }
        REALCAM_LANES
        for (int i = 0; i < N; ++i) {
            const T v = form.inverse_reach * y[i];
            by_y[i] = by_y[i] * v + sum[i];
            sum[i] = sum[i] * v + row[i];
            by_x[i] = by_x[i] * v + row_slope[i];
        }
    }
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        out.height[i] += sum[i];
        out.slope_x[i] += form.inverse_reach * by_x[i];
        out.slope_y[i] += form.inverse_reach * by_y[i];
    }
}

}  // namespace freeform_detail

/// Computes the sag of a freeform at N points.
template <class T, int N>
REALCAM_HD inline void freeform_sags(const FreeformView<T>& form, const Lanes<T, N>& x, const Lanes<T, N>& y,
                                     FreeformSags<T, N>& out) {
    using namespace freeform_detail;
    Lanes<T, N> in_x, in_y;
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const InsidePoint<T> at = inside_point(form, x[i], y[i]);
        in_x[i] = at.x;
        in_y[i] = at.y;
    }
    set_base<T, N>(form, in_x, in_y, out);
    if (form.radial_terms > 0) add_radial<T, N>(form, in_x, in_y, out);
    if (form.forbes_terms > 0) add_forbes<T, N>(form, in_x, in_y, out);
    if (form.xy_degree >= 0) add_xy<T, N>(form, in_x, in_y, out);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const InsidePoint<T> at = inside_point(form, x[i], y[i]);
        // Outside the circle the sag is constant along the radius: only the tangential slope remains, and it decreases
        // with the distance.
        const bool is_outside = at.across < T(1);
        const T outwards = quotient(out.slope_x[i] * at.x + out.slope_y[i] * at.y, form.reach * form.reach);
        const T along_x = at.across * (out.slope_x[i] - outwards * at.x);
        const T along_y = at.across * (out.slope_y[i] - outwards * at.y);
        out.slope_x[i] = at.keeps_x * select(is_outside, along_x, out.slope_x[i]);
        out.slope_y[i] = at.keeps_y * select(is_outside, along_y, out.slope_y[i]);
    }
}

}  // namespace REALCAM_NAMESPACE
