#include "surface_form.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

namespace {

using form_detail::any_of;

/// True if a coefficient is not 0.
bool any_xy(const std::vector<XyTerm>& terms) {
    return std::any_of(terms.begin(), terms.end(), [](const XyTerm& term) { return term.coefficient != 0; });
}

}  // namespace

bool SurfaceForm::has_terms() const {
    bool found = !radial.empty() || !xy.empty();
    for_each_present_terms(*this, [&](const auto&) { found = true; });
    return found;
}

bool SurfaceForm::adds_nothing() const {
    bool found = base != BaseForm::conic || any_of(radial) || any_xy(xy);
    for_each_present_terms(*this, [&](const auto& terms) { found |= any_of(terms.coefficients); });
    return !found;
}

SurfaceForm SurfaceForm::scaled(double factor) const {
    SurfaceForm result = *this;
    result.curvature_x /= factor;
    for (std::size_t i = 0; i < radial.size(); ++i) result.radial[i] /= std::pow(factor, static_cast<int>(i));
    for (XyTerm& term : result.xy) term.coefficient *= std::pow(factor, 1 - term.x - term.y);
    for_each_present_terms(result, [&](auto& terms) {
        terms.radius *= factor;
        if (!terms.words.are_lengths) return;
        for (double& coefficient : terms.coefficients) coefficient *= factor;
    });
    return result;
}

SurfaceForm SurfaceForm::negated() const {
    SurfaceForm result = *this;
    result.curvature_x = -curvature_x;
    form_detail::negate_all(result.radial);
    for (XyTerm& term : result.xy) term.coefficient = -term.coefficient;
    for_each_present_terms(result, [](auto& terms) { terms.negate(); });
    return result;
}

std::string SurfaceForm::asymmetry() const {
    if (base == BaseForm::biconic) return "is biconic";
    if (base == BaseForm::toroid) return "is toroidal";
    if (any_xy(xy)) return "has terms of x and y";
    std::string why;
    for_each_present_terms(*this, [&](const auto& terms) {
        if (why.empty() && any_of(terms.coefficients)) why = terms.words.asymmetry;
    });
    return why;
}

}  // namespace realcam
