#pragma once
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// The factors of the columns whose sum comes nearest to each target in the mean of squares, by Gram and Schmidt's
/// method (modified). All have the same length; columns are of size 1 or so. A column that is no new one, because it is
/// a sum of those before it, has the factor 0. Returns, for each target, a factor for each column.
std::vector<std::vector<double>> least_squares(const std::vector<std::vector<double>>& columns,
                                               std::vector<std::vector<double>> targets);

}  // namespace REALCAM_NAMESPACE
