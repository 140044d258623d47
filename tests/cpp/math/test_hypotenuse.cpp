#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "doctest/doctest.h"
#include "math/hypotenuse.hpp"

using namespace realcam;

namespace {

using Exact = boost::multiprecision::cpp_bin_float_100;

// The error in units of the last place of the exact value.
template <class Number>
double error_ulp(Number x, Number y) {
    const Exact exact = sqrt(Exact(x) * Exact(x) + Exact(y) * Exact(y));
    const auto near = static_cast<Number>(exact);
    const Number ulp = std::nextafter(near, std::numeric_limits<Number>::infinity()) - near;
    return static_cast<double>(abs(Exact(hypotenuse(x, y)) - exact) / Exact(ulp));
}

}  // namespace

TEST_CASE("hypotenuse is rounded as well as the C library's") {
    // Half a unit is a perfect rounding. The wider number's own three roundings add 2^-11 of each; of single numbers
    // the squares are exact, and 2^-29 of the sum and the root are lost.
    double worst = 0, worst_single = 0;
    std::mt19937 random(1);
    const auto draw = [&](double most) { return std::uniform_real_distribution<>(-most, most)(random); };
    for (int i = 0; i < 20000; ++i) {
        const double x = draw(1) * std::exp2(draw(60)), y = x * draw(1) * std::exp2(draw(30));
        worst = std::max(worst, error_ulp(x, y));
        worst_single = std::max(worst_single, error_ulp(static_cast<float>(x), static_cast<float>(y)));
    }
    CHECK(worst < 0.502);
    CHECK(worst_single < 0.5001);
}

TEST_CASE("hypotenuse knows triples of whole numbers, the ends of the range, and what is no number") {
    CHECK(hypotenuse(3.0, -4.0) == 5);
    CHECK(hypotenuse(-5.0f, 12.0f) == 13);
    CHECK(hypotenuse(3e300, 4e300) == doctest::Approx(5e300).epsilon(1e-15));
    CHECK(hypotenuse(3e-310, 4e-310) == doctest::Approx(5e-310).epsilon(1e-13));  // of 1e14 steps
    CHECK(hypotenuse(3e38f, 0.0f) == 3e38f);
    CHECK(hypotenuse(3e-40f, 4e-40f) == doctest::Approx(5e-40).epsilon(1e-5));
    const double infinite = std::numeric_limits<double>::infinity(), none = std::nan("");
    CHECK(hypotenuse(1.7e308, 1.7e308) == infinite);
    CHECK(hypotenuse(none, -infinite) == infinite);
    CHECK(std::isnan(hypotenuse(none, 1.0)));
    CHECK(hypotenuse(0.0, -0.0) == 0);
}
