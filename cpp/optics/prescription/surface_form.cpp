#include "surface_form.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

namespace {

bool any_of(const std::vector<double>& values) {
    return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
}

bool any_of(const std::vector<XyTerm>& terms) {
    return std::any_of(terms.begin(), terms.end(), [](const XyTerm& term) { return term.coefficient != 0; });
}

}  // namespace

bool SurfaceForm::is_none() const {
    return base == BaseForm::conic && !any_of(radial) && !any_of(xy) && !(zernike && any_of(zernike->coefficients)) &&
           !(forbes && any_of(forbes->coefficients));
}

SurfaceForm SurfaceForm::scaled(double factor) const {
    SurfaceForm result = *this;
    result.curvature_x /= factor;
    for (std::size_t i = 0; i < radial.size(); ++i) result.radial[i] /= std::pow(factor, static_cast<int>(i));
    for (XyTerm& term : result.xy) term.coefficient *= std::pow(factor, 1 - term.x - term.y);
    const auto scale = [&](auto& terms) {
        if (!terms) return;
        terms->radius *= factor;
        for (double& coefficient : terms->coefficients) coefficient *= factor;
    };
    scale(result.zernike);
    scale(result.forbes);
    return result;
}

SurfaceForm SurfaceForm::turned() const {
    SurfaceForm result = *this;
    result.curvature_x = -curvature_x;
    for (double& coefficient : result.radial) coefficient = -coefficient;
    for (XyTerm& term : result.xy) term.coefficient = -term.coefficient;
    if (result.zernike)
        for (double& coefficient : result.zernike->coefficients) coefficient = -coefficient;
    if (result.forbes)
        for (double& coefficient : result.forbes->coefficients) coefficient = -coefficient;
    return result;
}

std::string SurfaceForm::asymmetry() const {
    if (base == BaseForm::biconic) return "is biconic";
    if (base == BaseForm::toroid) return "is toroidal";
    if (any_of(xy)) return "has terms of x and y";
    if (zernike && any_of(zernike->coefficients)) return "has Zernike terms";
    return "";
}

}  // namespace realcam
