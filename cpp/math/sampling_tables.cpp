#include "sampling_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace realcam {

void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables) {
    double sum = 0;
    for (const double weight : weights) sum += weight;
    std::vector<double> relative;  // weights in units of the mean weight
    std::vector<std::size_t> below_mean, above_mean;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        relative.push_back(weights[i] / sum * static_cast<double>(weights.size()));
        (relative[i] < 1 ? below_mean : above_mean).push_back(i);
    }
    AliasEntry* const table = (tables.resize(tables.size() + weights.size()), &tables[tables.size() - weights.size()]);
    while (!below_mean.empty() && !above_mean.empty()) {
        const std::size_t i = below_mean.back(), donor = above_mean.back();
        below_mean.pop_back();
        table[i] = {static_cast<float>(relative[i]), static_cast<std::int32_t>(donor)};
        relative[donor] -= 1 - relative[i];
        if (relative[donor] < 1) {
            above_mean.pop_back();
            below_mean.push_back(donor);
        }
    }
    // The entries that remain have the mean weight, up to rounding.
    for (const auto& remaining : {below_mean, above_mean})
        for (const std::size_t i : remaining) table[i] = {1, static_cast<std::int32_t>(i)};
}

void append_cdf(const std::vector<double>& weights, std::vector<float>& cdf) {
    constexpr double kSteps = 1 << 24;  // probabilities are multiples of 1 / kSteps
    double total = 0, count = 0;
    for (double w : weights) {
        total += w;
        count += w > 0;
    }
    // One step is reserved for each entry with a positive weight; the other steps are divided by weight.
    const double reserved = count <= kSteps ? count : 0;
    double sum = 0, reserved_before = 0;
    cdf.push_back(0.0f);
    for (double w : weights) {
        sum += total > 0 ? w / total : 1.0 / static_cast<double>(weights.size());
        reserved_before += reserved > 0 && w > 0;
        cdf.push_back(
            static_cast<float>((std::round(std::min(sum, 1.0) * (kSteps - reserved)) + reserved_before) / kSteps));
    }
}

}  // namespace realcam
