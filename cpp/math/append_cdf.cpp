#include "append_cdf.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf) {
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

}  // namespace realcam
