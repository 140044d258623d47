#include "glass_error.hpp"

#include <cmath>

namespace realcam {

namespace {

/// n'^2 = constant + scale (n^2 - 1) keeps the poles of Sellmeier's formula; the constant becomes a term with C = 0.
/// Newton's method finds the scale from n'_F - n'_C.
Glass with_sellmeier_error(const Glass& glass, Glass::Parts parts, double index_d, double dispersion) {
    const double square_d = glass.index(kLineD_nm) * glass.index(kLineD_nm);
    const double above = glass.index(kLineF_nm) * glass.index(kLineF_nm) - square_d;
    const double below = glass.index(kLineC_nm) * glass.index(kLineC_nm) - square_d;
    double scale = 1;
    for (int step = 0; step < 20; ++step) {
        const double n_f = std::sqrt(index_d * index_d + scale * above);
        const double n_c = std::sqrt(index_d * index_d + scale * below);
        scale -= (n_f - n_c - dispersion) / (above / (2 * n_f) - below / (2 * n_c));
    }
    for (std::size_t i = 0; i < parts.coefficients.size(); i += 2) parts.coefficients[i] *= scale;
    const double constant = index_d * index_d - 1 - scale * (square_d - 1);
    parts.coefficients.push_back(constant);
    parts.coefficients.push_back(0);
    return Glass::from_parts(std::move(parts));
}

}  // namespace

Glass with_melt_error(const Glass& glass, double index, double abbe) {
    if (index == 0 && abbe == 0) return glass;
    const double before_d = glass.index(kLineD_nm), index_d = before_d + index;
    const double spread = glass.index(kLineF_nm) - glass.index(kLineC_nm);
    if (!(index_d >= 1 && abbe > -1)) throw InputError("an error of a glass leaves an index below 1");
    if (abbe != 0 && !(spread > 0))
        throw InputError("the dispersion of glass \"" + glass.label + "\" is not known, and neither its Abbe number");
    // V = (n_d - 1) / (n_F - n_C); a glass without dispersion needs no scaling.
    const double scale = spread > 0 ? (index_d - 1) / ((before_d - 1) * (1 + abbe)) : 1;
    Glass::Parts parts = glass.parts();
    if (parts.formula == Glass::Formula::sellmeier)
        return with_sellmeier_error(glass, std::move(parts), index_d, scale * spread);
    for (double& coefficient : parts.coefficients) coefficient *= scale;
    if (parts.formula == Glass::Formula::cauchy) parts.coefficients[0] += index_d - scale * before_d;
    for (Glass::TablePoint& point : parts.points) point.index = index_d + scale * (point.index - before_d);
    return Glass::from_parts(std::move(parts));
}

}  // namespace realcam
