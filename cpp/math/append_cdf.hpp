#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Appends weights as count + 1 cumulative probabilities in steps of 2^-24 (see math/cdf.hpp). Whatever has weight
/// keeps at least one step, as long as there are enough. All alike where there is no weight at all.
inline void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf) {
    constexpr double kSteps = 1 << 24;
    double total = 0, count = 0;
    for (double w : weights) {
        total += w;
        count += w > 0;
    }
    const double kept = count <= kSteps ? count : 0;
    double sum = 0, before = 0;
    cdf.push_back(0.0f);
    for (double w : weights) {
        sum += total > 0 ? w / total : 1.0 / static_cast<double>(weights.size());
        before += kept > 0 && w > 0;
        cdf.push_back(static_cast<float>((std::round(std::min(sum, 1.0) * (kSteps - kept)) + before) / kSteps));
    }
}

}  // namespace REALCAM_NAMESPACE
