#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Fits each target by a linear combination of the columns, by least squares (modified Gram-Schmidt method). Columns
/// and targets must all have the same length, and the entries of columns should be of the order of 1. Returns a list of
/// coefficients for each target, one for each column. A column that is linearly dependent on the columns before it has
/// the coefficient 0.
std::vector<std::vector<double>> least_squares(const std::vector<std::vector<double>>& columns,
                                               std::vector<std::vector<double>> targets);

/// Returns the coefficients, constant term first, of the polynomial of degree kTerms - 1 that fits the points (x, y) by
/// least squares; x must lie within [-1, 1]. If there are fewer distinct x than coefficients, those of the highest
/// powers are 0.
template <std::size_t kTerms>
std::array<double, kTerms> fit_polynomial(const std::vector<double>& x, std::vector<double> y) {
    std::vector<std::vector<double>> powers(1, std::vector<double>(x.size(), 1));
    for (std::size_t k = 1; k < kTerms; ++k) {
        powers.push_back(powers.back());
        for (std::size_t i = 0; i < x.size(); ++i) powers[k][i] *= x[i];
    }
    std::array<double, kTerms> coefficients{};
    const auto fits = least_squares(powers, {std::move(y)});
    std::copy(fits[0].begin(), fits[0].end(), coefficients.begin());
    return coefficients;
}

}  // namespace REALCAM_NAMESPACE
