#include "made_textures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace realcam::io {
namespace {

/// Access to the values of a picture, 0 to 1 if it has 8 bits. Beyond the edges the picture is repeated or clamped.
class PixelValues {
public:
    explicit PixelValues(const DecodedImage& image, bool repeats = true) : image_(image), repeats_(repeats) {}

    /// Returns channel c (0 to 3: red, green, blue, alpha) of a pixel.
    float channel(int column, int row, std::size_t c) const {
        const auto wrapped = [&](int i, int n) {
            return static_cast<std::size_t>(repeats_ ? (i % n + n) % n : std::clamp(i, 0, n - 1));
        };
        const std::size_t index =
            4 * (wrapped(row, image_.height) * static_cast<std::size_t>(image_.width) + wrapped(column, image_.width)) +
            c;
        if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&image_.rgba))
            return static_cast<float>((*codes)[index]) * (1.0f / 255.0f);
        return std::get<std::vector<float>>(image_.rgba)[index];
    }
    /// Returns the mean of red, green and blue of a pixel.
    float mean(int column, int row) const {
        return (channel(column, row, 0) + channel(column, row, 1) + channel(column, row, 2)) * (1.0f / 3.0f);
    }
    /// Returns the mean of red, green and blue, interpolated bilinearly, at the centre of a texel of another picture of
    /// width x height texels.
    float mean_at(int column, int row, int width, int height) const {
        if (width == image_.width && height == image_.height) return mean(column, row);
        const float x = (static_cast<float>(column) + 0.5f) * static_cast<float>(image_.width) /
                            static_cast<float>(width) -
                        0.5f,
                    y = (static_cast<float>(row) + 0.5f) * static_cast<float>(image_.height) /
                            static_cast<float>(height) -
                        0.5f;
        const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
        const float s = x - static_cast<float>(left), t = y - static_cast<float>(top);
        return (1 - t) * ((1 - s) * mean(left, top) + s * mean(left + 1, top)) +
               t * ((1 - s) * mean(left, top + 1) + s * mean(left + 1, top + 1));
    }

private:
    const DecodedImage& image_;
    bool repeats_;
};

/// Returns a linear texture without texels.
Texture empty_texture(int width, int height, std::string name) {
    Texture texture;
    texture.name = std::move(name);
    texture.width = width;
    texture.height = height;
    texture.encoding = TextureEncoding::linear;
    return texture;
}

/// Rounds a value, clamped to 0..1, to 8 bits.
std::uint8_t to_8_bit(float v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0f, 1.0f)));
}

}  // namespace

Texture normals_of_heights(const DecodedImage& heights, float scale, bool repeats, std::string name) {
    const PixelValues values(heights, repeats);
    Texture texture = empty_texture(heights.width, heights.height, std::move(name));
    // Floats, because a step of 8-bit values is half a degree of slope.
    texture.linear_rgba.reserve(4 * static_cast<std::size_t>(heights.width) * static_cast<std::size_t>(heights.height));
    for (int row = 0; row < heights.height; ++row)
        for (int column = 0; column < heights.width; ++column) {
            // Slopes to the right and upwards.
            const float u = 0.5f * scale * (values.mean(column + 1, row) - values.mean(column - 1, row)),
                        v = 0.5f * scale * (values.mean(column, row - 1) - values.mean(column, row + 1));
            const float z = 1 / std::sqrt(1 + u * u + v * v);
            // If the scale is too large to be squared in float: a flat normal instead of NaN.
            const bool is_number = z > 0 && std::isfinite(u * z) && std::isfinite(v * z);
            const auto encoded = [&](float n) { return 0.5f + 0.5f * (is_number ? n : 0.0f); };
            texture.linear_rgba.insert(texture.linear_rgba.end(),
                                       {encoded(-u * z), encoded(-v * z), is_number ? encoded(z) : 1.0f, 1.0f});
        }
    return texture;
}

Texture roughness_and_metallic(const DecodedImage* roughness, const DecodedImage* metallic, std::string name) {
    const auto larger = [&](int DecodedImage::* size) {
        return std::max(roughness ? roughness->*size : 1, metallic ? metallic->*size : 1);
    };
    const int width = larger(&DecodedImage::width), height = larger(&DecodedImage::height);
    Texture texture = empty_texture(width, height, std::move(name));
    texture.rgba.reserve(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto value = [&](const DecodedImage* image, int column, int row) -> std::uint8_t {
        return image ? to_8_bit(PixelValues(*image).mean_at(column, row, width, height)) : 255;
    };
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
            texture.rgba.insert(texture.rgba.end(),
                                {255, value(roughness, column, row), value(metallic, column, row), 255});
    return texture;
}

Texture roughness_of_glossiness(const DecodedImage& image, float factor, std::string name) {
    const PixelValues values(image);
    Texture texture = empty_texture(image.width, image.height, std::move(name));
    texture.rgba.reserve(4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column)
            texture.rgba.insert(texture.rgba.end(),
                                {255, to_8_bit(1 - factor * values.channel(column, row, 3)), 255, 255});
    return texture;
}

}  // namespace realcam::io
