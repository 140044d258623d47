#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Least-squares fit of each target by the columns, by the modified Gram-Schmidt method. All have the same length;
/// entries of columns are of the order of 1. A column that is a linear combination of those before it has the factor 0.
/// Returns, for each target, a factor for each column.
std::vector<std::vector<double>> least_squares(const std::vector<std::vector<double>>& columns,
                                               std::vector<std::vector<double>> targets);

/// Returns the coefficients, constant first, of the least-squares polynomial for points (x, y), with x within [-1, 1].
/// A power that is linearly dependent on lower ones at these x, because they are few or coincide, has the coefficient
/// 0.
template <std::size_t kTerms>
std::array<double, kTerms> fit_polynomial(const std::vector<double>& x, std::vector<double> y) {
    std::vector<std::vector<double>> powers(1, std::vector<double>(x.size(), 1));
    for (std::size_t k = 1; k < kTerms; ++k) {
        powers.push_back(powers.back());
        for (std::size_t i = 0; i < x.size(); ++i) powers[k][i] *= x[i];
    }
    std::array<double, kTerms> coefficients{};
    const auto factors = least_squares(powers, {std::move(y)});
    std::copy(factors[0].begin(), factors[0].end(), coefficients.begin());
    return coefficients;
}

}  // namespace REALCAM_NAMESPACE
