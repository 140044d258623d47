#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "image_io/image_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace realcam;
using namespace realcam::image_io;

// The files of one test; gone with it.
class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / ("realcam-image-" + std::to_string(getpid()))) {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { fs::remove_all(path_); }

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

// A PNG of four pixels with alpha, written by OpenImageIO alone.
std::string write_rgba(const std::string& path) {
    const std::vector<std::uint8_t> pixels = {255, 0, 0, 255, 200, 100, 50, 128, 0, 0, 255, 0, 9, 8, 7, 255};
    OIIO::ImageSpec spec(2, 2, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create(path);
    REQUIRE(output->open(path, spec));
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    REQUIRE(output->close());
    return path;
}

const std::vector<std::uint8_t>& codes_of(const io::DecodedImage& image) {
    return std::get<std::vector<std::uint8_t>>(image.rgba);
}
const std::vector<float>& floats_of(const io::DecodedImage& image) {
    return std::get<std::vector<float>>(image.rgba);
}

// A picture of one row of 16-bit values, with alpha.
std::string write_wide(const std::string& path, const std::vector<std::uint16_t>& rgba) {
    OIIO::ImageSpec spec(static_cast<int>(rgba.size() / 4), 1, 4, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto output = OIIO::ImageOutput::create(path);
    REQUIRE(output->open(path, spec));
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT16, rgba.data()));
    REQUIRE(output->close());
    return path;
}

// A whole file, as a scene file carries it inside.
std::vector<std::uint8_t> bytes_of(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(stream), {}};
    return {text.begin(), text.end()};
}

std::string write_grey_jpeg(const std::string& path) {
    const std::vector<std::uint8_t> pixels(64, 77);
    const auto output = OIIO::ImageOutput::create(path);
    REQUIRE(output->open(path, OIIO::ImageSpec(8, 8, 1, OIIO::TypeDesc::UINT8)));
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    REQUIRE(output->close());
    return path;
}

std::string write_floats(const std::string& path, const std::vector<float>& rgb) {
    const auto output = OIIO::ImageOutput::create(path);
    REQUIRE(output->open(path, OIIO::ImageSpec(static_cast<int>(rgb.size() / 3), 1, 3, OIIO::TypeDesc::FLOAT)));
    REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, rgb.data()));
    REQUIRE(output->close());
    return path;
}

}  // namespace

TEST_CASE("Textures are read from files and from memory") {
    const Folder folder;
    const std::string path = write_rgba(folder / "a.png");
    const std::vector<std::uint8_t> expected = {255, 0, 0, 255, 200, 100, 50, 128, 0, 0, 255, 0, 9, 8, 7, 255};
    const std::optional from_file = read_image(path, {});
    REQUIRE(from_file);
    CHECK(codes_of(*from_file) == expected);
    CHECK_FALSE(from_file->is_linear);
    const std::vector<std::uint8_t> bytes = bytes_of(path);
    const std::optional from_memory = read_image("", bytes);
    REQUIRE(from_memory);
    CHECK(codes_of(*from_memory) == expected);
    const std::optional grey = read_image("", bytes_of(write_grey_jpeg(folder / "a.jpg")));
    REQUIRE(grey);
    REQUIRE(codes_of(*grey).size() == 256);
    for (std::size_t c = 0; c < 3; ++c) CHECK(codes_of(*grey)[c] == 77);
    CHECK(codes_of(*grey)[3] == 255);

    CHECK_THROWS_AS(read_image(folder / "none.png", {}), Error);
    CHECK_THROWS_AS(read_image("", {}), Error);
    CHECK_THROWS_AS(read_image("", std::span(bytes).first(40)), Error);
}

TEST_CASE("Textures of more than 8 bits keep what their files hold") {
    const Folder folder;
    const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::optional linear =
        read_image(write_floats(folder / "a.exr", {0.18f, 5.0f, -1.0f, infinite, nan, 1e-6f}), {});
    REQUIRE(linear);
    CHECK(linear->is_linear);
    CHECK(floats_of(*linear) == std::vector<float>{0.18f, 5.0f, 0, 1, 65504.0f, 0, 1e-6f, 1});

    const std::vector<std::uint16_t> wide = {0, 1, 65535, 32768, 257, 40000, 40001, 65535};
    for (const char* name : {"a.png", "a.tif"}) {
        const std::optional image = read_image(write_wide(folder / name, wide), {});
        REQUIRE(image);
        CHECK_FALSE(image->is_linear);
        REQUIRE(floats_of(*image).size() == wide.size());
        for (std::size_t i = 0; i < wide.size(); ++i)  // one rounding to 24 bits, or two
            CHECK(double(floats_of(*image)[i]) == doctest::Approx(wide[i] / 65535.0).epsilon(1.2e-7));
    }
}

TEST_CASE("Environments are linear light") {
    const Folder folder;
    const float infinite = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const Environment sky = read_environment(write_floats(folder / "sky.exr", {0.5f, 2000, 0, 1e20f, 65505, 0}));
    REQUIRE(sky.width == 2);
    REQUIRE(sky.height == 1);
    REQUIRE(sky.pixels.size() == 2);
    CHECK(sky.pixels[0].r == 0.5f);
    CHECK(sky.pixels[0].g == 2000.0f);
    CHECK(sky.pixels[1].r == 1e20f);
    CHECK(sky.pixels[1].g == 65505.0f);
    CHECK(sky.pixels[1].b == 0.0f);

    for (const float wrong : {infinite, nan, -1.0f, 1.01e20f}) {
        const std::string path = write_floats(folder / "wrong.exr", {1, 1, 1, 0, wrong, 0, wrong, 0, 0});
        INFO(wrong);
        CHECK_THROWS_WITH_AS(
            read_environment(path),
            doctest::Contains((std::string("wrong.exr: 2 pixels are ") + (wrong == -1.0f ? "negative" : "invalid") +
                               ", the first in row 0, column 1: (0, ")
                                  .c_str()),
            ImageFileError);
    }

    const Environment painted = read_environment(write_rgba(folder / "sky.png"));
    CHECK(painted.pixels[0].r == doctest::Approx(1.0));
    CHECK(painted.pixels[1].g == doctest::Approx(0.127438).epsilon(1e-4));  // sRGB 100
    CHECK_THROWS_AS(read_environment(folder / "none.hdr"), ImageFileError);
    std::ofstream(folder / "text.exr") << "no picture";
    CHECK_THROWS_AS(read_environment(folder / "text.exr"), ImageFileError);
}
