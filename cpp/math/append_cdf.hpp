#pragma once
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Appends weights as count + 1 cumulative probabilities in steps of 2^-24 (see math/cdf.hpp). Each entry with a
/// positive weight gets at least one step, as long as there are enough steps. If all weights are 0, the distribution is
/// uniform.
void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf);

}  // namespace REALCAM_NAMESPACE
