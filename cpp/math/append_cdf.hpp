#pragma once
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Appends weights as count + 1 cumulative probabilities in steps of 2^-24 (see math/cdf.hpp). Whatever has weight
/// keeps at least one step, as long as there are enough. All alike where there is no weight at all.
void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf);

}  // namespace REALCAM_NAMESPACE
