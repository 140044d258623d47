#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include "../error.hpp"
#include "image_file.hpp"
#include "unfinished_file.hpp"

namespace realcam::image_io {
namespace {

using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// Rows that are converted and handed over at a time: a large picture is not held twice.
constexpr int kRows = 64;

std::string format_of(const std::string& path) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (suffix == ".png" || suffix == ".exr") return suffix.substr(1);
    throw ImageFileError(path + ": " + (suffix.empty() ? "there is no suffix" : "\"" + suffix + "\" is not written") +
                         "; .png (developed) or .exr (exposure and depth) is wanted");
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

std::size_t pixel_count(const Image& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

ImageSpec specification(const Image& image, int channels, TypeDesc type, const ImageMetadata& metadata) {
    ImageSpec spec(image.width, image.height, channels, type);
    spec.attribute("Software", "realcam " REALCAM_VERSION);
    for (const auto& [name, value] : metadata.entries()) spec.attribute(name, value);
    return spec;
}

/// Writes through `fill(first_row, rows, buffer)`, some rows at a time.
template <class Value, class Fill>
void write_rows(const std::string& path, const std::string& format, const ImageSpec& spec, Fill&& fill) {
    UnfinishedFile file(path);
    const auto check = [&](bool good, const ImageOutput& output) {
        const std::string why = output.geterror();
        if (!good || !why.empty()) throw ImageFileError(path + ": cannot be written: " + first_line(why));
    };
    {
        const auto output = ImageOutput::create(format);
        if (!output)
            throw ImageFileError(path + ": OpenImageIO cannot write ." + format + ": " + first_line(OIIO::geterror()));
        output->set_ioproxy(&file.proxy());
        check(output->open("picture." + format, spec), *output);
        std::vector<Value> rows(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.nchannels) *
                                kRows);
        for (int y = 0; y < spec.height; y += kRows) {
            const int end = std::min(y + kRows, spec.height);
            fill(y, end, rows.data());
            check(output->write_scanlines(y, end, 0, OIIO::BaseTypeFromC<Value>::value, rows.data()), *output);
        }
        check(output->close(), *output);
    }
    file.finish();
}

void write_png(const Image& image, const std::string& path, const ImageMetadata& metadata, ToneCurve tone) {
    ImageSpec spec = specification(image, 3, TypeDesc::UINT8, metadata);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("realcam:tone", tone == ToneCurve::film ? "film" : "linear");
    write_rows<std::uint8_t>(path, "png", spec, [&](int first, int end, std::uint8_t* out) {
        const std::size_t row = 3 * static_cast<std::size_t>(image.width);
        for (std::size_t i = static_cast<std::size_t>(first) * row; i < static_cast<std::size_t>(end) * row; ++i) {
            const double value = sensor_value(static_cast<double>(image.exposure[i]), metadata.iso);
            *out++ = srgb_code(apply_tone_curve(tone, value));
        }
    });
}

void write_exr(const Image& image, const std::string& path, const ImageMetadata& metadata) {
    ImageSpec spec = specification(image, 4, TypeDesc::FLOAT, metadata);
    spec.channelnames = {"R", "G", "B", "Z"};
    spec.z_channel = 3;
    spec.attribute("compression", "zip");
    spec.attribute("realcam:unit",
                   "R, G, B: lux seconds on the film, linear Rec. 709; Z: metres from the film along the axis");
    // The standard attributes of OpenEXR, in its units.
    const auto set = [&](const char* name, double value) { spec.attribute(name, static_cast<float>(value)); };
    set("expTime", metadata.exposure_time_s);
    set("aperture", metadata.f_number);
    set("isoSpeed", metadata.iso);
    set("focus", metadata.focus_distance_m);
    set("effectiveFocalLength", metadata.focal_length_mm);
    spec.attribute("lensModel", metadata.lens);
    const float film[2] = {static_cast<float>(metadata.film_width_mm), static_cast<float>(metadata.film_height_mm)};
    spec.attribute("sensorOverallDimensions", TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), film);
    write_rows<float>(path, "exr", spec, [&](int first, int end, float* out) {
        const auto width = static_cast<std::size_t>(image.width);
        for (std::size_t i = static_cast<std::size_t>(first) * width; i < static_cast<std::size_t>(end) * width; ++i) {
            for (std::size_t c = 0; c < 3; ++c) *out++ = image.exposure[3 * i + c];
            *out++ = image.depth[i];
        }
    });
}

}  // namespace

void write_image(const Image& image, const std::string& path, const ImageMetadata& metadata, ToneCurve tone) {
    check_image_path(path);
    if (image.width < 1 || image.height < 1 || image.exposure.size() != 3 * pixel_count(image) ||
        image.depth.size() != pixel_count(image))
        throw ImageFileError(path + ": the picture is empty, or its arrays do not have its size");
    if (format_of(path) == "png") {
        write_png(image, path, metadata, tone);
    } else {
        write_exr(image, path, metadata);
    }
}

void check_image_path(const std::string& path) {
    namespace fs = std::filesystem;
    format_of(path);
    fs::path folder = fs::path(path).parent_path();
    if (folder.empty()) folder = ".";
    std::error_code ignored;
    if (!fs::exists(folder, ignored))
        throw ImageFileError(path + ": the folder \"" + folder.string() + "\" does not exist");
    if (!fs::is_directory(folder, ignored))
        throw ImageFileError(path + ": \"" + folder.string() + "\" is not a folder");
    if (fs::is_directory(path, ignored)) throw ImageFileError(path + ": is a folder; the name of a file is wanted");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        throw ImageFileError(path + ": the folder \"" + folder.string() +
                             "\" cannot be written to: " + std::generic_category().message(errno));
}

}  // namespace realcam::image_io
