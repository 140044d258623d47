#pragma once
#include <vector>

#include "../platform.hpp"
#include "cdf.hpp"

namespace REALCAM_NAMESPACE {

/// Appends weights as count + 1 cumulative probabilities in steps of 2^-24 (see math/cdf.hpp). Each entry with a
/// positive weight gets at least one step, as long as there are enough steps. If all weights are 0, the distribution is
/// uniform.
void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf);

/// Appends the alias table of these weights (Vose 1991). At least one weight must be above 0.
void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables);

}  // namespace REALCAM_NAMESPACE
