#include "decoded_image.hpp"

#include <algorithm>
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

namespace {

/// Stores the mean of red, green and blue in the alpha channel if alpha is white everywhere. `white`: largest value of
/// a channel.
template <class Value>
void set_alpha_to_mean(std::vector<Value>& rgba, Value white) {
    for (std::size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] != white) return;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rgba[i + 3] = std::min(static_cast<Value>((rgba[i] + rgba[i + 1] + rgba[i + 2]) / 3), white);
}

/// Returns the values as fractions of the largest.
std::vector<float> fractions(const std::vector<std::uint8_t>& codes) {
    std::vector<float> values(codes.size());
    std::ranges::transform(codes, values.begin(), [](std::uint8_t code) { return static_cast<float>(code) / 255; });
    return values;
}

/// Converts the colours of RGBA values. Negative results, of colours outside the gamut of Rec. 709, and NaN become 0.
void convert(std::vector<float>& rgba, const ColorConversion& to_rec709) {
    std::vector<float> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4) rgb.insert(rgb.end(), &rgba[i], &rgba[i + 3]);
    to_rec709(rgb);
    for (std::size_t i = 0, j = 0; i < rgba.size(); ++i)
        if (i % 4 != 3) {
            const float value = rgb[j++];
            rgba[i] = value > 0 ? value : 0.0f;
        }
}

/// Converts to linear Rec. 709 by a matrix (DecodedImage::rec709). Negative results, of colours outside its gamut,
/// become 0.
void convert_to_rec709(std::vector<float>& rgba, const std::array<double, 9>& rec709) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const double in[3] = {double(rgba[i]), double(rgba[i + 1]), double(rgba[i + 2])};
        for (std::size_t c = 0; c < 3; ++c) {
            const double out = rec709[3 * c] * in[0] + rec709[3 * c + 1] * in[1] + rec709[3 * c + 2] * in[2];
            rgba[i + c] = static_cast<float>(std::max(out, 0.0));
        }
    }
}

}  // namespace

Texture texture_of(DecodedImage image, TextureUse use, std::string name) {
    if (use == TextureUse::opacity) {
        if (auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.rgba))
            set_alpha_to_mean<std::uint8_t>(*codes, 255);
        else
            set_alpha_to_mean(std::get<std::vector<float>>(image.rgba), 1.0f);
    }
    Texture texture;
    texture.name = std::move(name);
    texture.width = image.width;
    texture.height = image.height;
    if (use == TextureUse::colour && image.to_rec709) {
        if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.rgba)) image.rgba = fractions(*codes);
        texture.linear_rgba = std::move(std::get<std::vector<float>>(image.rgba));
        convert(texture.linear_rgba, image.to_rec709);
        return texture;
    }
    const bool is_encoded = is_srgb(image, use);
    if (auto* codes = std::get_if<std::vector<std::uint8_t>>(&image.rgba)) {
        texture.encoding = is_encoded ? TextureEncoding::srgb : TextureEncoding::linear;
        texture.rgba = std::move(*codes);
        return texture;
    }
    texture.linear_rgba = std::move(std::get<std::vector<float>>(image.rgba));
    if (use == TextureUse::colour && image.rec709) convert_to_rec709(texture.linear_rgba, *image.rec709);
    for (std::size_t i = 0; is_encoded && i < texture.linear_rgba.size(); ++i)
        if (i % 4 != 3) texture.linear_rgba[i] = linear_of_srgb(texture.linear_rgba[i]);
    return texture;
}

bool has_holes(const Texture& texture) {
    const auto has_alpha_below = [](const auto& rgba, auto white) {
        for (std::size_t i = 3; i < rgba.size(); i += 4)
            if (rgba[i] < white) return true;
        return false;
    };
    return has_alpha_below(texture.rgba, 255) || has_alpha_below(texture.linear_rgba, 1.0f);
}

std::string decode_vertex_colours(std::vector<VertexColor>& colours) {
    constexpr float kMax = 1e30f;  // larger numbers are errors of the file
    std::size_t bad = 0;
    float max_colour = 0, max_alpha = 0;
    const auto correct = [&](float& v) {
        if (v >= 0 && v < kMax) return;
        ++bad;
        v = 0;
    };
    for (VertexColor& c : colours) {
        correct(c.color.r), correct(c.color.g), correct(c.color.b), correct(c.alpha);
        max_colour = std::max({max_colour, c.color.r, c.color.g, c.color.b});
        max_alpha = std::max(max_alpha, c.alpha);
    }
    const bool are_codes = max_colour > 1 || max_alpha > 1;
    const float unit = max_colour > 1 ? 255.0f : 1.0f, alpha_unit = max_alpha > 1 ? 255.0f : 1.0f;
    const auto linear = [&](float v) { return linear_of_srgb(std::min(v / unit, 1.0f)); };
    for (VertexColor& c : colours)
        c = {{linear(c.color.r), linear(c.color.g), linear(c.color.b)}, std::min(c.alpha / alpha_unit, 1.0f)};
    std::string warning;
    if (bad > 0)
        warning = std::to_string(bad) + " numbers of its vertex colours are negative or not finite, and are read as 0";
    if (are_codes)
        warning += (warning.empty() ? "" : "; ") +
                   std::string("its vertex colours exceed 1, and are read as 8-bit values up to 255");
    return warning;
}

bool are_transparent(const std::vector<VertexColor>& colours) {
    return std::any_of(colours.begin(), colours.end(), [](const VertexColor& c) { return c.alpha < 1; });
}

}  // namespace realcam::io
