#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
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

/// What an UnfinishedFile could only name as the system does.
void check_name(const std::string& path) {
    namespace fs = std::filesystem;
    format_of(path);
    const fs::path folder = fs::path(path).parent_path();
    std::error_code ignored;
    if (folder.empty() || fs::is_directory(folder, ignored)) return;
    throw ImageFileError(path + (fs::exists(folder, ignored)
                                     ? ": \"" + folder.string() + "\" is not a folder"
                                     : ": the folder \"" + folder.string() + "\" does not exist"));
}

std::size_t row_values(const PictureView& picture, std::size_t channels) {
    return channels * static_cast<std::size_t>(picture.width);
}

ImageSpec specification(const PictureView& picture, int channels, TypeDesc type, const io::ImageMetadata& metadata) {
    ImageSpec spec(picture.width, picture.height, channels, type);
    spec.attribute("Software", "realcam " REALCAM_VERSION);
    for (const auto& [name, value] : metadata.entries()) spec.attribute(name, value);
    return spec;
}

/// Writes through `fill(first_row, end_row, buffer)`, some rows at a time.
template <class Value, class Fill>
void write_rows(const std::string& path, const std::string& format, const ImageSpec& spec, const KeepGoing& keep_going,
                Fill&& fill) {
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
            if (keep_going && !keep_going()) throw Cancelled();
            const int end = std::min(y + kRows, spec.height);
            fill(static_cast<std::size_t>(y), static_cast<std::size_t>(end), rows.data());
            check(output->write_scanlines(y, end, 0, OIIO::BaseTypeFromC<Value>::value, rows.data()), *output);
        }
        check(output->close(), *output);
    }
    file.finish();
}

void write_png(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata, ToneCurve tone,
               const KeepGoing& keep_going) {
    ImageSpec spec = specification(picture, 3, TypeDesc::UINT8, metadata);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("realcam:tone", tone == ToneCurve::film ? "film" : "linear");
    const std::size_t row = row_values(picture, 3);
    write_rows<std::uint8_t>(path, "png", spec, keep_going, [&](std::size_t first, std::size_t end, std::uint8_t* out) {
        for (std::size_t i = first * row; i < end * row; ++i) {
            const double value = sensor_value(static_cast<double>(picture.exposure[i]), metadata.iso);
            *out++ = srgb_code(apply_tone_curve(tone, value));
        }
    });
}

void write_exr(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
               const KeepGoing& keep_going) {
    ImageSpec spec = specification(picture, 4, TypeDesc::FLOAT, metadata);
    spec.channelnames = {"R", "G", "B", "Z"};
    spec.z_channel = 3;
    spec.attribute("compression", "zip");
    spec.attribute("realcam:unit",
                   "R, G, B: lux seconds on the film, linear Rec. 709; Z: metres from the film along the axis");
    // The standard attributes of OpenEXR, in its units.
    const auto set = [&](const char* name, double value) { spec.attribute(name, static_cast<float>(value)); };
    set("ExposureTime", metadata.exposure_time_s);  // expTime
    set("FNumber", metadata.f_number);              // aperture
    set("isoSpeed", metadata.iso);
    set("focus", metadata.focus_distance_m);
    set("effectiveFocalLength", metadata.focal_length_mm);
    spec.attribute("lensModel", metadata.lens);
    const float film[2] = {static_cast<float>(metadata.film_width_mm), static_cast<float>(metadata.film_height_mm)};
    spec.attribute("sensorOverallDimensions", TypeDesc(TypeDesc::FLOAT, TypeDesc::VEC2), film);
    const std::size_t row = row_values(picture, 1);
    write_rows<float>(path, "exr", spec, keep_going, [&](std::size_t first, std::size_t end, float* out) {
        for (std::size_t i = first * row; i < end * row; ++i) {
            for (std::size_t c = 0; c < 3; ++c) *out++ = picture.exposure[3 * i + c];
            *out++ = picture.depth[i];
        }
    });
}

}  // namespace

void write_image(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata, ToneCurve tone,
                 const KeepGoing& keep_going) {
    check_name(path);
    if (picture.width < 1 || picture.height < 1) throw ImageFileError(path + ": the picture is empty");
    if (format_of(path) == "png") {
        write_png(picture, path, metadata, tone, keep_going);
    } else {
        write_exr(picture, path, metadata, keep_going);
    }
}

void check_image_path(const std::string& path) {
    check_name(path);
    const UnfinishedFile attempt(path);
}

}  // namespace realcam::image_io
