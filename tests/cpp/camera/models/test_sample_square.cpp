// The random numbers themselves: even over pixels in every dimension, and pairs of them independent.

#include <cmath>
#include <vector>

#include "camera/models/generate_rays.hpp"
#include "chi_square.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kPixels = 1 << 18;

// numbers(pixel) for many pixels, in 24 x 24 boxes of the unit square.
template <class F>
Bins over_pixels(F&& numbers) {
    Bins bins(Bins::even(0, 1, 24), Bins::even(0, 1, 24));
    bins.expect([](double x, double y) { return square_pdf({static_cast<float>(x), static_cast<float>(y)}); }, kPixels,
                1);
    for (int p = 0; p < kPixels; ++p) {
        const Vec2f u = numbers(p);
        bins.add(static_cast<double>(u.x), static_cast<double>(u.y));
    }
    return bins;
}

}  // namespace

TEST_CASE("numbers are uniform on the square, over pixels, for every sample and dimension") {
    ChiSquareTests tests("sample_2d: the square");
    for (const std::uint32_t seed : {0u, 77u})
        for (const std::uint32_t sample : {0u, 1u, 6u, 1000000u})
            for (const std::uint32_t dimension : {0u, 1u, 2u, 3u, 129u})
                tests.add(over_pixels([&](int p) { return sample_2d(pixel_stream(p, seed), sample, dimension); }));
    tests.hold();

    ChiSquareTests joint("sample_joint_2d: the square");
    for (const std::uint32_t seed : {0u, 77u})
        for (const std::uint32_t sample : {0u, 1u, 6u, 1000000u})
            for (std::uint32_t pair = 0; pair < kJointPairs; ++pair)
                joint.add(over_pixels([&](int p) { return sample_joint_2d(pixel_stream(p, seed), sample, pair); }));
    joint.hold();

    ChiSquareTests broken("sample_2d with one seed for both coordinates");
    broken.add(over_pixels([](int p) {
        const float x = sample_2d(pixel_stream(p, 0), 3, 0).x;
        return Vec2f{x, x};
    }));
    broken.breaks();
}

TEST_CASE("numbers of different dimensions are independent, over pixels") {
    ChiSquareTests tests("two dimensions: the square");
    constexpr std::uint32_t kPairs = kJointPairs + 2;
    constexpr std::size_t kBoxes = 24;
    const std::vector<double> expected(kBoxes * kBoxes, static_cast<double>(kPixels) / (kBoxes * kBoxes));
    for (const std::uint32_t sample : {0u, 1u, 1000000u}) {
        std::vector<std::vector<std::uint8_t>> boxes(2 * kPairs);
        for (int p = 0; p < kPixels; ++p)
            for (std::uint32_t pair = 0; pair < kPairs; ++pair) {
                const std::uint32_t stream = pixel_stream(p, 1);
                const Vec2f u =
                    pair < kJointPairs ? sample_joint_2d(stream, sample, pair) : sample_2d(stream, sample, pair);
                REQUIRE(square_pdf(u) == 1);
                boxes[2 * pair].push_back(static_cast<std::uint8_t>(u.x * kBoxes));
                boxes[2 * pair + 1].push_back(static_cast<std::uint8_t>(u.y * kBoxes));
            }
        for (std::size_t a = 0; a < boxes.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) {
                std::vector<double> counts(kBoxes * kBoxes);
                for (std::size_t p = 0; p < kPixels; ++p) ++counts[boxes[a][p] * kBoxes + boxes[b][p]];
                tests.add(expected, counts);
            }
    }
    tests.hold();
}

TEST_CASE("each coordinate is uniform down to 2^-12") {
    ChiSquareTests tests("sample_2d: each coordinate in 4096 steps");
    for (const std::uint32_t sample : {0u, 5u})
        for (const std::uint32_t dimension : {0u, 1u, 7u})
            for (const bool second : {false, true}) {
                const std::vector<double> expected(4096, kPixels / 4096.0);
                std::vector<double> counts(4096);
                for (int p = 0; p < kPixels; ++p) {
                    const Vec2f u = sample_2d(pixel_stream(p, 3), sample, dimension);
                    ++counts[static_cast<std::size_t>((second ? u.y : u.x) * 4096)];
                }
                tests.add(expected, counts);
            }
    tests.hold();
}

TEST_CASE("coordinates of different dimensions, pixels and seeds are independent in pairs") {
    ChiSquareTests tests("sample_2d: pairs across dimensions, pixels and seeds");
    for (const std::uint32_t sample : {0u, 1u, 12345u}) {
        const auto at = [&](int p, std::uint32_t seed, std::uint32_t dimension) {
            return sample_2d(pixel_stream(p, seed), sample, dimension);
        };
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 0).x, at(p, 0, 1).x}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 0).y, at(p, 0, 1).y}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 1).x, at(p, 0, 2).y}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 2).x, at(p, 0, 3).x}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 0).x, at(p + 1, 0, 0).x}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 1).y, at(p + 960, 0, 1).y}; }));
        tests.add(over_pixels([&](int p) { return Vec2f{at(p, 0, 1).x, at(p, 1, 1).x}; }));
    }
    tests.hold();
}

TEST_CASE("all numbers lie in [0, 1), and square_pdf is 0 outside") {
    for (std::uint32_t i = 0; i < 1000000; ++i) {
        const Vec2f u = sample_2d(hash32(i), i, i % 8);
        REQUIRE(square_pdf(u) == 1);
    }
    CHECK(unit_float(0xffffffffu) == 0x1.fffffep-1f);
    CHECK(unit_float(0) == 0);
    CHECK(square_pdf({1, 0.5f}) == 0);
    CHECK(square_pdf({0.5f, -0x1p-24f}) == 0);
}
