#include <algorithm>
#include <cstdio>
#include <vector>

#include "../error.hpp"
#include "../io/decoded_image.hpp"
#include "../io/free_memory.hpp"
#include "image_file.hpp"
#include "open_picture.hpp"

namespace realcam::image_io {
namespace {

/// 16384 x 16384: what a texture of a GPU has at most. A file of a megabyte can claim 40000 x 40000.
constexpr std::size_t kMostTexturePixels = std::size_t{1} << 28;
/// 16384 x 8192, the largest environments that are sold.
constexpr std::size_t kMostEnvironmentPixels = std::size_t{1} << 27;

/// More than any of the formats makes of one byte: deflate makes at most 1032 bytes of one, of 8 pixels each where they
/// have one bit, and OpenEXR's PIZ some 17 000 pixels. Broken files would be decoded for seconds before their data end.
constexpr std::size_t kMostPixelsPerByte = 20000;

/// Throws Error where the pixels are more than anybody needs, or than there is memory for.
void check_size(const OpenPicture& picture, std::size_t most_pixels, std::size_t bytes_per_pixel) {
    const std::string size =
        "has " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels";
    if (picture.pixel_count() > most_pixels)
        throw Error(size + "; at most " + std::to_string(most_pixels >> 20) + " million are read");
    if (picture.pixel_count() / kMostPixelsPerByte > picture.encoded_size)
        throw Error(size + ", and " + std::to_string(picture.encoded_size) + " bytes cannot hold so many");
    if (picture.pixel_count() * bytes_per_pixel > io::free_memory())
        throw Error(size + ", more than the free memory holds");
}

/// Grey and grey with alpha, as they were decoded to the beginning of a pixel, as red, green, blue (and alpha).
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
    // Floats become the 8 bits of a Texture beside them.
    constexpr std::size_t of_codes = 4, of_floats = 4 * sizeof(float) + of_codes;
    check_size(picture, kMostTexturePixels, picture.is_wide ? of_floats : of_codes);
    if (!picture.is_wide) return {picture.width, picture.height, decode_codes(picture, keep_going)};
    return {picture.width, picture.height, decode_floats(picture, keep_going), picture.is_linear};
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
    return environment;
}

/// Throws ImageFileError where a pixel holds what no scene may: it would be darkened, or brightened, unnoticed.
void check_light(const Environment& environment, const std::string& path) {
    constexpr float kBrightest = 1e20f;  // as io::validate has it for scenes
    const auto is_light = [](float v) { return v >= 0 && v <= kBrightest; };
    const auto is_wrong = [&](const auto& p) { return !is_light(p.r) || !is_light(p.g) || !is_light(p.b); };
    const auto& pixels = environment.pixels;
    const auto first = std::find_if(pixels.begin(), pixels.end(), is_wrong);
    if (first == pixels.end()) return;
    char values[64];
    std::snprintf(values, sizeof values, "(%.4g, %.4g, %.4g)", double(first->r), double(first->g), double(first->b));
    const auto place = first - pixels.begin();
    throw ImageFileError(path + ": " + std::to_string(std::count_if(first, pixels.end(), is_wrong)) +
                         " pixels are no light, the first in row " + std::to_string(place / environment.width) +
                         ", column " + std::to_string(place % environment.width) + ": " + values +
                         "; numbers from 0 to 1e20 cd/m^2 are wanted");
}

}  // namespace

std::optional<io::DecodedImage> read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes,
                                           const KeepGoing& keep_going) {
    try {
        return decode(*open_picture(path, encoded_bytes), keep_going);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error&) {
        return std::nullopt;  // the caller names the picture, and puts another in its stead
    }
}

Environment read_environment(const std::string& path, const KeepGoing& keep_going) {
    Environment environment;
    try {
        environment = decode_environment(*open_picture(path, {}), keep_going);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": " + error.what() + "; a latitude-longitude picture was wanted");
    }
    check_light(environment, path);
    return environment;
}

FilmFile read_film(const std::string& path, const KeepGoing& keep_going) {
    try {
        const auto picture = open_picture(path, {});
        if (!picture->is_linear || picture->channels < 3)
            throw Error("holds no exposure; an .exr that realcam has written is wanted");
        check_size(*picture, kMostTexturePixels, 3 * sizeof(float));
        FilmFile film{picture->width, picture->height, std::vector<float>(3 * picture->pixel_count()),
                      picture->entries};
        picture->read(3, 3, film.exposure.data(), keep_going);
        return film;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        throw ImageFileError(path + ": " + error.what());
    }
}

}  // namespace realcam::image_io
