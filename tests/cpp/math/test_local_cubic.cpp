// Interpolation through nodes at uneven distances is exact for odd and even cubics, which continue by symmetry below 0.

#include "doctest/doctest.h"
#include "math/local_cubic.hpp"

using realcam::LocalCubic;

TEST_CASE("odd and even cubics are found again between any nodes") {
    const std::vector<double> nodes = {0, 0.3, 0.4, 1.1, 1.3, 2};
    for (const double x : {0.0, 0.1, 0.35, 0.4, 1.0, 1.2, 1.9}) {
        const auto cubic = LocalCubic::at(nodes, x);
        REQUIRE(cubic);
        CHECK(cubic->odd([&](std::size_t i) { return 2 * nodes[i] - std::pow(nodes[i], 3); }) ==
              doctest::Approx(2 * x - x * x * x).epsilon(1e-13).scale(1));
        CHECK(cubic->even([&](std::size_t i) { return 5 - 3 * nodes[i] * nodes[i]; }) ==
              doctest::Approx(5 - 3 * x * x).epsilon(1e-13).scale(1));
    }
}

TEST_CASE("there is nothing beyond the nodes, nor through two of them") {
    CHECK(!LocalCubic::at({0, 1, 2, 3}, 3));
    CHECK(!LocalCubic::at({0, 1, 2, 3}, -0.1));
    CHECK(!LocalCubic::at({0, 1}, 0.5));
    CHECK(LocalCubic::at({0, 1, 2}, 0.5));
}
