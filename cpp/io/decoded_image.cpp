#include "decoded_image.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace realcam::io {

float linear_of_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

bool is_whole(const DecodedImage& image) {
    const std::size_t size = std::visit([](const auto& values) { return values.size(); }, image.rgba);
    return image.width > 0 && image.height > 0 &&
           size == std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

Texture texture_of(DecodedImage image, TextureUse use, std::string name) {
    Texture texture;
    texture.name = std::move(name);
    texture.width = image.width;
    texture.height = image.height;
    const bool encoded = is_srgb(image, use);
    if (auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.rgba)) {
        texture.encoding = encoded ? TextureEncoding::srgb : TextureEncoding::linear;
        texture.rgba = std::move(*codes);
        return texture;
    }
    texture.linear_rgba = std::move(std::get<std::vector<float>>(image.rgba));
    for (std::size_t i = 0; encoded && i < texture.linear_rgba.size(); ++i)
        if (i % 4 != 3) texture.linear_rgba[i] = linear_of_srgb(texture.linear_rgba[i]);
    return texture;
}

}  // namespace realcam::io
