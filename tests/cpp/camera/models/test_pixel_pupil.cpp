// Pixels that learn where light passes the lens.

#include "camera/models/pixel_pupil.hpp"

#include <cmath>
#include <vector>

#include "doctest/doctest.h"
#include "math/random.hpp"
#include "render/session/adaptive_sampling.hpp"

using namespace realcam;

TEST_CASE("the bit with so many others below it") {
    for (const std::uint32_t bits : {0x1u, 0x80000000u, 0xffffffffu, 0xa5a5a5a5u, 0x00010100u}) {
        std::uint32_t below = 0;
        for (int place = 0; place < 32; ++place) {
            if (!(bits >> place & 1u)) continue;
            CHECK(pixel_pupil::position_of_bit(bits, below) == place);
            ++below;
        }
    }
}

// Whatever is known, each cell of the square has its area: the sum of weights is that of 2^16 samples, whose (0,2)
// points err by less than 1%.
TEST_CASE("weights make up for where samples go") {
    constexpr std::uint32_t kSamples = 1u << 16;
    for (const std::uint32_t known : {0x0u, 0x1u, 0x80000000u, 0x00ff00ffu, 0xffffffffu}) {
        std::vector<double> areas(32);
        double in_known = 0;
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const GuidedSample at = guided(known, sample_2d(3, i, 0));
            REQUIRE((at.point.x >= 0 && at.point.x < 1 && at.point.y >= 0 && at.point.y < 1));
            const int cell = pixel_pupil::cell_of(at.point);
            areas[static_cast<std::size_t>(cell)] += static_cast<double>(at.weight) / kSamples;
            in_known += (known >> cell & 1u) / static_cast<double>(kSamples);
        }
        for (const double area : areas) CHECK(area == doctest::Approx(1.0 / 32).epsilon(0.01));
        const double share = std::popcount(known) / 32.0;
        if (known) CHECK(in_known == doctest::Approx(0.75 + 0.25 * share).epsilon(0.01));
    }
}

TEST_CASE("cells are promising until rays sent there were lost") {
    CHECK(PixelPupil{0, 0}.promising() == 0xffffffffu);
    CHECK(PixelPupil{0xff, 0x0f}.promising() == 0xffffff0fu);
}

TEST_CASE("passes end where pixels learn, wherever a range begins") {
    const auto ends = [](std::uint32_t first, std::uint32_t count) {
        std::vector<std::uint32_t> found;
        for (const SampleRange& pass : learning_passes({1, first, count})) found.push_back(pass.first + pass.count);
        return found;
    };
    CHECK(ends(0, 20) == std::vector<std::uint32_t>{4, 8, 16, 20});
    CHECK(ends(6, 4) == std::vector<std::uint32_t>{8, 10});
    CHECK(ends(16, 16) == std::vector<std::uint32_t>{32});
    CHECK(ends(0xfffffff0u, 15) == std::vector<std::uint32_t>{0xffffffffu});
}
