#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Interpolation by the cubic through the four nodes nearest to a point, two on either side if possible, of functions
/// that are odd or even. Nodes need not be equidistant.
class LocalCubic {
public:
    /// `nodes` increase from 0. Returns std::nullopt if `position` is not between two of them, or if there are fewer
    /// than three.
    static std::optional<LocalCubic> at(const std::vector<double>& nodes, double position) {
        const auto count = static_cast<std::ptrdiff_t>(nodes.size());
        const std::ptrdiff_t above = std::upper_bound(nodes.begin(), nodes.end(), position) - nodes.begin();
        if (count < 3 || above < 1 || above >= count) return std::nullopt;
        const std::ptrdiff_t first = std::min(above - 2, count - 4);
        std::array<double, 4> x{};
        LocalCubic cubic;
        for (std::ptrdiff_t i = 0; i < 4; ++i) {
            const std::ptrdiff_t node = first + i;  // below 0: mirror image of a node
            const auto k = static_cast<std::size_t>(i);
            cubic.mirrored_[k] = node < 0;
            cubic.nodes_[k] = static_cast<std::size_t>(node < 0 ? -node : node);
            x[k] = node < 0 ? -nodes[cubic.nodes_[k]] : nodes[cubic.nodes_[k]];
        }
        for (std::size_t i = 0; i < 4; ++i) {
            cubic.shares_[i] = 1;
            for (std::size_t j = 0; j < 4; ++j)
                if (j != i) cubic.shares_[i] *= (position - x[j]) / (x[i] - x[j]);
        }
        return cubic;
    }

    /// Interpolates an odd function; `value` returns the function's value at the node of an index.
    template <class Value>
    double odd(Value&& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += (mirrored_[i] ? -shares_[i] : shares_[i]) * value(nodes_[i]);
        return sum;
    }
    template <class Value>
    double even(Value&& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += shares_[i] * value(nodes_[i]);
        return sum;
    }

private:
    std::array<std::size_t, 4> nodes_{};
    std::array<double, 4> shares_{};
    std::array<bool, 4> mirrored_{};
};

}  // namespace REALCAM_NAMESPACE
