// Unknown nodes of a grid continue a plane near the known ones, and stay within its values farther away.

#include "math/fill_unknown.hpp"

#include <limits>

#include "doctest/doctest.h"

using realcam::fill_unknown;
using Nodes = std::vector<std::array<double, 2>>;

namespace {

constexpr int kColumns = 12, kRows = 7;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double height(int column, int row) {
    return 1 + 2 * column - 3 * row;
}

/// Returns a plane whose known columns are `first` to `last`.
Nodes plane(int first, int last) {
    Nodes nodes;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const bool is_known = column >= first && column <= last;
            nodes.push_back({is_known ? height(column, row) : kUnknown, is_known ? -height(column, row) : kUnknown});
        }
    return nodes;
}

}  // namespace

TEST_CASE("three nodes beyond the known ones lie on their plane, and the others have the last of them") {
    Nodes nodes = plane(4, 6);
    fill_unknown(nodes, kColumns);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const auto& [value, negative] = nodes[static_cast<std::size_t>(row * kColumns + column)];
            // Columns farther than three from the known ones 4 to 6 repeat column 1 or 9.
            const int nearest = column < 1 ? 1 : column > 9 ? 9 : column;
            CHECK(value == height(nearest, row));
            CHECK(negative == -value);
        }
}

TEST_CASE("known nodes stay, and a grid without any stays unknown") {
    Nodes nodes = plane(0, kColumns);
    fill_unknown(nodes, kColumns);
    CHECK(nodes == plane(0, kColumns));
    nodes = plane(kColumns, kColumns);
    fill_unknown(nodes, kColumns);
    for (const auto& [value, negative] : nodes) CHECK(std::isnan(value));
}
