// 8-bit codes that are looked up, against those that are computed.

#include <cmath>
#include <limits>
#include <random>

#include "camera/film/develop.hpp"
#include "doctest/doctest.h"

using namespace realcam;

TEST_CASE("looked-up codes are those of the tone curve and of sRGB") {
    std::mt19937 random(7);
    // A float beside the border of two codes may fall on either side where pow is not monotonic to its last bit; none
    // of these draws is so near.
    std::uniform_real_distribution<double> exponent(-9, 5);
    for (const double iso : {25.0, 100.0, 6400.0})
        for (const ToneCurve curve : {ToneCurve::film, ToneCurve::linear}) {
            const CodeTable code(iso, curve);
            int wrong = 0;
            for (int i = 0; i < 100'000; ++i) {
                const auto exposure = static_cast<float>(std::pow(10, exponent(random)));
                const double value = sensor_value(static_cast<double>(exposure), iso);
                wrong += code(exposure) != srgb_code(apply_tone_curve(curve, value));
            }
            CHECK(wrong == 0);
            constexpr float infinity = std::numeric_limits<float>::infinity();
            CHECK(code(0.f) == 0);
            CHECK(code(-1.f) == 0);
            CHECK(code(-infinity) == 0);
            CHECK(code(std::numeric_limits<float>::quiet_NaN()) == 0);
            CHECK(code(infinity) == 255);
            CHECK(code(static_cast<float>(10 / iso)) == 118);  // middle grey
        }
}
