// The coarser levels of a texture. The truth: means in double, of light.

#include <cmath>
#include <vector>

#include "chi_square.hpp"
#include "doctest/doctest.h"
#include "scene/geometry/surface_point.hpp"
#include "scene/textures/texture_levels.hpp"

using namespace realcam;

namespace {

double mean_light(const TextureView& view) {
    double sum = 0;
    for (int row = 0; row < view.height; ++row)
        for (int column = 0; column < view.width; ++column) sum += static_cast<double>(texel(view, column, row).g);
    return sum / view.width / view.height;
}

}  // namespace

TEST_CASE("levels of sizes that are odd have the texture's mean, in light") {
    test::Uniform uniform(3);
    for (const auto& [width, height] : {std::pair{64, 32}, {37, 5}, {1, 9}, {3, 3}, {1, 1}}) {
        CAPTURE(width);
        std::vector<std::uint8_t> codes;
        std::vector<float> floats;
        for (int i = 0; i < 4 * width * height; ++i) {
            codes.push_back(static_cast<std::uint8_t>(255 * uniform()));
            floats.push_back(1000 * uniform());
        }
        Checkpoint checkpoint;
        TextureView views[2] = {{codes.data(), nullptr, width, height, TextureEncoding::srgb},
                                {nullptr, floats.data(), width, height, TextureEncoding::linear}};
        for (TextureView& view : views) {
            const double mean = mean_light(view);
            const TextureLevels levels = coarser_levels(view, checkpoint);
            CHECK(levels.rgba.size() + levels.linear_rgba.size() == 4 * static_cast<std::size_t>(coarse_texels(view)));
            for (int level = 0; level <= view.coarse_levels; ++level) {
                const TextureView one = level_of(view, level);
                CHECK(one.width == std::max(1, width >> level));
                CHECK(one.height == std::max(1, height >> level));
                // Each level rounds to codes, by a fourth of the light's step on the average: 0.009 / 4 at white.
                CHECK(std::fabs(mean_light(one) / mean - 1) < (view.rgba ? 0.01 : 1e-5));
            }
            CHECK(level_of(view, 50).width == 1);
            CHECK(level_of(view, 50).height == 1);
        }
    }
}

TEST_CASE("black and white make the grey of half their light, which is code 188") {
    const std::vector<std::uint8_t> codes = {0, 0, 0, 0, 255, 255, 255, 255};
    TextureView view{codes.data(), nullptr, 2, 1, TextureEncoding::srgb};
    Checkpoint checkpoint;
    const TextureLevels levels = coarser_levels(view, checkpoint);
    CHECK(levels.rgba == std::vector<std::uint8_t>{188, 188, 188, 128});  // alpha is linear
    for (int code = 0; code < 256; ++code) {
        const std::vector<std::uint8_t> same(16, static_cast<std::uint8_t>(code));
        TextureView constant{same.data(), nullptr, 2, 2, TextureEncoding::srgb};
        CHECK(coarser_levels(constant, checkpoint).rgba[0] == code);
    }
}

TEST_CASE("the level whose texels have the footprint's area") {
    const std::vector<float> numbers(4 * 64 * 64);
    TextureView view{nullptr, numbers.data(), 64, 64, TextureEncoding::linear};
    Checkpoint checkpoint;
    const TextureLevels levels = coarser_levels(view, checkpoint);
    const auto width_of = [&](float texels_across, float chance, TextureReference reference = {}) {
        return level_for(view, reference, {texels_across * texels_across / (64 * 64), chance}).width;
    };
    CHECK(width_of(0.5f, 0.9f) == 64);
    CHECK(width_of(4.001f, 0) == 16);
    CHECK(width_of(4, 0.99f) == 16);
    // Half a level further: one or the other by equal chance.
    CHECK(width_of(5.657f, 0.49f) == 16);
    CHECK(width_of(5.657f, 0.51f) == 8);
    CHECK(width_of(1e6f, 0) == 1);
    // Repeated four times as often in one direction, twice as many texels lie in a width.
    CHECK(width_of(4.001f, 0, {0, {4, 0, 0}, {0, 1, 0}}) == 8);
    CHECK(level_for(view, {}, {}).width == 64);
}
