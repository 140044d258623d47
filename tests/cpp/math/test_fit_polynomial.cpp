// Least-squares fits recover a polynomial; coefficients that the points do not determine are 0.

#include "doctest/doctest.h"
#include "math/least_squares.hpp"

using realcam::fit_polynomial;

TEST_CASE("a polynomial is found again from more points than it has terms") {
    std::vector<double> x, y;
    for (int i = 0; i < 20; ++i) {
        x.push_back(-1 + i / 9.5);
        y.push_back(3 - x.back() + 0.5 * std::pow(x.back(), 3) - 7 * std::pow(x.back(), 7));
    }
    const auto c = fit_polynomial<8>(x, y);
    const double expected[8] = {3, -1, 0, 0.5, 0, 0, 0, -7};
    for (std::size_t i = 0; i < 8; ++i) CHECK(c[i] == doctest::Approx(expected[i]).epsilon(1e-11).scale(1));
}

TEST_CASE("least squares leave residuals that no power of the fit takes part in") {
    const std::vector<double> x = {-1, -0.2, 0.1, 0.5, 1}, y = {2, 0, 1, -3, 4};
    const auto c = fit_polynomial<3>(x, y);
    for (int power = 0; power < 3; ++power) {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            sum += std::pow(x[i], power) * (y[i] - c[0] - c[1] * x[i] - c[2] * x[i] * x[i]);
        CHECK(std::fabs(sum) < 1e-12);
    }
}

TEST_CASE("points at one or two places have a constant or a line") {
    const auto one = fit_polynomial<4>({0.3, 0.3}, {5, 7});
    CHECK(one[0] == doctest::Approx(6));
    CHECK(std::fabs(one[1]) + std::fabs(one[2]) + std::fabs(one[3]) == 0);
    const auto two = fit_polynomial<4>({-0.5, 0.5, 0.5}, {1, 2, 4});
    CHECK(two[0] == doctest::Approx(2));
    CHECK(two[1] == doctest::Approx(2));
    CHECK(std::fabs(two[2]) + std::fabs(two[3]) == 0);
}
