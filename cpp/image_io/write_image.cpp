#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

#include "../camera/sensor/sensor_response.hpp"
#include "../error.hpp"
#include "../io/files/uri.hpp"
#include "../io/text/json_writer.hpp"
#include "../io/text/printable.hpp"
#include "image_file.hpp"
#include "open_picture.hpp"
#include "openimageio.hpp"

namespace realcam::image_io {
namespace {

/// Number of rows converted at a time, so that memory does not hold a large picture twice.
constexpr int kRowsPerChunk = 64;

/// Format for writing: the suffix of its files, its name in OpenImageIO, and the attribute that compresses it.
struct WrittenFormat {
    std::string_view suffix;
    const char* name;
    const char* compression;
};

constexpr WrittenFormat kExr{".exr", "exr", "zip"};
constexpr WrittenFormat kDevelopedFormats[] = {
    {".png", "png", ""},     {".jpg", "jpeg", "jpeg:95"}, {".jpeg", "jpeg", "jpeg:95"},
    {".tif", "tiff", "zip"}, {".tiff", "tiff", "zip"},    {".webp", "webp", "lossless"},
};

/// Returns the format of a path's suffix. Throws ImageFileError if it is unknown.
const WrittenFormat& format_of(const std::string& path) {
    const std::string suffix = io::suffix_of(path);
    if (suffix == kExr.suffix) return kExr;
    for (const WrittenFormat& format : kDevelopedFormats)
        if (suffix == format.suffix) return format;
    throw ImageFileError(path + ": " + (suffix.empty() ? "there is no suffix" : "\"" + suffix + "\" is not written") +
                         "; expected .png, .jpg, .tif, .webp (developed) or .exr (exposure and depth)");
}

/// Throws ImageFileError for an unknown suffix or a missing folder, for which the system's messages are less clear.
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

/// The number of values in a row of a picture.
std::size_t row_values(const PictureView& picture, std::size_t channels) {
    return channels * static_cast<std::size_t>(picture.width);
}

/// Metadata: names and values.
using Entries = std::vector<std::pair<std::string, std::string>>;

/// Header of a file with the metadata, before its channels are set.
EncodedPicture picture_header(const WrittenFormat& format, int width, int height, const Entries& entries) {
    EncodedPicture picture{format.name, width, height, {}, {}};
    picture.attributes.emplace_back("Software", "realcam " REALCAM_VERSION);
    if (*format.compression) picture.attributes.emplace_back("compression", format.compression);
    for (const auto& [name, value] : entries) picture.attributes.emplace_back(name, value);
    return picture;
}

/// Header of a file of 8-bit display values. `is_srgb`: true if the file declares sRGB.
EncodedPicture developed_header(const WrittenFormat& format, int width, int height, const Entries& entries,
                                bool is_srgb) {
    EncodedPicture picture = picture_header(format, width, height, entries);
    // Without this attribute OpenImageIO declares sRGB.
    picture.attributes.emplace_back("oiio:ColorSpace", is_srgb ? "sRGB" : "unknown");
    if (picture.format == "jpeg") picture.attributes.emplace_back("jpeg:subsampling", "4:4:4");
    if (picture.format == "jpeg" || picture.format == "tiff") {
        // JPEG and TIFF have no attributes with arbitrary names, and WebP has no text at all.
        std::string description;
        for (const auto& [name, value] : entries) description += name + '=' + value + '\n';
        picture.attributes.emplace_back("ImageDescription", description);
    }
    return picture;
}

/// Writes a picture in chunks of rows, which fill(first_row, end_row, buffer) provides. Throws ImageFileError and
/// Cancelled.
template <class Value, class Fill>
void write_rows(const std::string& path, const EncodedPicture& picture, const KeepGoing& keep_going, Fill&& fill) {
    UnfinishedFile file(path);
    const auto check = [&](const Outcome& outcome) {
        if (!outcome.is_good || !outcome.said.empty()) throw Error(first_line(outcome.said));
    };
    try {
        const auto encoder = open_encoder(picture, file);
        std::vector<Value> rows(static_cast<std::size_t>(picture.width) *
                                (picture.channels.empty() ? 3 : picture.channels.size()) * kRowsPerChunk);
        for (int y = 0; y < picture.height; y += kRowsPerChunk) {
            if (keep_going && !keep_going()) throw Cancelled();
            const int end = std::min(y + kRowsPerChunk, picture.height);
            fill(static_cast<std::size_t>(y), static_cast<std::size_t>(end), rows.data());
            check(encoder->write(y, end, rows.data()));
        }
        check(encoder->close());
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": cannot be written: " + error.what());
    }
    file.finish();
}

/// Writes a picture as 8-bit display values.
void write_developed(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
                     const View& view, const KeepGoing& keep_going) {
    Entries entries = metadata.entries();
    std::ranges::move(view.entries(), std::back_inserter(entries));
    const EncodedPicture file =
        developed_header(format_of(path), picture.width, picture.height, entries, view.is_srgb());
    const std::size_t row = row_values(picture, 1);
    write_rows<std::uint8_t>(path, file, keep_going, [&](std::size_t first, std::size_t end, std::uint8_t* out) {
        view.develop(picture.exposure + 3 * first * row, (end - first) * row, metadata.iso, out);
    });
}

/// Channel names of a layer in the file, and the unit of their values.
struct LayerChannels {
    std::vector<const char*> names;
    const char* unit;
};

LayerChannels channels_of(Layer layer) {
    switch (layer) {
        case Layer::depth: break;  // Z, which every file has
        case Layer::normal: return {{"Normal.X", "Normal.Y", "Normal.Z"}, "scene axes"};
        case Layer::albedo: return {{"Albedo.R", "Albedo.G", "Albedo.B"}, "0 to 1, linear"};
        case Layer::circle_of_confusion_mm: return {{"CircleOfConfusion"}, "mm on the film, diameter"};
        case Layer::sample_count: return {{"SampleCount"}, "samples of the pixel"};
        case Layer::variance:
            return {{"Variance.R", "Variance.G", "Variance.B"}, "(lux seconds)^2, of R, G, B in linear Rec. 709"};
        case Layer::depth_middle: return {{"DepthMiddle.Z"}, "metres from the film along the axis, middle ray"};
        case Layer::normal_middle:
            return {{"NormalMiddle.X", "NormalMiddle.Y", "NormalMiddle.Z"}, "scene axes, middle ray"};
        case Layer::motion: return {{"Motion.X", "Motion.Y"}, "pixels right and down while exposed, middle ray"};
        case Layer::position_middle:
            return {{"PositionMiddle.X", "PositionMiddle.Y", "PositionMiddle.Z"}, "metres in the scene, middle ray"};
        case Layer::traced_light:
            return {{"TracedLight.R", "TracedLight.G", "TracedLight.B"}, "lux seconds, traced from the lights"};
        case Layer::dual_pixel_left:
            return {{"DualPixelLeft.R", "DualPixelLeft.G", "DualPixelLeft.B"}, "lux seconds, left half of the pupil"};
        case Layer::dual_pixel_right:
            return {{"DualPixelRight.R", "DualPixelRight.G", "DualPixelRight.B"},
                    "lux seconds, right half of the pupil"};
        case Layer::object_id: return {{"ObjectId"}, "key of realcam:objects, middle ray; 0: nothing"};
        case Layer::material_id: return {{"MaterialId"}, "key of realcam:materials, middle ray; 0: nothing"};
    }
    return {};
}

/// Returns the names as JSON: {"1": "static geometry", ...}.
std::string json_of(const IdNames& names) {
    io::JsonWriter json;
    json.begin_object();
    for (std::size_t i = 1; i < names.size(); ++i) json.key(std::to_string(i)).text(io::printable(names[i]));
    return json.end().finish();
}

/// Adds the channels of the layers, and the attributes with their units and the names of ids.
void add_layers(const PictureView& picture, ExrColorSpace color_space, EncodedPicture& exr) {
    std::string unit = std::string("R, G, B: lux seconds on the film, linear ") +
                       (color_space == ExrColorSpace::acescg ? "ACEScg" : "Rec. 709") +
                       "; Z: metres from the film along the axis";
    for (const PictureView::Layer& layer : picture.layers) {
        const LayerChannels channels = channels_of(layer.layer);
        for (const char* name : channels.names) exr.channels.push_back({name, info_of(layer.layer).is_number});
        if (channels.names.empty()) continue;
        const std::string first = channels.names[0];
        unit += "; " + first.substr(0, first.find('.')) + ": " + channels.unit;
    }
    exr.attributes.emplace_back("realcam:unit", unit);
    if (!picture.object_names.empty()) exr.attributes.emplace_back("realcam:objects", json_of(picture.object_names));
    if (!picture.material_names.empty())
        exr.attributes.emplace_back("realcam:materials", json_of(picture.material_names));
}

/// True if a layer has colours, which are converted to the colour space of the file. A variance is not one: converted,
/// it would need the covariances of the channels.
bool has_colors(Layer layer) {
    return layer == Layer::albedo || layer == Layer::traced_light || layer == Layer::dual_pixel_left ||
           layer == Layer::dual_pixel_right;
}

/// Writes exposure, depth and layers as OpenEXR.
void write_exr(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
               ExrColorSpace color_space, const KeepGoing& keep_going) {
    EncodedPicture exr = picture_header(kExr, picture.width, picture.height, metadata.entries());
    exr.channels = {{"R"}, {"G"}, {"B"}, {"Z"}};
    add_layers(picture, color_space, exr);
    // Standard attributes of OpenEXR, in its units.
    const auto set = [&](const char* name, double value) {
        exr.attributes.emplace_back(name, static_cast<float>(value));
    };
    set("ExposureTime", metadata.exposure_time_s);  // expTime
    set("FNumber", metadata.f_number);              // aperture
    set("isoSpeed", metadata.iso);
    set("focus", metadata.focus_distance_m);
    set("effectiveFocalLength", metadata.focal_length_mm);
    exr.attributes.emplace_back("lensModel", metadata.lens);
    exr.attributes.emplace_back("sensorOverallDimensions", std::array{static_cast<float>(metadata.film_width_mm),
                                                                      static_cast<float>(metadata.film_height_mm)});
    const bool is_acescg = color_space == ExrColorSpace::acescg;
    const Chromaticities& chromaticities = is_acescg ? kAcesCgChromaticities : kRec709Chromaticities;
    std::array<float, 8> numbers{};
    std::ranges::transform(chromaticities, numbers.begin(), [](double v) { return static_cast<float>(v); });
    exr.attributes.emplace_back("chromaticities", numbers);
    std::optional<std::array<double, 9>> from_rec709;
    if (const auto rec709 = rec709_from(chromaticities)) from_rec709 = sensor_detail::inverse(*rec709);
    const auto write_colors = [&](const float* rgb, float* out) {
        std::copy_n(rgb, 3, out);
        if (from_rec709) apply_matrix(*from_rec709, out, 1, 3);
    };
    const std::size_t row = row_values(picture, 1);
    // All channels have four bytes, so whole numbers are stored among the floats.
    write_rows<float>(path, exr, keep_going, [&](std::size_t first, std::size_t end, float* out) {
        for (std::size_t i = first * row; i < end * row; ++i) {
            write_colors(&picture.exposure[3 * i], out);
            out[3] = picture.depth[i];
            out += 4;
            for (const PictureView::Layer& layer : picture.layers) {
                if (layer.layer == Layer::depth) continue;
                const auto channels = static_cast<std::size_t>(info_of(layer.layer).channels);
                if (has_colors(layer.layer))
                    write_colors(static_cast<const float*>(layer.values) + 3 * i, out);
                else
                    std::memcpy(out, static_cast<const char*>(layer.values) + 4 * channels * i, 4 * channels);
                out += channels;
            }
        }
    });
}

}  // namespace

void write_image(const PictureView& picture, const std::string& path, const io::ImageMetadata& metadata,
                 const View& view, ExrColorSpace color_space, const KeepGoing& keep_going) {
    check_name(path);
    if (picture.width < 1 || picture.height < 1) throw ImageFileError(path + ": the picture is empty");
    if (&format_of(path) == &kExr)
        write_exr(picture, path, metadata, color_space, keep_going);
    else
        write_developed(picture, path, metadata, view, keep_going);
}

void write_codes(const std::string& path, int width, int height, const std::uint8_t* codes,
                 const std::vector<std::pair<std::string, std::string>>& entries, bool is_srgb,
                 const KeepGoing& keep_going) {
    check_name(path);
    if (&format_of(path) == &kExr) throw ImageFileError(path + ": 8-bit values need a .png, .jpg, .tif or .webp file");
    if (width < 1 || height < 1) throw ImageFileError(path + ": the picture is empty");
    const EncodedPicture file = developed_header(format_of(path), width, height, entries, is_srgb);
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    write_rows<std::uint8_t>(path, file, keep_going, [&](std::size_t first, std::size_t end, std::uint8_t* out) {
        std::memcpy(out, codes + first * row, (end - first) * row);
    });
}

void check_image_path(const std::string& path) {
    check_name(path);
    const UnfinishedFile attempt(path);
}

}  // namespace realcam::image_io
