#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../prescription/form_terms.hpp"
#include "../prescription/surface.hpp"
#include "freeform.hpp"

namespace REALCAM_NAMESPACE {

namespace make_freeform_detail {

/// Sets the search region: the rectangle that bounds the surface's opening and the circle of its rim, `margin` times as
/// large.
template <class T>
void set_rectangle(FreeformView<T>& view, const Surface& surface, double margin) {
    const double rim = surface.clear_semi_diameter;
    const ApertureBox box = surface.aperture_shape.box(rim);
    view.middle_x = static_cast<T>(0.5 * (box.low.x + box.high.x));
    view.middle_y = static_cast<T>(0.5 * (box.low.y + box.high.y));
    view.half_x = static_cast<T>(margin * 0.5 * (box.high.x - box.low.x));
    view.half_y = static_cast<T>(margin * 0.5 * (box.high.y - box.low.y));
    view.reach = static_cast<T>(margin * rim);
    view.inverse_reach = static_cast<T>(1 / (margin * rim));
}

/// Calls f(x, y) on a grid over the search region, including its edge.
template <class T, class F>
void over_region(const FreeformView<T>& view, F&& f) {
    constexpr int kHalf = 32;
    for (int i = -kHalf; i <= kHalf; ++i)
        for (int j = -kHalf; j <= kHalf; ++j) {
            const auto at = freeform_detail::inside_point(
                view, view.middle_x + view.half_x * static_cast<T>(i) / static_cast<T>(kHalf),
                view.middle_y + view.half_y * static_cast<T>(j) / static_cast<T>(kHalf));
            f(at.x, at.y);
        }
}

/// Coefficients of x^i y^j, i + j <= degree, as FreeformView::xy lists them.
struct XyTable {
    int degree = -1;
    std::vector<double> by_powers = std::vector<double>((kMaxXyDegree + 1) * (kMaxXyDegree + 1), 0.0);

    double& at(int x, int y) { return by_powers[static_cast<std::size_t>(x * (kMaxXyDegree + 1) + y)]; }
    void add(const std::vector<XyTerm>& terms, double unit) {
        for (const XyTerm& term : terms) {
            at(term.x, term.y) += term.coefficient * std::pow(unit, term.x + term.y);
            degree = std::max(degree, term.x + term.y);
        }
    }
};

template <class T>
void set_radial_terms(FreeformView<T>& view, const Surface& surface, double reach, double& size) {
    std::vector<double> radial(kMaxRadialTerms, 0.0);
    const auto scaled = [&](double coefficient, std::size_t power) {
        const double at_rim = coefficient * std::pow(reach, static_cast<int>(power));
        size += std::fabs(at_rim);
        return at_rim;
    };
    for (std::size_t i = 0; i < surface.form.radial.size(); ++i) radial[i] += scaled(surface.form.radial[i], i + 1);
    for (std::size_t i = 0; i < surface.aspheric.size(); ++i) {
        const double term = scaled(surface.aspheric[i], 2 * i + 4);
        if (view.is_toroid)
            view.section[view.section_terms++] = static_cast<T>(term);
        else
            radial[2 * i + 3] += term;
    }
    for (std::size_t i = 0; i < radial.size(); ++i) {
        view.radial[i] = static_cast<T>(radial[i]);
        if (radial[i] != 0) view.radial_terms = static_cast<std::int32_t>(i) + 1;
    }
}

template <class T>
void set_forbes_terms(FreeformView<T>& view, const Surface& surface, double& size) {
    const ForbesTerms& forbes = *surface.form.forbes;
    for (const double coefficient : forbes_polynomial(forbes)) {
        view.forbes[view.forbes_terms++] = static_cast<T>(coefficient);
        size += std::fabs(coefficient);
    }
    view.forbes_scale = static_cast<T>(1 / (forbes.radius * forbes.radius));
    view.forbes_curvature_squared = static_cast<T>(surface.curvature * surface.curvature);
    view.is_bfs = forbes.kind == ForbesKind::bfs ? T(1) : T(0);
}

template <class T>
void set_xy_terms(FreeformView<T>& view, const SurfaceForm& form, double reach, double& size) {
    XyTable table;
    table.add(form.xy, reach);
    if (form.zernike) table.add(zernike_as_xy(*form.zernike), reach / form.zernike->radius);
    view.xy_degree = table.degree;
    T* next = view.xy;
    for (int j = table.degree; j >= 0; --j)
        for (int i = table.degree - j; i >= 0; --i) {
            size += std::fabs(table.at(i, j));
            *next++ = static_cast<T>(table.at(i, j));
        }
}

/// Sets the bounds of the sag, sampled and widened by more than the sag of a surface that can be made changes between
/// two samples.
template <class T>
void set_sag_bounds(FreeformView<T>& view, double reach) {
    double low = 0, high = 0;
    over_region(view, [&](T x, T y) {
        const Lanes<T, 1> at_x = {x}, at_y = {y};
        FreeformSags<T, 1> sag;
        freeform_sags<T, 1>(view, at_x, at_y, sag);
        low = std::min(low, static_cast<double>(sag.height[0]));
        high = std::max(high, static_cast<double>(sag.height[0]));
    });
    const double margin = 0.02 * (high - low) + 1e-3 * reach;
    view.sag_min = static_cast<T>(low - margin);
    view.sag_max = static_cast<T>(high + margin);
}

}  // namespace make_freeform_detail

/// Returns a freeform surface prepared for tracing.
template <class T>
FreeformView<T> freeform_view(const Surface& surface) {
    using namespace make_freeform_detail;
    const SurfaceForm& form = surface.form;
    FreeformView<T> view{};
    bool is_finite = true;
    // 2% past the rim, so that a ray that just misses it is found to miss it, unless the surface ends before.
    set_rectangle(view, surface, 1.02);
    over_region(view, [&](T x, T y) {
        is_finite &= std::isfinite(surface.sag(static_cast<double>(x), static_cast<double>(y)));
    });
    if (!is_finite) set_rectangle(view, surface, 1);
    const double reach = 1 / static_cast<double>(view.inverse_reach);
    view.is_toroid = form.base == BaseForm::toroid;
    view.curvature_y = static_cast<T>(surface.curvature);
    view.conic_factor_y = static_cast<T>(1 + surface.conic);
    view.curvature_x = static_cast<T>(form.base == BaseForm::conic ? surface.curvature : form.curvature_x);
    view.conic_factor_x = static_cast<T>(1 + (form.base == BaseForm::biconic ? form.conic_x : surface.conic));
    double size = 0;
    set_radial_terms(view, surface, reach, size);
    if (form.forbes) set_forbes_terms(view, surface, size);
    set_xy_terms(view, form, reach, size);
    view.term_size = static_cast<T>(size);
    set_sag_bounds(view, reach);
    return view;
}

}  // namespace REALCAM_NAMESPACE
