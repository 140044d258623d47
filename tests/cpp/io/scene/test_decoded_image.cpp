// Pictures of 8 bits, 16 bits and floating-point numbers, as colours and as data.

#include <vector>

#include "doctest/doctest.h"
#include "io/scene/decoded_image.hpp"

using namespace realcam;
using namespace realcam::io;

namespace {

// The values 255 and 128: as 8-bit codes, as fractions, and as numbers that the file declares to be linear light.
const DecodedImage kCodes{2, 1, std::vector<std::uint8_t>{255, 128, 0, 255, 128, 128, 0, 0}};
const DecodedImage kFractions{2, 1, std::vector<float>{1, 128 / 255.f, 0, 1, 128 / 255.f, 128 / 255.f, 0, 0}};
const DecodedImage kLight{2, 1, std::vector<float>{1, 128 / 255.f, 0, 1, 128 / 255.f, 128 / 255.f, 0, 0}, true};

constexpr float kSrgb128 = 0.2158605f;  // IEC 61966-2-1

}  // namespace

TEST_CASE("8-bit codes stay what they are, as colours and as data") {
    for (const TextureUse use : {TextureUse::colour, TextureUse::data}) {
        const Texture texture = texture_of(kCodes, use, "name");
        CHECK(texture.rgba == std::get<std::vector<std::uint8_t>>(kCodes.rgba));
        CHECK(texture.linear_rgba.empty());
        CHECK(texture.encoding == (use == TextureUse::colour ? TextureEncoding::srgb : TextureEncoding::linear));
        CHECK((texture.width == 2 && texture.height == 1 && texture.name == "name"));
    }
}

TEST_CASE("fractions become linear light as colours, and stay numbers as data; alpha is never encoded") {
    CHECK(is_srgb(kFractions, TextureUse::colour));
    CHECK_FALSE(is_srgb(kFractions, TextureUse::data));
    const std::vector<float> colours = texture_of(kFractions, TextureUse::colour, "").linear_rgba;
    CHECK(colours[1] == doctest::Approx(kSrgb128).epsilon(1e-6));
    CHECK(colours[4] == doctest::Approx(kSrgb128).epsilon(1e-6));
    CHECK(colours[0] == 1.0f);
    CHECK((colours[3] == 1.0f && colours[7] == 0.0f));
    CHECK(texture_of(kFractions, TextureUse::data, "").linear_rgba == std::get<std::vector<float>>(kFractions.rgba));
}

TEST_CASE("floating-point numbers are light itself") {
    for (const TextureUse use : {TextureUse::colour, TextureUse::data}) {
        CHECK_FALSE(is_srgb(kLight, use));
        CHECK(texture_of(kLight, use, "").linear_rgba == std::get<std::vector<float>>(kLight.rgba));
    }
}

TEST_CASE("a picture whose pixels do not fit its size is not whole") {
    CHECK(is_whole(kCodes));
    CHECK(is_whole(kLight));
    CHECK_FALSE(is_whole(DecodedImage{1, 1, std::vector<float>{1, 1, 1}}));
    CHECK_FALSE(is_whole(DecodedImage{2, 1, std::vector<std::uint8_t>{1, 1, 1, 1}}));
    CHECK_FALSE(is_whole(DecodedImage{0, 0, std::vector<std::uint8_t>{}}));
    CHECK_FALSE(is_whole(DecodedImage{-1, -1, std::vector<std::uint8_t>{1, 1, 1, 1}}));
}
