#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../../math/least_squares.hpp"
#include "../prescription/lens_system.hpp"
#include "lens_view.hpp"

namespace REALCAM_NAMESPACE {

// Preparation of the search on an even asphere (asphere.hpp): its polynomial, the approximations from which the search
// starts, and the bounds for rays that cross the surface exactly once.

/// Sets SurfaceView::aspheric, the polynomial of the even aspheric terms. `terms`: a4 R^4, a6 R^6, ..., the value of
/// each term at the search radius R, mm. In long double, because the sums cancel where the terms do.
template <class T>
void set_terms(SurfaceView<T>& view, const std::vector<long double>& terms) {
    std::vector<long double> shifted = terms;
    // Taylor shift to u = 1/2 by repeated Horner schemes, one for each power of u - 1/2.
    for (std::size_t power = 0; power < terms.size(); ++power)
        for (std::size_t i = terms.size() - 1; i-- > power;) shifted[i] += 0.5L * shifted[i + 1];
    std::transform(shifted.begin(), shifted.end(), view.aspheric,
                   [](long double term) { return static_cast<T>(term); });
}

/// Returns an upper bound of |d sag / d r| from the axis to the radius `relative_radius` (in units of the search
/// radius); infinite if the surface becomes vertical. `terms`: see set_terms. It is a strict bound, not a sample:
/// between two radii the conic's slope lies between its values at both, and so do the sums of the rising and of the
/// falling terms. The conic's parameters are the view's, because their rounding moves the edge.
template <class T>
double steepest_slope(const SurfaceView<T>& view, const std::vector<long double>& terms, double relative_radius) {
    constexpr int kSteps = 1024;
    const double reach = std::sqrt(static_cast<double>(view.search_squared)), c = static_cast<double>(view.curvature);
    struct Slopes {
        double conic, rising, falling;
    };
    const auto slopes_at = [&](double relative_r) -> Slopes {
        const double r = relative_r * reach;
        // Rounding can put the edge beyond the end of the conic.
        const double radicand = std::max(0.0, 1 - static_cast<double>(view.conic_factor) * c * c * r * r);
        Slopes slopes{c * r / std::sqrt(radicand), 0, 0};
        double power = relative_r * relative_r * relative_r / reach;
        for (std::size_t i = 0; i < terms.size(); ++i, power *= relative_r * relative_r) {
            const double slope = (4 + 2 * static_cast<double>(i)) * static_cast<double>(terms[i]) * power;
            (slope > 0 ? slopes.rising : slopes.falling) += slope;
        }
        return slopes;
    };
    double steepest = 0;
    Slopes inner = slopes_at(0);
    for (int i = 1; i <= kSteps; ++i) {
        const Slopes outer = slopes_at(relative_radius * i / kSteps);
        const double highest = std::max(inner.conic, outer.conic) + outer.rising + inner.falling,
                     lowest = std::min(inner.conic, outer.conic) + inner.rising + outer.falling;
        if (!std::isfinite(highest) || !std::isfinite(lowest)) return kInfinity;
        steepest = std::max({steepest, highest, -lowest});
        inner = outer;
    }
    return steepest;
}

/// Sets the approximations of the sag from which Newton's method starts (start, start_parabola), by least squares over
/// the search radius, and the bounds for rays that need no bracket (crossed_once_inside, crossed_once, inner_u).
/// `terms`: see set_terms.
template <class T>
void set_start(SurfaceView<T>& view, const Surface& surface, const std::vector<long double>& terms) {
    const double search_squared = static_cast<double>(view.search_squared), reach = std::sqrt(search_squared);
    constexpr double kInnerRadius = 0.9;
    // The tangent of 3 degrees: rays closer to the vertex plane are not treated as functions of the height.
    constexpr double kMinSlope = 0.05;
    // With a margin of 2%: the crossing of a ray nearly parallel to the surface is dominated by rounding errors.
    const auto crossed_once = [&](double relative_radius) {
        const double steepest = std::max(1.02 * steepest_slope(view, terms, relative_radius), kMinSlope);
        return static_cast<T>(1 / (steepest * steepest * search_squared));
    };
    view.inner_u = static_cast<T>(kInnerRadius * kInnerRadius);
    view.crossed_once_inside = crossed_once(kInnerRadius);
    view.crossed_once = crossed_once(1);
    constexpr int kPoints = 64;
    std::vector<double> u, height_over_u;
    for (int i = 0; i < kPoints; ++i) {
        u.push_back(0.5 - 0.5 * std::cos(std::numbers::pi * (i + 0.5) / kPoints));  // Chebyshev nodes
        height_over_u.push_back(surface.sag(reach * std::sqrt(u.back())) / u.back());
    }
    view.start_parabola = static_cast<T>(fit_polynomial<1>(u, height_over_u)[0]);
    const auto start = fit_polynomial<kStartTerms>(u, height_over_u);
    std::transform(start.begin(), start.end(), view.start, [](double term) { return static_cast<T>(term); });
}

}  // namespace REALCAM_NAMESPACE
