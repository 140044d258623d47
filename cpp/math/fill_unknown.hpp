#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Replaces the unknown nodes of a regular grid of K functions, those whose first value is NaN, outwards from the known
/// ones. A node up to kLinearSteps steps away is extrapolated linearly from pairs of known nodes in its row and column;
/// any other gets the mean of its neighbours, because a line is no guide far beyond its nodes. `nodes`: row by row, at
/// least one of them known. `columns`: number of nodes in a row.
template <std::size_t K>
void fill_unknown(std::vector<std::array<double, K>>& nodes, int columns) {
    constexpr int kLinearSteps = 3;
    const int rows = static_cast<int>(nodes.size()) / columns;
    /// Returns the values of a node; null if it is unknown or outside the grid.
    const auto known = [&](int column, int row) -> const std::array<double, K>* {
        if (column < 0 || column >= columns || row < 0 || row >= rows) return nullptr;
        const std::array<double, K>& node = nodes[static_cast<std::size_t>(row * columns + column)];
        return std::isfinite(node[0]) ? &node : nullptr;
    };
    std::vector<std::pair<std::size_t, std::array<double, K>>> found;
    for (int step = 0; step < kLinearSteps || !found.empty(); ++step) {
        const bool is_linear = step < kLinearSteps;
        found.clear();
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                if (known(column, row)) continue;
                std::array<double, K> sum{};
                int count = 0;
                for (const auto& [right, down] :
                     {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
                    const auto* const near = known(column + right, row + down);
                    const auto* const far = is_linear ? known(column + 2 * right, row + 2 * down) : near;
                    if (!near || !far) continue;
                    for (std::size_t k = 0; k < K; ++k) sum[k] += 2 * (*near)[k] - (*far)[k];
                    ++count;
                }
                if (count == 0) continue;
                for (double& value : sum) value /= count;
                found.emplace_back(static_cast<std::size_t>(row * columns + column), sum);
            }
        for (const auto& [index, values] : found) nodes[index] = values;
    }
}

}  // namespace REALCAM_NAMESPACE
