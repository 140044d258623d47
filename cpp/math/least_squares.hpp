#pragma once
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Least-squares fit of each target by the columns, by the modified Gram-Schmidt method. All have the same length;
/// entries of columns are of the order of 1. A column that is a linear combination of those before it has the factor 0.
/// Returns, for each target, a factor for each column.
std::vector<std::vector<double>> least_squares(const std::vector<std::vector<double>>& columns,
                                               std::vector<std::vector<double>> targets);

}  // namespace REALCAM_NAMESPACE
