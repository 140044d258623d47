#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "../error.hpp"
#include "../io/files/regular_file.hpp"
#include "../io/files/uri.hpp"
#include "../io/scene/decoded_image.hpp"
#include "../io/text/printable.hpp"
#include "environment_map.hpp"
#include "image_file.hpp"
#include "open_picture.hpp"

namespace realcam::image_io {
namespace {

/// 16384 x 8192 pixels, the largest environments on the market.
constexpr std::size_t kMaxEnvironmentPixels = std::size_t{1} << 27;

/// Upper bound of the number of pixels per encoded byte of any format: deflate expands a byte to at most 1032 bytes,
/// with 8 pixels each if they have one bit, and OpenEXR's PIZ to some 17,000 pixels. Without this check, broken files
/// would be decoded for seconds before their data end.
constexpr std::size_t kMaxPixelsPerByte = 20000;

/// Throws Error if the picture has more pixels than `max_pixels`, than the file's size allows, or than the free memory
/// holds.
void check_size(const OpenPicture& picture, std::size_t max_pixels, std::size_t bytes_per_pixel) {
    const std::string size =
        "has " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels";
    if (picture.pixel_count() > max_pixels)
        throw Error(size + "; at most " + std::to_string(max_pixels >> 20) + " million are read");
    const std::size_t encoded = picture.encoded_pixels > 0 ? picture.encoded_pixels : picture.pixel_count();
    if (encoded > max_pixels)
        throw Error("has a data window of " + std::to_string(encoded) + " pixels; at most " +
                    std::to_string(max_pixels >> 20) + " million are read");
    if (encoded / kMaxPixelsPerByte > picture.encoded_size)
        throw Error(size + ", and " + std::to_string(picture.encoded_size) + " bytes cannot hold so many");
    if ((picture.pixel_count() + picture.encoded_pixels) * bytes_per_pixel > io::free_memory())
        throw Error(size + ", more than the free memory holds");
}

/// Expands a pixel of `channels` channels in place to red, green, blue and alpha. `opaque`: alpha of a pixel without
/// it.
template <class Value>
void expand_to_rgba(int channels, Value opaque, Value* rgba) {
    const Value alpha = channels == 2 ? rgba[1] : channels == 4 ? rgba[3] : opaque;
    if (channels < 3) rgba[1] = rgba[2] = rgba[0];
    rgba[3] = alpha;
}

/// Limits a value to 0 to the largest half float; NaN becomes 0.
float usable_light(float v) {
    constexpr float kMaxHalf = 65504.0f;
    return v > 0 ? std::min(v, kMaxHalf) : 0.0f;
}

/// Limits an alpha value to 0 to 1; NaN becomes 0.
float usable_fraction(float v) {
    return v > 0 ? std::min(v, 1.0f) : 0.0f;
}

/// Decodes a picture to 8-bit RGBA.
std::vector<std::uint8_t> decode_codes(OpenPicture& picture, const KeepGoing& keep_going) {
    std::vector<std::uint8_t> rgba(4 * picture.pixel_count());
    picture.read(picture.channels, 4, rgba.data(), keep_going);
    for (std::size_t i = 0; i < rgba.size(); i += 4) expand_to_rgba<std::uint8_t>(picture.channels, 255, &rgba[i]);
    return rgba;
}

/// Decodes a picture to RGBA with unassociated alpha.
std::vector<float> decode_floats(OpenPicture& picture, const KeepGoing& keep_going) {
    std::vector<float> pixels(4 * picture.pixel_count());
    picture.read(picture.channels, 4, pixels.data(), keep_going);
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        float* rgba = &pixels[i];
        expand_to_rgba(picture.channels, 1.0f, rgba);
        const float scale = picture.has_associated_alpha && rgba[3] > 0 ? 1 / rgba[3] : 1.0f;
        for (int c = 0; c < 3; ++c) rgba[c] = usable_light(scale * rgba[c]);
        rgba[3] = usable_fraction(rgba[3]);
    }
    return pixels;
}

/// Decodes a picture for a texture: 8-bit RGBA, or floats if the file has more than 8 bits.
io::DecodedImage decode(OpenPicture& picture, const KeepGoing& keep_going) {
    // Bytes per pixel: the 8-bit values of a Texture exist beside the floats for a while.
    constexpr std::size_t code_bytes = 4, float_bytes = 4 * sizeof(float) + code_bytes;
    check_size(picture, io::kMaxTexturePixels, picture.is_wide ? float_bytes : code_bytes);
    if (!picture.is_wide) return {picture.width, picture.height, decode_codes(picture, keep_going)};
    return {picture.width, picture.height, decode_floats(picture, keep_going), picture.is_linear,
            picture.channels < 3 ? std::nullopt : picture.rec709};
}

/// Decodes a picture to radiance in linear Rec. 709, with realcam's directions. `to_rec709`: see read_environment.
Environment decode_environment(OpenPicture& picture, const KeepGoing& keep_going,
                               const io::ColorConversion& to_rec709) {
    const bool linear = picture.is_linear, grey = picture.channels < 3;
    check_size(picture, kMaxEnvironmentPixels, sizeof(Color));
    Environment environment;
    environment.width = picture.width;
    environment.height = picture.height;
    environment.pixels.resize(picture.pixel_count());
    static_assert(sizeof(Color) == 3 * sizeof(float));
    picture.read(grey ? 1 : 3, 3, &environment.pixels.data()->r, keep_going);
    const auto linear_value = [&](float v) { return linear || to_rec709 ? v : io::linear_of_srgb(v); };
    for (Color& p : environment.pixels)
        p = {linear_value(p.r), linear_value(grey ? p.r : p.g), linear_value(grey ? p.r : p.b)};
    if (to_rec709)
        to_rec709({&environment.pixels.data()->r, 3 * environment.pixels.size()});
    else if (picture.rec709 && !grey)
        apply_matrix(*picture.rec709, &environment.pixels.data()->r, environment.pixels.size(), 3);
    return environment_of(picture.environment_map, std::move(environment), keep_going);
}

constexpr float kMaxRadiance_cd_m2 = 1e20f;  // same limit as in scene_checks.hpp

/// Number and first index of invalid pixels of an environment, for messages.
struct InvalidPixels {
    std::size_t count = 0, first = 0;

    /// Counts a pixel by its index.
    void add(std::size_t pixel) {
        if (count++ == 0) first = pixel;
    }
    /// Position and value of the first pixel, as the continuation of counted_pixels.
    std::string text(const Environment& environment) const {
        const Color& p = environment.pixels[first];
        const auto width = static_cast<std::size_t>(environment.width);
        char values[64];
        std::snprintf(values, sizeof values, "(%.4g, %.4g, %.4g)", double(p.r), double(p.g), double(p.b));
        return (count == 1 ? ", in row " : ", the first in row ") + std::to_string(first / width) + ", column " +
               std::to_string(first % width) + ": " + values;
    }
};

/// "1 pixel is", "2 pixels are"
std::string counted_pixels(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " pixel is" : " pixels are");
}

/// Sets negative numbers to 0, with a warning: colour conversions and sharpening leave numbers slightly below 0 where a
/// colour is hardly present. Throws ImageFileError if a pixel has a value that no scene may have, or if negative
/// numbers are more than a twentieth of the light, because the brightness would change unnoticed.
void clamp_negative_radiance(Environment& environment, const std::string& path, const WarnOf& warn) {
    constexpr double kMaxNegativeFraction = 0.05;
    InvalidPixels invalid, negative;
    double light = 0, negative_light = 0;
    for (std::size_t i = 0; i < environment.pixels.size(); ++i) {
        const Color& p = environment.pixels[i];
        bool is_invalid = false, is_negative = false;
        for (const float v : {p.r, p.g, p.b}) {
            is_invalid |= !(v >= -kMaxRadiance_cd_m2 && v <= kMaxRadiance_cd_m2);
            is_negative |= v < 0;
            (v < 0 ? negative_light : light) += static_cast<double>(std::fabs(v));
        }
        if (is_invalid) invalid.add(i);
        if (is_negative) negative.add(i);
    }
    if (invalid.count > 0)
        throw ImageFileError(path + ": " + counted_pixels(invalid.count) + " invalid" + invalid.text(environment) +
                             "; expected numbers from 0 to 1e20 cd/m^2");
    if (negative.count == 0) return;
    const std::string text = counted_pixels(negative.count) + " negative" + negative.text(environment);
    if (negative_light > kMaxNegativeFraction * light)
        throw ImageFileError(path + ": " + text +
                             "; expected numbers from 0 to 1e20 cd/m^2, and these are more than rounding errors");
    for (Color& p : environment.pixels) p = {std::max(p.r, 0.0f), std::max(p.g, 0.0f), std::max(p.b, 0.0f)};
    if (warn) warn(path + ": " + text + "; negative numbers become 0");
}

}  // namespace

io::DecodedImage read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes,
                            const KeepGoing& keep_going) {
    return decode(*open_picture(path, encoded_bytes), keep_going);
}

namespace {

/// Reads a picture as radiance. `advice`: end of the message of a file that cannot be read.
Environment read_radiance(const std::string& path, const std::string& layer, const std::string& advice,
                          const WarnOf& warn, const KeepGoing& keep_going, const io::ColorConversion& to_rec709 = {}) {
    Environment environment;
    try {
        environment = decode_environment(*open_picture(path, {}, layer), keep_going, to_rec709);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": " + error.what() + advice);
    }
    clamp_negative_radiance(environment, path, warn);
    return environment;
}

}  // namespace

Environment read_environment(const std::string& path, const std::string& layer, const WarnOf& warn,
                             const KeepGoing& keep_going, const io::ColorConversion& to_rec709) {
    return read_radiance(path, layer, "; an environment must be a latitude-longitude picture", warn, keep_going,
                         to_rec709);
}

Environment read_picture(const std::string& path, const WarnOf& warn, const KeepGoing& keep_going) {
    return read_radiance(path, {}, "", warn, keep_going);
}

namespace {

/// False for a PNG without its last chunk, whose pixels may nevertheless be decodable; true for all other files.
bool has_last_png_chunk(const std::string& path) {
    constexpr std::string_view kLastChunk("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    if (io::suffix_of(path) != ".png") return true;
    std::string end(kLastChunk.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
    return file.read(end.data(), static_cast<std::streamsize>(end.size())) && end == kLastChunk;
}

}  // namespace

std::optional<std::string> entry_of_complete_picture(const std::string& path, const std::string& name,
                                                     const KeepGoing& keep_going) {
    try {
        const auto picture = open_picture(path, {});
        const auto entry = std::find_if(picture->entries.begin(), picture->entries.end(),
                                        [&](const auto& candidate) { return candidate.first == name; });
        if (entry == picture->entries.end() || !has_last_png_chunk(path)) return std::nullopt;
        const bool is_exposure = picture->is_linear;
        check_size(*picture, io::kMaxTexturePixels, is_exposure ? 3 * sizeof(float) : 4);
        if (is_exposure) {
            std::vector<float> pixels(3 * picture->pixel_count());
            picture->read(std::min(picture->channels, 3), 3, pixels.data(), keep_going);
        } else {
            decode_codes(*picture, keep_going);
        }
        return entry->second;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error&) {
        return std::nullopt;
    }
}

FilmFile read_film(const std::string& path, const KeepGoing& keep_going) {
    try {
        const auto picture = open_picture(path, {});
        if (!picture->is_linear || picture->channels < 3)
            throw Error("has no exposure; expected an .exr that realcam has written");
        check_size(*picture, io::kMaxTexturePixels, 3 * sizeof(float));
        for (const auto& [name, value] : picture->entries)
            if (!io::is_utf8(name) || !io::is_utf8(value))
                throw Error("its metadata " + io::in_quotes(name) +
                            " is not valid UTF-8 text: " + io::in_quotes(value));
        FilmFile film{picture->width, picture->height, std::vector<float>(3 * picture->pixel_count()),
                      picture->entries};
        picture->read(3, 3, film.exposure.data(), keep_going);
        if (picture->rec709) apply_matrix(*picture->rec709, film.exposure.data(), picture->pixel_count(), 3);
        return film;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": " + error.what());
    }
}

}  // namespace realcam::image_io
