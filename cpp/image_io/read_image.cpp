#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "../error.hpp"
#include "../scene/texture.hpp"
#include "image_file.hpp"

namespace realcam::image_io {
namespace {

using OIIO::ImageInput;
using OIIO::ImageSpec;

/// One picture, opened. OpenImageIO keeps what went wrong and prints it when the program ends, unless it is asked.
struct OpenPicture {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;  // outlives the input
    std::unique_ptr<ImageInput> input;
    std::string error;

    OpenPicture(const std::string& path, std::span<const std::uint8_t> bytes) {
        ImageSpec wishes;
        wishes.attribute("oiio:UnassociatedAlpha", 1);
        std::string name = path;
        if (path.empty()) {
            memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes.data(), bytes.size());
            name = !bytes.empty() && bytes[0] == 0xff ? "memory.jpg" : "memory.png";
            // As an argument of open() it is forgotten where there are wishes too (OpenImageIO 2.4).
            OIIO::Filesystem::IOProxy* proxy = memory.get();
            wishes.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        }
        input = ImageInput::open(name, &wishes);
        error = OIIO::geterror();
    }

    /// All pixels, with their first channels.
    template <class Value>
    bool read(int channels, std::vector<Value>& pixels) {
        const ImageSpec& spec = input->spec();
        pixels.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                      static_cast<std::size_t>(channels));
        const bool good = input->read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<Value>::value, pixels.data());
        error = input->geterror();
        return good;
    }
};

bool is_plain(const ImageSpec& spec) {
    return spec.width > 0 && spec.height > 0 && spec.depth <= 1 && spec.nchannels > 0 && !spec.deep;
}

/// Red, green, blue (grey: the same three) and alpha of a pixel of 1 to 4 channels.
template <class Value>
void spread(const Value* from, int channels, Value opaque, Value* rgba) {
    const bool grey = channels < 3;
    for (int c = 0; c < 3; ++c) rgba[c] = from[grey ? 0 : c];
    rgba[3] = channels == 2 ? from[1] : channels == 4 ? from[3] : opaque;
}

float usable_light(float v) {
    return v > 0 ? std::min(v, 65504.0f) : 0.0f;
}

}  // namespace

std::optional<io::DecodedImage> read_image(const std::string& path, std::span<const std::uint8_t> encoded_bytes) {
    OpenPicture picture(path, encoded_bytes);
    if (!picture.input || !is_plain(picture.input->spec())) return std::nullopt;
    const ImageSpec& spec = picture.input->spec();
    const int channels = std::min(spec.nchannels, 4);
    const auto count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    io::DecodedImage image{spec.width, spec.height, {}};
    image.rgba.resize(4 * count);
    if (spec.format.is_floating_point()) {
        std::vector<float> pixels;
        if (!picture.read(channels, pixels)) return std::nullopt;
        for (std::size_t i = 0; i < count; ++i) {
            float rgba[4];
            spread(&pixels[i * static_cast<std::size_t>(channels)], channels, 1.0f, rgba);
            const auto unit = [](float v) { return v > 0 ? std::min(static_cast<double>(v), 1.0) : 0.0; };
            for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * i + c] = srgb_code(unit(rgba[c]));
            image.rgba[4 * i + 3] = static_cast<std::uint8_t>(std::lround(255 * unit(rgba[3])));
        }
    } else {
        std::vector<std::uint8_t> pixels;
        if (!picture.read(channels, pixels)) return std::nullopt;
        for (std::size_t i = 0; i < count; ++i)
            spread<std::uint8_t>(&pixels[i * static_cast<std::size_t>(channels)], channels, 255, &image.rgba[4 * i]);
    }
    return image;
}

Environment read_environment(const std::string& path) {
    OpenPicture picture(path, {});
    const auto fail = [&](const std::string& why) {
        const std::string reason = why.substr(0, why.find('\n'));
        throw ImageFileError(path + ": cannot be read as an environment" + (reason.empty() ? "" : ": " + reason));
    };
    if (!picture.input) fail(picture.error);
    if (!is_plain(picture.input->spec())) fail("a flat picture with colours is wanted");
    const ImageSpec& spec = picture.input->spec();
    const int channels = std::min(spec.nchannels, 4);
    const bool linear = spec.format.is_floating_point();
    std::vector<float> values;
    if (!picture.read(channels, values)) fail(picture.error);
    Environment environment;
    environment.width = spec.width;
    environment.height = spec.height;
    environment.pixels.resize(values.size() / static_cast<std::size_t>(channels));
    const auto light = [&](float v) {
        // 16 bits keep more than srgb_to_linear's 8-bit codes.
        return linear ? usable_light(v) : v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
    };
    for (std::size_t i = 0; i < environment.pixels.size(); ++i) {
        float rgba[4];
        spread(&values[i * static_cast<std::size_t>(channels)], channels, 1.0f, rgba);
        environment.pixels[i] = {light(rgba[0]), light(rgba[1]), light(rgba[2])};
    }
    return environment;
}

}  // namespace realcam::image_io
