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
constexpr std::size_t kMostEnvironmentPixels = std::size_t{1} << 27;

/// Upper bound of the number of pixels that any of the formats encodes in one byte: deflate makes at most 1032 bytes of
/// one, with 8 pixels each if they have one bit, and OpenEXR's PIZ some 17 000 pixels. Without it, broken files would
/// be decoded for seconds before their data end.
constexpr std::size_t kMostPixelsPerByte = 20000;

/// Throws Error if there are more pixels than `most_pixels`, than the file can hold, or than there is memory for.
void check_size(const OpenPicture& picture, std::size_t most_pixels, std::size_t bytes_per_pixel) {
    const std::string size =
        "has " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels";
    if (picture.pixel_count() > most_pixels)
        throw Error(size + "; at most " + std::to_string(most_pixels >> 20) + " million are read");
    const std::size_t encoded = picture.encoded_pixels > 0 ? picture.encoded_pixels : picture.pixel_count();
    if (encoded > most_pixels)
        throw Error("has a data window of " + std::to_string(encoded) + " pixels; at most " +
                    std::to_string(most_pixels >> 20) + " million are read");
    if (encoded / kMostPixelsPerByte > picture.encoded_size)
        throw Error(size + ", and " + std::to_string(picture.encoded_size) + " bytes cannot hold so many");
    if ((picture.pixel_count() + picture.encoded_pixels) * bytes_per_pixel > io::free_memory())
        throw Error(size + ", more than the free memory holds");
}

/// Expands a pixel in place: grey, or grey and alpha, becomes red, green, blue and alpha.
template <class Value>
void spread_grey(int channels, Value opaque, Value* rgba) {
    const Value alpha = channels == 2 ? rgba[1] : channels == 4 ? rgba[3] : opaque;
    if (channels < 3) rgba[1] = rgba[2] = rgba[0];
    rgba[3] = alpha;
}

float usable_light(float v) {
    return v > 0 ? std::min(v, 65504.0f) : 0.0f;
}

float usable_fraction(float v) {
    return v > 0 ? std::min(v, 1.0f) : 0.0f;
}

std::vector<std::uint8_t> decode_codes(OpenPicture& picture, const KeepGoing& keep_going) {
    std::vector<std::uint8_t> rgba(4 * picture.pixel_count());
    picture.read(picture.channels, 4, rgba.data(), keep_going);
    for (std::size_t i = 0; i < rgba.size(); i += 4) spread_grey<std::uint8_t>(picture.channels, 255, &rgba[i]);
    return rgba;
}

std::vector<float> decode_floats(OpenPicture& picture, const KeepGoing& keep_going) {
    std::vector<float> pixels(4 * picture.pixel_count());
    picture.read(picture.channels, 4, pixels.data(), keep_going);
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        float* rgba = &pixels[i];
        spread_grey(picture.channels, 1.0f, rgba);
        const float scale = picture.has_associated_alpha && rgba[3] > 0 ? 1 / rgba[3] : 1.0f;
        for (int c = 0; c < 3; ++c) rgba[c] = usable_light(scale * rgba[c]);
        rgba[3] = usable_fraction(rgba[3]);
    }
    return pixels;
}

io::DecodedImage decode(OpenPicture& picture, const KeepGoing& keep_going) {
    // A Texture holds 8-bit values, which exist beside the floats for a while.
    constexpr std::size_t of_codes = 4, of_floats = 4 * sizeof(float) + of_codes;
    check_size(picture, io::kMostTexturePixels, picture.is_wide ? of_floats : of_codes);
    if (!picture.is_wide) return {picture.width, picture.height, decode_codes(picture, keep_going)};
    return {picture.width, picture.height, decode_floats(picture, keep_going), picture.is_linear,
            picture.channels < 3 ? std::nullopt : picture.rec709};
}

Environment decode_environment(OpenPicture& picture, const KeepGoing& keep_going) {
    const bool linear = picture.is_linear, grey = picture.channels < 3;
    check_size(picture, kMostEnvironmentPixels, sizeof(Color));
    Environment environment;
    environment.width = picture.width;
    environment.height = picture.height;
    environment.pixels.resize(picture.pixel_count());
    static_assert(sizeof(Color) == 3 * sizeof(float));
    picture.read(grey ? 1 : 3, 3, &environment.pixels.data()->r, keep_going);
    const auto light = [&](float v) { return linear ? v : io::linear_of_srgb(v); };
    for (Color& p : environment.pixels) p = {light(p.r), light(grey ? p.r : p.g), light(grey ? p.r : p.b)};
    if (picture.rec709 && !grey)
        apply_matrix(*picture.rec709, &environment.pixels.data()->r, environment.pixels.size(), 3);
    return environment_of(picture.environment_map, std::move(environment), keep_going);
}

constexpr float kBrightest = 1e20f;  // the limit of io::validate for scenes

/// Count and first position of the invalid pixels of an environment, for messages.
struct PixelCount {
    std::size_t count = 0, first = 0;

    void add(std::size_t pixel) {
        if (count++ == 0) first = pixel;
    }
    std::string text(const Environment& environment) const {
        const Color& p = environment.pixels[first];
        const auto width = static_cast<std::size_t>(environment.width);
        char values[64];
        std::snprintf(values, sizeof values, "(%.4g, %.4g, %.4g)", double(p.r), double(p.g), double(p.b));
        return (count == 1 ? ", in row " : ", the first in row ") + std::to_string(first / width) + ", column " +
               std::to_string(first % width) + ": " + values;
    }
};

std::string pixels_are(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " pixel is" : " pixels are");
}

/// Sets negative numbers to 0, with a warning: colour conversions and sharpening leave numbers slightly below 0 where a
/// colour is hardly present. Throws ImageFileError if a pixel has a value that no scene may have, or if negative
/// numbers are more than a twentieth of the light, because the brightness would change unnoticed.
void settle_light(Environment& environment, const std::string& path, const WarnOf& warn) {
    constexpr double kMostNegative = 0.05;
    PixelCount wrong, negative;
    double light = 0, missing = 0;
    for (std::size_t i = 0; i < environment.pixels.size(); ++i) {
        const Color& p = environment.pixels[i];
        bool is_wrong = false, is_negative = false;
        for (const float v : {p.r, p.g, p.b}) {
            is_wrong |= !(v >= -kBrightest && v <= kBrightest);
            is_negative |= v < 0;
            (v < 0 ? missing : light) += static_cast<double>(std::fabs(v));
        }
        if (is_wrong) wrong.add(i);
        if (is_negative) negative.add(i);
    }
    if (wrong.count > 0)
        throw ImageFileError(path + ": " + pixels_are(wrong.count) + " no light" + wrong.text(environment) +
                             "; expected numbers from 0 to 1e20 cd/m^2");
    if (negative.count == 0) return;
    const std::string text = pixels_are(negative.count) + " negative" + negative.text(environment);
    if (missing > kMostNegative * light)
        throw ImageFileError(path + ": " + text +
                             "; expected numbers from 0 to 1e20 cd/m^2, and these are more than rounding errors");
    for (Color& p : environment.pixels) p = {std::max(p.r, 0.0f), std::max(p.g, 0.0f), std::max(p.b, 0.0f)};
    if (warn) warn(path + ": " + text + "; 0 is taken for negative numbers");
}

}  // namespace

io::DecodedImage read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes,
                            const KeepGoing& keep_going) {
    return decode(*open_picture(path, encoded_bytes), keep_going);
}

Environment read_environment(const std::string& path, const std::string& layer, const WarnOf& warn,
                             const KeepGoing& keep_going) {
    Environment environment;
    try {
        environment = decode_environment(*open_picture(path, {}, layer), keep_going);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": " + error.what() + "; expected a latitude-longitude picture");
    }
    settle_light(environment, path, warn);
    return environment;
}

namespace {

/// False for a PNG without its last chunk; its pixels may be decodable nevertheless.
bool has_its_end(const std::string& path) {
    constexpr std::string_view kLastChunk("\0\0\0\0IEND\xae\x42\x60\x82", 12);
    if (io::suffix_of(path) != ".png") return true;
    std::string end(kLastChunk.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
    return file.read(end.data(), static_cast<std::streamsize>(end.size())) && end == kLastChunk;
}

}  // namespace

std::optional<std::string> entry_of_whole_file(const std::string& path, const std::string& name,
                                               const KeepGoing& keep_going) {
    try {
        const auto picture = open_picture(path, {});
        const auto entry = std::find_if(picture->entries.begin(), picture->entries.end(),
                                        [&](const auto& candidate) { return candidate.first == name; });
        if (entry == picture->entries.end() || !has_its_end(path)) return std::nullopt;
        const bool is_film = picture->is_linear;
        check_size(*picture, io::kMostTexturePixels, is_film ? 3 * sizeof(float) : 4);
        if (is_film) {
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
            throw Error("holds no exposure; expected an .exr that realcam has written");
        check_size(*picture, io::kMostTexturePixels, 3 * sizeof(float));
        for (const auto& [name, value] : picture->entries)
            if (!io::is_utf8(name) || !io::is_utf8(value))
                throw Error("its metadata " + io::in_quotes(name) + " is no valid UTF-8 text: " + io::in_quotes(value));
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
