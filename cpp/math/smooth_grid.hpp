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

/// K functions of two variables, tabulated at the nodes of a regular grid and interpolated by bicubic Hermite
/// polynomials. A node may have NaN as values (not known): the functions are then NaN in the cells around it.
template <int K>
class SmoothGrid {
public:
    using Values = std::array<double, K>;
    /// Values of the functions at a position, and their derivatives by column and by row, per cell.
    struct Point {
        Values value{}, by_column{}, by_row{};
    };

    /// `values`: values at the nodes, row by row. There must be at least two columns and two rows of nodes.
    SmoothGrid(int columns, int rows, const std::vector<Values>& values)
        : columns_(columns), rows_(rows), nodes_(values.size()) {
        for (std::size_t i = 0; i < values.size(); ++i) nodes_[i].value = values[i];
        set_slopes(&Node::value, &Node::by_column, 1, columns_);
        set_slopes(&Node::value, &Node::by_row, columns_, rows_);
        set_slopes(&Node::by_column, &Node::by_both, columns_, rows_);
    }

    int columns() const { return columns_; }  ///< number of columns of nodes
    int rows() const { return rows_; }        ///< number of rows of nodes
    /// Values at a node.
    const Values& node(int column, int row) const { return nodes_[index(column, row)].value; }

    /// Evaluates the functions at a position in units of cells: `column` from 0 to columns() - 1 and `row` from 0 to
    /// rows() - 1. Outside the grid the outermost cell is extrapolated.
    Point at(double column, double row) const {
        const int left = std::clamp(static_cast<int>(column), 0, columns_ - 2);
        const int top = std::clamp(static_cast<int>(row), 0, rows_ - 2);
        const Weights x(column - left), y(row - top);
        Point point;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const Node& node = nodes_[index(left + i, top + j)];
                for (std::size_t k = 0; k < K; ++k) {
                    const double value_in_row = x.value[i] * node.value[k] + x.slope[i] * node.by_column[k];
                    const double slope_across_rows = x.value[i] * node.by_row[k] + x.slope[i] * node.by_both[k];
                    point.value[k] += y.value[j] * value_in_row + y.slope[j] * slope_across_rows;
                    point.by_row[k] += y.value_derivative[j] * value_in_row + y.slope_derivative[j] * slope_across_rows;
                    point.by_column[k] +=
                        y.value[j] *
                            (x.value_derivative[i] * node.value[k] + x.slope_derivative[i] * node.by_column[k]) +
                        y.slope[j] * (x.value_derivative[i] * node.by_row[k] + x.slope_derivative[i] * node.by_both[k]);
                }
            }
        return point;
    }

private:
    struct Node {
        Values value{}, by_column{}, by_row{};
        Values by_both{};  ///< mixed second derivative
    };

    /// Cubic Hermite basis functions at t, from 0 to 1: weights of the values and of the slopes at both ends of an
    /// interval, and the derivatives of these weights by t.
    struct Weights {
        double value[2], slope[2], value_derivative[2], slope_derivative[2];

        explicit Weights(double t) {
            const double u = 1 - t;
            value[0] = u * u * (1 + 2 * t), value[1] = t * t * (3 - 2 * t);
            slope[0] = t * u * u, slope[1] = -t * t * u;
            value_derivative[0] = -6 * t * u, value_derivative[1] = 6 * t * u;
            slope_derivative[0] = u * (1 - 3 * t), slope_derivative[1] = t * (3 * t - 2);
        }
    };

    std::size_t index(int column, int row) const { return static_cast<std::size_t>(row * columns_ + column); }

    /// Estimates the derivative of member `from` along a grid line and stores it in member `to` of all nodes. A line
    /// has `count` nodes, whose indices differ by `stride`.
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

    /// Returns the slope at a node by finite differences: by the first of the rules below for which all nodes are
    /// known. Returns NaN if there is no such rule. `value(offset)`, `is_known(offset)`: of the node `offset` nodes
    /// further.
    template <class Value, class IsKnown>
    static Values slope_of(Value&& value, IsKnown&& is_known) {
        struct Rule {
            int first;  // offset of the first node of the rule
            int count;  // number of nodes: 5 for fourth order, 3 for second order, 2 for first order
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
