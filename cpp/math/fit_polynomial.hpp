#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Coefficients, the constant first, of the polynomial that comes nearest to points (x, y) in the mean of squares, by
/// Gram and Schmidt's method (modified). x within [-1, 1]. A power that is no new one at these x, because they are few
/// or all the same, has the coefficient 0.
template <std::size_t kTerms>
std::array<double, kTerms> fit_polynomial(const std::vector<double>& x, std::vector<double> y) {
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    };
    const auto subtract = [](std::vector<double>& from, double factor, const std::vector<double>& vector) {
        for (std::size_t i = 0; i < from.size(); ++i) from[i] -= factor * vector[i];
    };
    std::array<std::vector<double>, kTerms> basis;  // orthogonal; empty where a power is no new one
    std::array<std::array<double, kTerms>, kTerms> in_basis{};  // powers in terms of it
    std::array<double, kTerms> coefficients{};
    std::vector<double> power(x.size(), 1);
    for (std::size_t k = 0; k < kTerms; ++k) {
        basis[k] = power;
        for (std::size_t j = 0; j < k; ++j) {
            if (basis[j].empty()) continue;
            in_basis[k][j] = product(basis[k], basis[j]) / product(basis[j], basis[j]);
            subtract(basis[k], in_basis[k][j], basis[j]);
        }
        const double size = product(basis[k], basis[k]);
        if (size > 1e-18 * static_cast<double>(x.size())) {
            coefficients[k] = product(y, basis[k]) / size;
            subtract(y, coefficients[k], basis[k]);
        } else {
            basis[k].clear();
        }
        for (std::size_t i = 0; i < x.size(); ++i) power[i] *= x[i];
    }
    for (std::size_t k = kTerms; k-- > 0;)
        for (std::size_t j = 0; j < k; ++j) coefficients[j] -= in_basis[k][j] * coefficients[k];
    return coefficients;
}

}  // namespace REALCAM_NAMESPACE
