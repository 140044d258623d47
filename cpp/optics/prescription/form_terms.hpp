#pragma once
#include <vector>

#include "surface_form.hpp"

namespace REALCAM_NAMESPACE {

/// Degree n and azimuthal order m of a Zernike term (m < 0: sine).
struct ZernikeIndex {
    int n, m;
};
/// Returns the indices of term `number`, counted from 1.
ZernikeIndex zernike_index(ZernikeOrder order, int number);

/// The terms as a sum of x^i y^j, with x and y in units of the circle's radius and coefficients in mm. Sorted by j,
/// then by i, both descending.
std::vector<XyTerm> zernike_as_xy(const ZernikeTerms& terms);

/// The weighted sum of Q_m(w), w = (r / radius)^2, as a polynomial in 2 w - 1: coefficients by ascending power, mm.
std::vector<double> forbes_polynomial(const ForbesTerms& terms);

}  // namespace REALCAM_NAMESPACE
