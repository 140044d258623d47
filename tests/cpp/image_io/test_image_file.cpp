#include <OpenImageIO/imageio.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "image_io/image_file.hpp"
#include "refusal.hpp"

namespace {

namespace fs = std::filesystem;
using namespace realcam;
using namespace realcam::image_io;
using realcam::test::contains;

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
    std::ptrdiff_t file_count() const { return std::distance(fs::directory_iterator(path_), fs::directory_iterator()); }

private:
    fs::path path_;
};

// Rows for more than one batch of the writer; at ISO 100, 0.1 lx s is middle grey and 10 lx s far above white.
Image test_image() {
    Image image;
    image.width = 5;
    image.height = 150;
    image.exposure = PictureFloats(std::vector<float>(3 * 5 * 150, 0.1f));
    image.depth = PictureFloats(std::vector<float>(5 * 150, 2.5f));
    image.exposure[0] = 10.0f;
    image.exposure[1] = 0.0f;
    image.exposure[2] = std::numeric_limits<float>::quiet_NaN();
    image.exposure[3 * (5 * 149 + 4)] = 0.25f;
    image.depth[5 * 150 - 1] = std::numeric_limits<float>::infinity();
    return image;
}

io::ImageMetadata test_metadata() {
    io::ImageMetadata metadata;
    metadata.lens = "double-gauss-50mm";
    metadata.model = "full";
    metadata.focal_length_mm = 50.5;
    metadata.f_number = 2.8;
    metadata.focus_distance_m = 1.5;
    metadata.film_width_mm = 36;
    metadata.film_height_mm = 24;
    metadata.exposure_time_s = 0.008;
    metadata.iso = 100;
    metadata.seed = 4000000000u;
    metadata.spp = 64;
    return metadata;
}

std::string message_of(const std::string& path) {
    try {
        write_image(view_of(test_image()), path, test_metadata());
    } catch (const ImageFileError& error) {
        return error.what();
    }
    return "written";
}

void check_entries(const OIIO::ImageSpec& spec) {
    for (const auto& [name, value] : test_metadata().entries()) {
        INFO(name);
        CHECK(spec.get_string_attribute(name) == value);
    }
}

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

TEST_CASE("EXR keeps exposure, depth and metadata") {
    const Folder folder;
    const std::string path = folder / "picture.exr";
    const Image image = test_image();
    write_image(view_of(image), path, test_metadata());
    CHECK(folder.file_count() == 1);

    const auto input = OIIO::ImageInput::open(path);
    REQUIRE(input);
    const OIIO::ImageSpec spec = input->spec();
    REQUIRE(spec.channelnames == std::vector<std::string>{"R", "G", "B", "Z"});
    CHECK(spec.format == OIIO::TypeDesc::FLOAT);
    std::vector<float> pixels(4 * image.depth.size());
    REQUIRE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, pixels.data()));
    for (std::size_t i = 1; i < image.depth.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) REQUIRE(pixels[4 * i + c] == image.exposure[3 * i + c]);
        REQUIRE(pixels[4 * i + 3] == image.depth[i]);
    }
    CHECK(pixels[0] == 10.0f);

    check_entries(spec);
    // OpenImageIO gives some of OpenEXR's standard attributes names of its own.
    CHECK(spec.get_float_attribute("ExposureTime", spec.get_float_attribute("expTime")) == 0.008f);
    CHECK(spec.get_float_attribute("FNumber", spec.get_float_attribute("aperture")) == 2.8f);
    CHECK(spec.get_float_attribute("isoSpeed", spec.get_float_attribute("Exif:ISOSpeedRatings")) == 100.0f);
    CHECK(spec.get_float_attribute("focus") == 1.5f);
    CHECK(spec.get_float_attribute("effectiveFocalLength") == 50.5f);
    CHECK(spec.get_string_attribute("lensModel") == "double-gauss-50mm");
    const auto* film = spec.find_attribute("sensorOverallDimensions");
    REQUIRE(film);
    REQUIRE(film->type() == OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::VEC2));
    CHECK(static_cast<const float*>(film->data())[0] == 36.0f);
    CHECK(static_cast<const float*>(film->data())[1] == 24.0f);
}

TEST_CASE("PNG is developed and says how it was taken") {
    const Folder folder;
    const std::string path = folder / "picture.PNG";
    const Image image = test_image();
    for (const ToneCurve tone : {ToneCurve::film, ToneCurve::linear}) {
        write_image(view_of(image), path, test_metadata(), ToneView(tone));
        CHECK(folder.file_count() == 1);
        const std::optional decoded = read_image(path, {});
        REQUIRE(decoded);
        REQUIRE(decoded->width == 5);
        REQUIRE(decoded->height == 150);
        const std::vector<std::uint8_t>& rgba = codes_of(*decoded);
        CHECK(rgba[0] == 255);
        CHECK(rgba[1] == 0);
        CHECK(rgba[2] == 0);  // NaN is no light
        CHECK(rgba[3] == 255);
        for (std::size_t c = 0; c < 3; ++c) CHECK(rgba[4 * 700 + c] == 118);  // middle grey
        const auto input = OIIO::ImageInput::open(path);
        check_entries(input->spec());
        CHECK(input->spec().get_string_attribute("realcam:tone") == (tone == ToneCurve::film ? "film" : "linear"));
    }
}

TEST_CASE("What cannot be written says why and leaves nothing") {
    const Folder folder;
    CHECK(contains(message_of(folder / "a.bmp"),
                   "\".bmp\" is not written; expected .png, .jpg, .tif, .webp (developed) or .exr"));
    CHECK(contains(message_of(folder / "a"), "there is no suffix"));
    CHECK(contains(message_of(folder / "gone/a.png"), "does not exist"));
    CHECK(folder.file_count() == 0);
    fs::create_directory(folder / "folder.png");
    CHECK(contains(message_of(folder / "folder.png"), "is a folder"));
    std::ofstream(folder / "file") << "text";
    CHECK(contains(message_of(folder / "file/a.png"), "is not a folder"));
    CHECK(folder.file_count() == 2);
    if (geteuid() != 0) {  // root may write everywhere
        fs::permissions(folder / "folder.png", fs::perms::owner_read | fs::perms::owner_exec);
        CHECK(contains(message_of(folder / "folder.png/a.png"), "cannot be written to"));
    }
    CHECK_THROWS_AS(write_image(view_of(Image{}), folder / "a.png", test_metadata()), ImageFileError);
}

TEST_CASE("A disk that fills up keeps the old picture and no half of the new one") {
    const Folder folder;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const std::string name : {"a.png", "a.exr"}) {
        std::ofstream(folder / name) << "old";
        rlimit small = before;
        small.rlim_cur = 100;
        setrlimit(RLIMIT_FSIZE, &small);
        const std::string message = message_of(folder / name);
        setrlimit(RLIMIT_FSIZE, &before);
        INFO(message);
        CHECK(contains(message, name + ": cannot be written: the disk is full"));
        CHECK(fs::file_size(folder / name) == 3);
    }
    CHECK(folder.file_count() == 2);
    std::signal(SIGXFSZ, SIG_DFL);
}

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
            doctest::Contains((std::string("wrong.exr: 2 pixels are ") + (wrong == -1.0f ? "negative" : "no light") +
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
