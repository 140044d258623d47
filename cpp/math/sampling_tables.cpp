#include "sampling_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace realcam {

void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables) {
    double sum = 0;
    for (const double weight : weights) sum += weight;
    std::vector<double> share;  // weight relative to the mean weight
    std::vector<std::size_t> less, more;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        share.push_back(weights[i] / sum * static_cast<double>(weights.size()));
        (share[i] < 1 ? less : more).push_back(i);
    }
    AliasEntry* const table = (tables.resize(tables.size() + weights.size()), &tables[tables.size() - weights.size()]);
    while (!less.empty() && !more.empty()) {
        const std::size_t i = less.back(), giver = more.back();
        less.pop_back();
        table[i] = {static_cast<float>(share[i]), static_cast<std::int32_t>(giver)};
        share[giver] -= 1 - share[i];
        if (share[giver] < 1) {
            more.pop_back();
            less.push_back(giver);
        }
    }
    // Except for rounding, the remaining entries have the mean weight.
    for (const auto& left : {less, more})
        for (const std::size_t i : left) table[i] = {1, static_cast<std::int32_t>(i)};
}

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
