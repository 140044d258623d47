#pragma once
#include <vector>

#include "surface_form.hpp"

namespace REALCAM_NAMESPACE {

/// Degree n and azimuthal order m of a Zernike term, negative for a sine; `number` counts from 1.
struct ZernikeIndex {
    int n, m;
};
ZernikeIndex zernike_index(ZernikeOrder order, int number);

/// The terms as x^i y^j, in units of the circle's radius; coefficients in mm. Sorted by j, then by i, both falling.
std::vector<XyTerm> zernike_as_xy(const ZernikeTerms& terms);

/// The sum of Q_m(w) as a polynomial in 2 w - 1: coefficients of its powers, mm.
std::vector<double> forbes_polynomial(const ForbesTerms& terms);

}  // namespace REALCAM_NAMESPACE
