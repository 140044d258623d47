#include "least_squares.hpp"

#include <cstddef>

namespace realcam {

std::vector<std::vector<double>> least_squares(const std::vector<std::vector<double>>& columns,
                                               std::vector<std::vector<double>> targets) {
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    };
    const auto subtract = [](std::vector<double>& from, double factor, const std::vector<double>& vector) {
        for (std::size_t i = 0; i < from.size(); ++i) from[i] -= factor * vector[i];
    };
    const std::size_t count = columns.size();
    std::vector<std::vector<double>> basis(count);  // orthogonal; empty for a linearly dependent column
    std::vector<double> sizes(count);
    std::vector<std::vector<double>> in_basis(count, std::vector<double>(count));  // coefficients of the columns in it
    std::vector<std::vector<double>> factors(targets.size(), std::vector<double>(count));
    for (std::size_t k = 0; k < count; ++k) {
        basis[k] = columns[k];
        for (std::size_t j = 0; j < k; ++j) {
            if (basis[j].empty()) continue;
            in_basis[k][j] = product(basis[k], basis[j]) / sizes[j];
            subtract(basis[k], in_basis[k][j], basis[j]);
        }
        sizes[k] = product(basis[k], basis[k]);
        if (sizes[k] > 1e-18 * static_cast<double>(columns[k].size())) {
            for (std::size_t t = 0; t < targets.size(); ++t) {
                factors[t][k] = product(targets[t], basis[k]) / sizes[k];
                subtract(targets[t], factors[t][k], basis[k]);
            }
        } else {
            basis[k].clear();
        }
    }
    for (std::vector<double>& of_target : factors)
        for (std::size_t k = count; k-- > 0;)
            for (std::size_t j = 0; j < k; ++j) of_target[j] -= in_basis[k][j] * of_target[k];
    return factors;
}

}  // namespace realcam
