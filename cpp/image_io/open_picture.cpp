#include "open_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../camera/sensor/sensor_response.hpp"
#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/files/uri.hpp"
#include "../io/text/printable.hpp"

namespace realcam::image_io {

namespace {

/// Number of bytes that image_format examines.
constexpr std::size_t kFormatBytes = 16;

/// The formats of image_format, for messages.
constexpr const char* kFormatNames = "PNG, JPEG, OpenEXR, Radiance HDR, TIFF, BMP, WebP or TGA";

/// Returns OpenImageIO's name of the reader for a file's first bytes: "png", "jpeg", "openexr", "hdr", "tiff", "bmp",
/// "webp", or "targa" by the suffix of `path`, because that format has no signature. Empty for anything else:
/// OpenImageIO's readers of rarer formats crash on broken files.
std::string image_format(std::span<const std::uint8_t> first_bytes, const std::string& path) {
    using namespace std::string_view_literals;
    const std::string_view bytes(reinterpret_cast<const char*>(first_bytes.data()), first_bytes.size());
    const auto starts_with = [&](std::string_view mark) { return bytes.substr(0, mark.size()) == mark; };
    if (starts_with("\x89PNG\r\n\x1a\n"sv)) return "png";
    if (starts_with("\xff\xd8\xff"sv)) return "jpeg";
    if (starts_with("\x76\x2f\x31\x01"sv)) return "openexr";
    if (starts_with("#?RADIANCE"sv) || starts_with("#?RGBE"sv)) return "hdr";
    if (starts_with("II*\0"sv) || starts_with("MM\0*"sv)) return "tiff";
    if (starts_with("RIFF"sv) && bytes.substr(std::min<std::size_t>(8, bytes.size()), 4) == "WEBP"sv) return "webp";
    if (starts_with("BM"sv)) return "bmp";
    return io::suffix_of(path) == ".tga" ? "targa" : "";
}

}  // namespace

std::unique_ptr<OpenPicture> open_picture(const std::string& path, std::span<const std::uint8_t> bytes,
                                          const std::string& layer) {
    std::vector<std::uint8_t> beginning(bytes.begin(), bytes.begin() + std::min(bytes.size(), kFormatBytes));
    if (!path.empty()) {
        const std::string why = io::why_unreadable(path);
        if (!why.empty()) throw Error(why);
        beginning.resize(kFormatBytes);
        std::ifstream file(path, std::ios::binary);
        file.read(reinterpret_cast<char*>(beginning.data()), kFormatBytes);
        beginning.resize(static_cast<std::size_t>(file.gcount()));
    }
    const std::string format = image_format(beginning, path);
    if (format.empty()) throw Error(std::string("is not a picture; expected ") + kFormatNames);
    if (!layer.empty() && format != "openexr")
        throw Error("has no layers, and layer " + io::in_quotes(layer) +
                    " was requested; only OpenEXR files have layers");
    auto picture = format == "png"   ? open_png(path, bytes)
                   : format == "hdr" ? open_radiance(path, bytes)
                                     : open_with_openimageio(format, path, bytes, layer);
    picture->encoded_size = path.empty() ? bytes.size() : std::filesystem::file_size(path);
    if (picture->width < 1 || picture->height < 1 || picture->channels < 1)
        throw Error("has no flat picture with colours");
    return picture;
}

namespace {

using Matrix = std::array<double, 9>;

/// Primaries of files of X, Y and Z, whose white point is arbitrary.
constexpr std::array<double, 6> kXyzPrimaries = {1, 0, 0, 1, 0, 0};

bool are_close(const Chromaticities& a, const Chromaticities& b) {
    constexpr double kRounding = 2e-4;  // files have four digits
    return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::abs(x - y) < kRounding; });
}

/// Returns the matrix from RGB to XYZ; RGB = (1, 1, 1) is white with Y = 1. All zeros if the chromaticities are
/// degenerate.
Matrix xyz_from(const Chromaticities& c) {
    const auto xyz = [&](std::size_t i) {
        return std::array<double, 3>{c[2 * i], c[2 * i + 1], 1 - c[2 * i] - c[2 * i + 1]};
    };
    const auto red = xyz(0), green = xyz(1), blue = xyz(2), white = xyz(3);
    const Matrix primaries = {red[0], green[0], blue[0], red[1], green[1], blue[1], red[2], green[2], blue[2]};
    const double area = (c[2] - c[0]) * (c[5] - c[1]) - (c[4] - c[0]) * (c[3] - c[1]);
    if (!(std::abs(area) > 1e-4) || !(white[1] > 1e-4)) return {};
    const auto scale =
        sensor_detail::applied(sensor_detail::inverse(primaries), {white[0] / white[1], 1, white[2] / white[1]});
    return sensor_detail::product(primaries, sensor_detail::diagonal(scale));
}

}  // namespace

std::optional<Matrix> rec709_from(const Chromaticities& chromaticities) {
    if (are_close(chromaticities, kRec709Chromaticities)) return std::nullopt;
    const Matrix rec709_from_xyz = sensor_detail::inverse(xyz_from(kRec709Chromaticities));
    if (std::equal(kXyzPrimaries.begin(), kXyzPrimaries.end(), chromaticities.begin())) return rec709_from_xyz;
    const Matrix xyz_from_file = xyz_from(chromaticities);
    const auto all_below = [](const auto& values, double limit) {
        return std::all_of(values.begin(), values.end(), [&](double v) { return std::abs(v) < limit; });
    };
    if (!all_below(chromaticities, 10) || !all_below(xyz_from_file, 1e4) || xyz_from_file == Matrix{})
        throw Error("has degenerate chromaticities of red, green, blue and white");
    const auto white_of = [](const Matrix& m) { return sensor_detail::applied(m, {1, 1, 1}); };
    return sensor_detail::product(
        rec709_from_xyz, sensor_detail::product(sensor_detail::adaptation(white_of(xyz_from_file),
                                                                          white_of(xyz_from(kRec709Chromaticities))),
                                                xyz_from_file));
}

void apply_matrix(const Matrix& matrix, float* pixels, std::size_t count, std::size_t stride) {
    for (std::size_t i = 0; i < count; ++i, pixels += stride) {
        const auto out = sensor_detail::applied(matrix, {pixels[0], pixels[1], pixels[2]});
        for (std::size_t c = 0; c < 3; ++c) pixels[c] = static_cast<float>(out[c]);
    }
}

}  // namespace realcam::image_io
