// The random numbers: what they are built from, and what pictures rely on. test_sample_square.cpp tests that they are
// even.

#include <cmath>
#include <set>
#include <vector>

#include "about.hpp"
#include "camera/models/generate_rays.hpp"
#include "doctest/doctest.h"

namespace {

using namespace realcam;
using namespace realcam::test;

// Inverse of an odd factor modulo 2^32, by Newton's iteration.
std::uint32_t inverse_of(std::uint32_t odd) {
    std::uint32_t x = odd;
    for (int i = 0; i < 5; ++i) x *= 2 - odd * x;
    return x;
}

std::uint32_t undo_xorshift(std::uint32_t v, int shift) {
    std::uint32_t x = v;
    for (int i = 0; i < 32; i += shift) x = v ^ (x >> shift);
    return x;
}

}  // namespace

TEST_CASE("hash32 is a bijection: it can be undone") {
    const std::uint32_t first = inverse_of(0x7feb352du), second = inverse_of(0x846ca68bu);
    std::uint32_t v = 1;
    for (int i = 0; i < 1000000; ++i) {
        v = i < 70000 ? static_cast<std::uint32_t>(i) : v * 1664525u + 1013904223u;
        std::uint32_t h = undo_xorshift(hash32(v), 16);
        h = undo_xorshift(h * second, 15);
        h = undo_xorshift(h * first, 16);
        REQUIRE(h == v);
    }
}

TEST_CASE("hash32 flips each bit with probability a half when one bit of its input changes") {
    constexpr int kInputs = 20000;
    for (int in = 0; in < 32; ++in) {
        int flips[32] = {};
        for (int i = 0; i < kInputs; ++i) {
            const std::uint32_t v = static_cast<std::uint32_t>(i), d = hash32(v) ^ hash32(v ^ (1u << in));
            for (int out = 0; out < 32; ++out) flips[out] += (d >> out) & 1;
        }
        // 1024 pairs of bits at 5 standard deviations of 0.0035, and the bias that the constants are known to
        // have.
        for (const int n : flips) CHECK(std::fabs(static_cast<double>(n) / kInputs - 0.5) < 0.025);
    }
}

TEST_CASE("the two dimensions are Sobol's: reversed bits, and Pascal's triangle modulo 2") {
    std::uint32_t v = 12345;
    for (int i = 0; i < 20000; ++i) {
        v = i < 5000 ? static_cast<std::uint32_t>(i) : v * 1664525u + 1013904223u;
        std::uint32_t reversed = 0;
        for (int b = 0; b < 32; ++b) reversed |= ((v >> b) & 1u) << (31 - b);
        REQUIRE(reverse_bits(v) == reversed);
        // Bit r of the fraction (from the top) is the sum over the index's bits c of C(c, r) mod 2; C(c, r)
        // is odd where the bits of r are among those of c (Lucas).
        std::uint32_t second = 0;
        for (int r = 0; r < 32; ++r) {
            std::uint32_t bit = 0;
            for (int c = r; c < 32; ++c)
                if ((c & r) == r) bit ^= (v >> c) & 1u;
            second |= bit << (31 - r);
        }
        REQUIRE(reverse_bits(sobol_second(v)) == second);
    }
}

TEST_CASE("the samples of a pixel are a (0,2)-sequence") {
    for (std::uint32_t stream : {0u, 1u, 77u, 0xdeadbeefu})
        for (std::uint32_t dimension : {0u, 1u, 5u})
            for (int m = 0; m <= 10; ++m)
                for (std::uint32_t block : {0u, 1u, 6u}) {
                    // Each of the 2^m boxes of every shape 2^-a x 2^-(m-a) holds one of the next 2^m samples.
                    const std::uint32_t count = 1u << m;
                    for (int a = 0; a <= m; ++a) {
                        std::set<std::uint32_t> boxes;
                        for (std::uint32_t s = block * count; s < (block + 1) * count; ++s) {
                            const Vec2f u = sample_2d(stream, s, dimension);
                            REQUIRE(u.x >= 0);
                            REQUIRE(u.x < 1);
                            REQUIRE(u.y >= 0);
                            REQUIRE(u.y < 1);
                            const auto column = static_cast<std::uint32_t>(std::ldexp(u.x, a));
                            const auto row = static_cast<std::uint32_t>(std::ldexp(u.y, m - a));
                            boxes.insert(column << (m - a) | row);
                        }
                        REQUIRE(boxes.size() == count);
                    }
                }
}

/// `draw(stream, sample, pair of dimensions)`.
template <class Draw>
void check_means_and_correlations(Draw&& draw) {
    // Independent numbers: means within 5 standard deviations of sqrt(1/12 / n), correlations within 5 /
    // sqrt(n).
    constexpr int kPixels = 200000;
    for (std::uint32_t sample : {0u, 1u, 5u})
        for (std::uint32_t seed : {0u, 1u}) {
            double mean[4] = {}, product[6] = {};
            for (int p = 0; p < kPixels; ++p) {
                const std::uint32_t here = pixel_stream(p, seed), next = pixel_stream(p + 1, seed);
                const Vec2f a = draw(here, sample, 0), b = draw(here, sample, 1), c = draw(next, sample, 0);
                const Vec2f e = draw(pixel_stream(p, seed + 1), sample, 0), g = draw(here, sample + 1, 2);
                const auto centred = [](float v) { return static_cast<double>(v) - 0.5; };
                mean[0] += centred(a.x);
                mean[1] += centred(a.y);
                mean[2] += centred(b.x);
                mean[3] += centred(b.y);
                product[0] += centred(a.x) * centred(a.y);
                product[1] += centred(a.x) * centred(b.x);
                product[2] += centred(a.x) * centred(c.x);
                product[3] += centred(a.y) * centred(c.y);
                product[4] += centred(a.x) * centred(e.x);
                product[5] += centred(a.y) * centred(g.y);
            }
            for (const double m : mean) CHECK(std::fabs(m / kPixels) < 5 * std::sqrt(1.0 / 12 / kPixels));
            for (const double c : product) CHECK(std::fabs(12 * c / kPixels) < 5 / std::sqrt(kPixels));
        }
}

TEST_CASE("samples of different pixels, dimensions and seeds have even means and no correlation") {
    check_means_and_correlations([](auto... of) { return sample_2d(of...); });
    check_means_and_correlations([](auto... of) { return sample_joint_2d(of...); });
}

TEST_CASE("joint samples are the same for whoever knows how many bits their numbers have") {
    const auto same = [](Vec2f a, Vec2f b) { return a.x == b.x && a.y == b.y; };
    for (std::uint32_t pair = 0; pair < kJointPairs; ++pair)
        for (const std::uint32_t sample : {0u, 5u, 255u, 256u, 0xfffeu, 0x10000u, 0xfedcba98u}) {
            const Vec2f u = sample_joint_2d(9, sample, pair);
            if (sample < 0x100) REQUIRE(same(u, sample_joint_2d<8>(9, sample, pair)));
            if (sample < 0x10000) REQUIRE(same(u, sample_joint_2d<16>(9, sample, pair)));
            REQUIRE(same(u, sample_joint_2d<32>(9, sample, pair)));
        }
}

TEST_CASE("cos_sin_of_turn is right to 2e-7 all the way round") {
    double largest = 0;
    for (std::uint32_t i = 0; i < (1u << 24); i += 5) {
        const float turn = static_cast<float>(i) * 0x1p-24f;
        const Vec2f v = cos_sin_of_turn(turn);
        const double angle = 2 * M_PI * static_cast<double>(turn);
        largest = std::max(largest, std::fabs(static_cast<double>(v.x) - std::cos(angle)));
        largest = std::max(largest, std::fabs(static_cast<double>(v.y) - std::sin(angle)));
    }
    CHECK(largest < 2e-7);  // as documented
    const Vec2f last = cos_sin_of_turn(0x1.fffffep-1f);
    CHECK(last.x == about(1, 1e-6));
}

TEST_CASE("the joint dimensions are Sobol's with Joe and Kuo's numbers") {
    // Without scrambling, samples 1, 2, 4 and 8 of dimensions 3 to 10 are direction numbers of the file
    // new-joe-kuo-6.21201, over 2, 4, 8 and 16; 3 / 8, 9 / 16, 5 / 16 and 11 / 16 in the first three by its recurrence.
    const double expected[4][8] = {{0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5},
                                   {0.75, 0.75, 0.25, 0.25, 0.75, 0.25, 0.25, 0.25},
                                   {0.375, 0.125, 0.125, 0.375, 0.625, 0.625, 0.625, 0.875},
                                   {0.5625, 0.3125, 0.6875, 0.1875, 0.8125, 0.3125, 0.3125, 0.6875}};
    const auto point = [](int dimension, std::uint32_t index) {
        std::uint32_t v = 0;
        for (int i = 0; i < 32; ++i)
            if (index >> i & 1u) v ^= random_detail::kSobol[dimension / 2][dimension % 2].columns[i];
        return reverse_bits(v) * 0x1p-32;
    };
    for (int d = 0; d < 8; ++d)
        for (int i = 0; i < 4; ++i) CHECK(point(d, 1u << i) == expected[i][d]);
}

TEST_CASE("each joint dimension is even: so many intervals as samples hold one each") {
    for (const std::uint32_t samples : {4u, 64u, 1024u})
        for (const std::uint32_t first : {0u, samples, 65536u, 0x12340000u})
            for (std::uint32_t pair = 0; pair < kJointPairs; ++pair) {
                std::set<int> x, y;
                for (std::uint32_t i = 0; i < samples; ++i) {
                    const Vec2f u = sample_joint_2d(77, first + i, pair);
                    x.insert(static_cast<int>(u.x * static_cast<float>(samples)));
                    y.insert(static_cast<int>(u.y * static_cast<float>(samples)));
                }
                CHECK(x.size() == samples);
                CHECK(y.size() == samples);
            }
}

TEST_CASE("film points are a (0,2)-sequence: every box of an area of one sample holds one") {
    for (const std::uint32_t first : {0u, 256u, 3u << 20})
        for (int bits = 0; bits <= 8; ++bits) {
            std::set<int> boxes;
            for (std::uint32_t i = 0; i < 256; ++i) {
                const Vec2f u = sample_joint_2d(5, first + i, 0);
                boxes.insert((static_cast<int>(u.x * static_cast<float>(1 << bits)) << 8) |
                             static_cast<int>(u.y * static_cast<float>(1 << (8 - bits))));
            }
            CHECK(boxes.size() == 256);
        }
}

// An integral in four dimensions, of film and pupil together: the error of 1024 joint samples is well below that of
// pairs by themselves, whose part in which film and pupil hang together is as random as can be.
TEST_CASE("film and pupil are sampled together") {
    const auto error = [](auto&& pair) {
        double squares = 0;
        for (std::uint32_t stream = 0; stream < 64; ++stream) {
            double sum = 0;
            for (std::uint32_t i = 0; i < 1024; ++i) {
                const Vec2f film = pair(stream, i, 0u), pupil = pair(stream, i, 1u);
                sum += std::cos(6.0 * static_cast<double>(film.x + pupil.x)) / 1024;
            }
            const double mean = (std::cos(6.0) - 1) * 2 - (std::cos(12.0) - 1);  // of cos 6 (x + y), times 36
            squares += (sum - mean / 36) * (sum - mean / 36);
        }
        return std::sqrt(squares / 64);
    };
    const double joint = error([](auto... of) { return sample_joint_2d(of...); });
    const double apart = error([](auto... of) { return sample_2d(of...); });
    CHECK(joint < 0.3 * apart);
}
