#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// K functions tabulated at the nodes of a grid, with bicubics between them (Hermite). The result is NaN in the cells
/// around a node whose values are NaN.
template <int K>
class SmoothGrid {
public:
    using Values = std::array<double, K>;
    /// Values, and their derivatives by column and by row.
    struct Point {
        Values value{}, by_column{}, by_row{};
    };

    /// `values`: row by row.
    SmoothGrid(int columns, int rows, const std::vector<Values>& values)
        : columns_(columns), rows_(rows), nodes_(values.size()) {
        for (std::size_t i = 0; i < values.size(); ++i) nodes_[i].value = values[i];
        set_slopes(&Node::value, &Node::by_column, 1, columns_);
        set_slopes(&Node::value, &Node::by_row, columns_, rows_);
        set_slopes(&Node::by_column, &Node::by_both, columns_, rows_);
    }

    int columns() const { return columns_; }  ///< number of columns of nodes
    int rows() const { return rows_; }
    const Values& node(int column, int row) const { return nodes_[index(column, row)].value; }

    /// Evaluates the functions; `column` from 0 to columns() - 1, and `row` likewise. Beyond, the outermost cell is
    /// extrapolated.
    Point at(double column, double row) const {
        const int left = std::clamp(static_cast<int>(column), 0, columns_ - 2);
        const int top = std::clamp(static_cast<int>(row), 0, rows_ - 2);
        const Weights x(column - left), y(row - top);
        Point point;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const Node& node = nodes_[index(left + i, top + j)];
                for (std::size_t k = 0; k < K; ++k) {
                    const double along = x.value[i] * node.value[k] + x.slope[i] * node.by_column[k];
                    const double rise = x.value[i] * node.by_row[k] + x.slope[i] * node.by_both[k];
                    point.value[k] += y.value[j] * along + y.slope[j] * rise;
                    point.by_row[k] += y.value_rise[j] * along + y.slope_rise[j] * rise;
                    point.by_column[k] +=
                        y.value[j] * (x.value_rise[i] * node.value[k] + x.slope_rise[i] * node.by_column[k]) +
                        y.slope[j] * (x.value_rise[i] * node.by_row[k] + x.slope_rise[i] * node.by_both[k]);
                }
            }
        return point;
    }

private:
    struct Node {
        Values value{}, by_column{}, by_row{}, by_both{};
    };

    /// Weights of the values and slopes at both ends of an interval, and their derivatives.
    struct Weights {
        double value[2], slope[2], value_rise[2], slope_rise[2];

        explicit Weights(double t) {
            const double u = 1 - t;
            value[0] = u * u * (1 + 2 * t), value[1] = t * t * (3 - 2 * t);
            slope[0] = t * u * u, slope[1] = -t * t * u;
            value_rise[0] = -6 * t * u, value_rise[1] = 6 * t * u;
            slope_rise[0] = u * (1 - 3 * t), slope_rise[1] = t * (3 * t - 2);
        }
    };

    std::size_t index(int column, int row) const { return static_cast<std::size_t>(row * columns_ + column); }

    /// Stores the slopes of `from` in `to`, along lines of `count` nodes that lie `stride` apart.
    void set_slopes(Values Node::* from, Values Node::* to, int stride, int count) {
        for (int i = 0; i < columns_ * rows_; ++i) {
            const int position = i / stride % count;
            const auto value = [&](int offset) -> const Values& {
                return nodes_[static_cast<std::size_t>(i + offset * stride)].*from;
            };
            const auto is_known = [&](int offset) {
                return position + offset >= 0 && position + offset < count && std::isfinite(value(offset)[0]);
            };
            nodes_[static_cast<std::size_t>(i)].*to = slope_of(value, is_known);
        }
    }

    /// Returns the slope by fourth-order finite differences over five nodes, as symmetric about this one as the edge
    /// and gaps permit; if there are fewer, over three or two. NaN if there are not even two.
    template <class Value, class IsKnown>
    static Values slope_of(Value&& value, IsKnown&& is_known) {
        struct Rule {
            int first, count;
            double weights[5];
        };
        constexpr double t = 1.0 / 12;
        static constexpr Rule kRules[] = {
            {-2, 5, {t, -8 * t, 0, 8 * t, -t}},
            {-1, 5, {-3 * t, -10 * t, 18 * t, -6 * t, t}},
            {-3, 5, {-t, 6 * t, -18 * t, 10 * t, 3 * t}},
            {0, 5, {-25 * t, 48 * t, -36 * t, 16 * t, -3 * t}},
            {-4, 5, {3 * t, -16 * t, 36 * t, -48 * t, 25 * t}},
            {-1, 3, {-0.5, 0, 0.5}},
            {0, 3, {-1.5, 2, -0.5}},
            {-2, 3, {0.5, -2, 1.5}},
            {0, 2, {-1, 1}},
            {-1, 2, {-1, 1}},
        };
        Values slope;
        slope.fill(std::numeric_limits<double>::quiet_NaN());
        for (const Rule& rule : kRules) {
            bool all = true;
            for (int n = 0; n < rule.count; ++n) all &= is_known(rule.first + n);
            if (!all) continue;
            slope.fill(0);
            for (int n = 0; n < rule.count; ++n)
                for (std::size_t k = 0; k < K; ++k) slope[k] += rule.weights[n] * value(rule.first + n)[k];
            break;
        }
        return slope;
    }

    int columns_, rows_;
    std::vector<Node> nodes_;
};

}  // namespace REALCAM_NAMESPACE
