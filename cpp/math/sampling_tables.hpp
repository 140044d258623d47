#pragma once
#include <vector>

#include "../platform.hpp"
#include "cdf.hpp"

// Builds the tables from which cdf.hpp draws indices.

namespace REALCAM_NAMESPACE {

/// Appends the table of weights.size() + 1 cumulative probabilities, rounded to multiples of 2^-24. Weights must not be
/// negative. Each entry with a positive weight has a probability of at least 2^-24, unless there are more than 2^24
/// such entries. If all weights are 0, the distribution is uniform.
void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf);

/// Appends the alias table of these weights (Vose 1991). Weights must not be negative, and at least one must be above
/// 0.
void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables);

}  // namespace REALCAM_NAMESPACE
