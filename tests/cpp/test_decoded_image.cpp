// Pictures of 8 bits, 16 bits and floating-point numbers, as colours and as data.

#include <vector>

#include "../../cpp/io/decoded_image.hpp"
#include "doctest/doctest.h"

using namespace realcam;
using namespace realcam::io;

namespace {

// Codes 255 and 128, as 8 bits, as fractions and as numbers of which a file says that they are light.
const DecodedImage kCodes{2, 1, std::vector<std::uint8_t>{255, 128, 0, 255, 128, 128, 0, 0}};
const DecodedImage kFractions{2, 1, std::vector<float>{1, 128 / 255.f, 0, 1, 128 / 255.f, 128 / 255.f, 0, 0}};
const DecodedImage kLight{2, 1, std::vector<float>{1, 128 / 255.f, 0, 1, 128 / 255.f, 128 / 255.f, 0, 0}, true};

constexpr double kSrgb128 = 0.2158605;  // IEC 61966-2-1

void check_mean(const DecodedImage& image, TextureUse use, double red, double green) {
    Checkpoint checkpoint;
    const Vec3f mean = mean_of(image, use, checkpoint);
    CHECK(double(mean.x) == doctest::Approx(red).epsilon(1e-6));
    CHECK(double(mean.y) == doctest::Approx(green).epsilon(1e-6));
    CHECK(mean.z == 0.0f);
}

}  // namespace

TEST_CASE("colours are sRGB unless they are floating-point numbers; data are numbers") {
    for (const DecodedImage* image : {&kCodes, &kFractions}) {
        CHECK(is_srgb(*image, TextureUse::colour));
        CHECK_FALSE(is_srgb(*image, TextureUse::data));
        check_mean(*image, TextureUse::colour, (1 + kSrgb128) / 2, kSrgb128);
        check_mean(*image, TextureUse::data, (1 + 128 / 255.0) / 2, 128 / 255.0);
    }
    for (const TextureUse use : {TextureUse::colour, TextureUse::data}) {
        CHECK_FALSE(is_srgb(kLight, use));
        check_mean(kLight, use, (1 + 128 / 255.0) / 2, 128 / 255.0);
    }
}

TEST_CASE("as 8-bit codes: those of the file, fractions rounded, and light encoded; alpha is never encoded") {
    const auto codes = std::get<std::vector<std::uint8_t>>(kCodes.rgba);
    CHECK(srgb8(kCodes) == codes);
    CHECK(srgb8(kFractions) == codes);
    // A linear 0.2158605 is code 128; light above 1 is white; an alpha of one half is 127.5.
    const DecodedImage light{1, 1, std::vector<float>{0.2158605f, 7, 0, 0.5f}, true};
    CHECK(srgb8(light) == std::vector<std::uint8_t>{128, 255, 0, 128});
}

TEST_CASE("a picture whose pixels do not fit its size is not whole") {
    CHECK(is_whole(kCodes));
    CHECK(is_whole(kLight));
    CHECK_FALSE(is_whole(DecodedImage{1, 1, std::vector<float>{1, 1, 1}}));
    CHECK_FALSE(is_whole(DecodedImage{2, 1, std::vector<std::uint8_t>{1, 1, 1, 1}}));
    CHECK_FALSE(is_whole(DecodedImage{0, 0, std::vector<std::uint8_t>{}}));
    CHECK_FALSE(is_whole(DecodedImage{-1, -1, std::vector<std::uint8_t>{1, 1, 1, 1}}));
}
