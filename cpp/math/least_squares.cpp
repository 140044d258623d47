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
    constexpr double kDependent = 1e-18;  // mean square of a column's independent part that counts as rounding error
    const std::size_t count = columns.size();
    std::vector<std::vector<double>> basis(count);  // orthogonal; empty for a linearly dependent column
    std::vector<double> squares(count);             // squared lengths of the basis vectors
    std::vector<std::vector<double>> in_basis(count, std::vector<double>(count));  // coefficients of the columns
    std::vector<std::vector<double>> coefficients(targets.size(), std::vector<double>(count));
    for (std::size_t k = 0; k < count; ++k) {
        basis[k] = columns[k];
        for (std::size_t j = 0; j < k; ++j) {
            if (basis[j].empty()) continue;
            in_basis[k][j] = product(basis[k], basis[j]) / squares[j];
            subtract(basis[k], in_basis[k][j], basis[j]);
        }
        squares[k] = product(basis[k], basis[k]);
        if (squares[k] > kDependent * static_cast<double>(columns[k].size())) {
            for (std::size_t t = 0; t < targets.size(); ++t) {
                coefficients[t][k] = product(targets[t], basis[k]) / squares[k];
                subtract(targets[t], coefficients[t][k], basis[k]);
            }
        } else {
            basis[k].clear();
        }
    }
    for (std::vector<double>& of_target : coefficients)
        for (std::size_t k = count; k-- > 0;)
            for (std::size_t j = 0; j < k; ++j) of_target[j] -= in_basis[k][j] * of_target[k];
    return coefficients;
}

}  // namespace realcam
