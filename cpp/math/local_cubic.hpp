#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Lagrange interpolation of odd or even functions at one position, by the cubic through the four nearest nodes, two on
/// either side if possible. Left of node 0 the mirror images of the nodes are used. Nodes need not be equidistant.
class LocalCubic {
public:
    /// Prepares the interpolation at `position`. `nodes` must start at 0 and increase. Returns std::nullopt if
    /// `position` does not lie between two nodes, or if there are fewer than three nodes.
    static std::optional<LocalCubic> at(const std::vector<double>& nodes, double position) {
        const auto count = static_cast<std::ptrdiff_t>(nodes.size());
        const std::ptrdiff_t above = std::upper_bound(nodes.begin(), nodes.end(), position) - nodes.begin();
        if (count < 3 || above < 1 || above >= count) return std::nullopt;
        const std::ptrdiff_t first = std::min(above - 2, count - 4);
        std::array<double, 4> x{};
        LocalCubic cubic;
        for (std::ptrdiff_t i = 0; i < 4; ++i) {
            const std::ptrdiff_t node = first + i;  // below 0: the mirror image of node -`node`
            const auto k = static_cast<std::size_t>(i);
            cubic.mirrored_[k] = node < 0;
            cubic.nodes_[k] = static_cast<std::size_t>(node < 0 ? -node : node);
            x[k] = node < 0 ? -nodes[cubic.nodes_[k]] : nodes[cubic.nodes_[k]];
        }
        for (std::size_t i = 0; i < 4; ++i) {
            cubic.weights_[i] = 1;
            for (std::size_t j = 0; j < 4; ++j)
                if (j != i) cubic.weights_[i] *= (position - x[j]) / (x[i] - x[j]);
        }
        return cubic;
    }

    /// Interpolates an odd function. `value(i)` must return the function's value at node i.
    template <class Value>
    double odd(Value&& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += (mirrored_[i] ? -weights_[i] : weights_[i]) * value(nodes_[i]);
        return sum;
    }
    /// Interpolates an even function. `value(i)` must return the function's value at node i.
    template <class Value>
    double even(Value&& value) const {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += weights_[i] * value(nodes_[i]);
        return sum;
    }

private:
    std::array<std::size_t, 4> nodes_{};
    std::array<double, 4> weights_{};
    std::array<bool, 4> mirrored_{};
};

}  // namespace REALCAM_NAMESPACE
