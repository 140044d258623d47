#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../prescription/shape_numbers.hpp"
#include "freeform.hpp"

namespace REALCAM_NAMESPACE {

// Conversion of a surface's prescription to the FreeformView that is traced.

namespace make_freeform_detail {

/// Sets the search region: the rectangle that bounds the surface's aperture, and the circle of its rim, both enlarged
/// by the factor `margin`.
template <class T>
void set_search_rectangle(FreeformView<T>& view, const Surface& surface, double margin) {
    const double rim = surface.clear_semi_diameter;
    const ApertureBox box = surface.aperture_shape.box(rim);
    view.middle_x = static_cast<T>(0.5 * (box.low.x + box.high.x));
    view.middle_y = static_cast<T>(0.5 * (box.low.y + box.high.y));
    view.half_x = static_cast<T>(margin * 0.5 * (box.high.x - box.low.x));
    view.half_y = static_cast<T>(margin * 0.5 * (box.high.y - box.low.y));
    view.reach = static_cast<T>(margin * rim);
    view.inverse_reach = static_cast<T>(1 / (margin * rim));
}

/// Calls f(x, y) at 65 x 65 points over the search region, including its edge.
template <class T, class F>
void for_each_point_of_region(const FreeformView<T>& view, F&& f) {
    constexpr int kHalf = 32;
    for (int i = -kHalf; i <= kHalf; ++i)
        for (int j = -kHalf; j <= kHalf; ++j) {
            const auto point = freeform_detail::inside_point(
                view, view.middle_x + view.half_x * static_cast<T>(i) / static_cast<T>(kHalf),
                view.middle_y + view.half_y * static_cast<T>(j) / static_cast<T>(kHalf));
            f(point.x, point.y);
        }
}

/// Sets the curvatures and conic factors of the base. `Number`, here and below: double, or dual numbers for derivatives
/// with respect to the surface's numbers.
template <class T, class Number>
void set_base_shape(FreeformView<T>& view, const Surface& surface, const ShapeNumbers<Number>& numbers) {
    const BaseForm base = surface.form.base;
    view.is_toroid = base == BaseForm::toroid;
    view.curvature_y = static_cast<T>(numbers.curvature);
    view.conic_factor_y = static_cast<T>(1 + numbers.conic);
    view.curvature_x = static_cast<T>(base == BaseForm::conic ? numbers.curvature : numbers.curvature_x);
    view.conic_factor_x = static_cast<T>(1 + (base == BaseForm::biconic ? numbers.conic_x : numbers.conic));
}

/// Sets the radial terms, which include the even aspheric terms; those of a toroid are set as the terms of its section.
/// `reach`: radius of the search region, the unit of lengths in the polynomials, mm. Adds the absolute values of the
/// coefficients to `size`, mm.
template <class T, class Number>
void set_radial_terms(FreeformView<T>& view, const ShapeNumbers<Number>& numbers, double reach, double& size) {
    std::vector<Number> radial(kMaxRadialTerms, Number(0.0));
    const auto scaled = [&](const Number& coefficient, std::size_t power) {
        const Number at_rim = coefficient * std::pow(reach, static_cast<int>(power));
        size += std::fabs(plain_value(at_rim));
        return at_rim;
    };
    for (std::size_t i = 0; i < numbers.radial.size(); ++i) radial[i] += scaled(numbers.radial[i], i + 1);
    for (std::size_t i = 0; i < numbers.aspheric.size(); ++i) {
        const Number term = scaled(numbers.aspheric[i], 2 * i + 4);
        if (view.is_toroid)
            view.section[view.section_terms++] = static_cast<T>(term);
        else
            radial[2 * i + 3] += term;
    }
    for (std::size_t i = 0; i < radial.size(); ++i) {
        view.radial[i] = static_cast<T>(radial[i]);
        if (!is_constant_zero(radial[i])) view.radial_terms = static_cast<std::int32_t>(i) + 1;
    }
}

/// Sets the terms of x and y, and those of the kinds in kFormTerms. `reach`, `size`: see set_radial_terms.
template <class T, class Number>
void set_polynomials(FreeformView<T>& view, const SurfaceForm& form, const ShapeNumbers<Number>& numbers, double reach,
                     double& size) {
    FormPolynomials<Number> sums{reach, {}, {}};
    sums.xy.add(numbers.xy, reach);
    std::size_t kind = 0;
    for_each_kind_of_terms(form, [&](const auto& terms) {
        if (terms) terms->add_to(sums, numbers.terms[kind], {numbers.curvature, numbers.conic});
        ++kind;
    });
    for (const Number& coefficient : sums.even) {
        view.forbes[view.forbes_terms++] = static_cast<T>(coefficient);
        size += std::fabs(plain_value(coefficient));
    }
    if (view.forbes_terms > 0) {
        view.forbes_scale = static_cast<T>(1 / (sums.even_radius * sums.even_radius));
        view.forbes_curvature_squared = static_cast<T>(numbers.curvature * numbers.curvature);
        view.is_bfs = sums.is_bfs ? T(1) : T(0);
    }
    view.xy_degree = std::max(view.xy_degree, sums.xy.degree);
    T* next = view.xy;
    for (int j = view.xy_degree; j >= 0; --j)
        for (int i = view.xy_degree - j; i >= 0; --i) {
            size += std::fabs(plain_value(sums.xy.at(i, j)));
            *next++ = static_cast<T>(sums.xy.at(i, j));
        }
}

/// Sets the bounds of the sag in the search region. They are sampled, then widened by more than the sag of a surface
/// that can be made changes between two samples. `reach`: radius of the region, mm.
template <class T>
void set_sag_bounds(FreeformView<T>& view, double reach) {
    double low = 0, high = 0;
    for_each_point_of_region(view, [&](T x, T y) {
        const Lanes<T, 1> xs = {x}, ys = {y};
        FreeformSags<T, 1> sag;
        freeform_sags<T, 1>(view, xs, ys, sag);
        low = std::min(low, static_cast<double>(sag.height[0]));
        high = std::max(high, static_cast<double>(sag.height[0]));
    });
    const double margin = 0.02 * (high - low) + 1e-3 * reach;
    view.sag_min = static_cast<T>(low - margin);
    view.sag_max = static_cast<T>(high + margin);
}

}  // namespace make_freeform_detail

/// Sets the base and the terms of a view whose search region is set and whose numbers of terms are 0. On entry, its
/// xy_degree is the smallest degree that the xy terms shall get, with coefficients of 0 if necessary, or -1.
template <class T, class Number>
void set_shape(FreeformView<T>& view, const Surface& surface, const ShapeNumbers<Number>& numbers) {
    using namespace make_freeform_detail;
    const double reach = 1 / plain_value(view.inverse_reach);
    double size = 0;
    set_base_shape(view, surface, numbers);
    set_radial_terms(view, numbers, reach, size);
    set_polynomials(view, surface.form, numbers, reach, size);
    view.term_size = static_cast<T>(size);
}

/// Returns a freeform surface prepared for tracing.
template <class T>
FreeformView<T> freeform_view(const Surface& surface) {
    using namespace make_freeform_detail;
    FreeformView<T> view{};
    view.xy_degree = -1;
    bool is_finite = true;
    // 2% past the rim, so that a ray that just misses it is found to miss it, unless the surface ends before.
    set_search_rectangle(view, surface, 1.02);
    for_each_point_of_region(view, [&](T x, T y) {
        is_finite &= std::isfinite(surface.sag(static_cast<double>(x), static_cast<double>(y)));
    });
    if (!is_finite) set_search_rectangle(view, surface, 1);
    set_shape(view, surface, ShapeNumbers<double>(surface));
    set_sag_bounds(view, 1 / static_cast<double>(view.inverse_reach));
    return view;
}

}  // namespace REALCAM_NAMESPACE
