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

/// Stores the mean of the colours in the alpha channel, unless alpha is not white everywhere. `white`: largest value of
/// a channel.
template <class Value>
void put_mean_into_alpha(std::vector<Value>& rgba, Value white) {
    for (std::size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] != white) return;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rgba[i + 3] = std::min(static_cast<Value>((rgba[i] + rgba[i + 1] + rgba[i + 2]) / 3), white);
}

/// Converts to linear Rec. 709. Negative results, of colours outside its gamut, become 0.
void convert(std::vector<float>& rgba, const std::array<double, 9>& rec709) {
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
            put_mean_into_alpha<std::uint8_t>(*codes, 255);
        else
            put_mean_into_alpha(std::get<std::vector<float>>(image.rgba), 1.0f);
    }
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
    if (use == TextureUse::colour && image.rec709) convert(texture.linear_rgba, *image.rec709);
    for (std::size_t i = 0; encoded && i < texture.linear_rgba.size(); ++i)
        if (i % 4 != 3) texture.linear_rgba[i] = linear_of_srgb(texture.linear_rgba[i]);
    return texture;
}

bool has_holes(const Texture& texture) {
    const auto has_less = [](const auto& rgba, auto white) {
        for (std::size_t i = 3; i < rgba.size(); i += 4)
            if (rgba[i] < white) return true;
        return false;
    };
    return has_less(texture.rgba, 255) || has_less(texture.linear_rgba, 1.0f);
}

std::string decode_vertex_colours(std::vector<VertexColor>& colours) {
    constexpr float kMost = 1e30f;
    std::size_t bad = 0;
    float largest = 0, most_opaque = 0;
    const auto usable = [&](float& v) {
        if (v >= 0 && v < kMost) return;
        ++bad;
        v = 0;
    };
    for (VertexColor& c : colours) {
        usable(c.color.r), usable(c.color.g), usable(c.color.b), usable(c.alpha);
        largest = std::max({largest, c.color.r, c.color.g, c.color.b});
        most_opaque = std::max(most_opaque, c.alpha);
    }
    const bool are_codes = largest > 1 || most_opaque > 1;
    const float unit = largest > 1 ? 255.0f : 1.0f, alpha_unit = most_opaque > 1 ? 255.0f : 1.0f;
    const auto light = [&](float v) { return linear_of_srgb(std::min(v / unit, 1.0f)); };
    for (VertexColor& c : colours)
        c = {{light(c.color.r), light(c.color.g), light(c.color.b)}, std::min(c.alpha / alpha_unit, 1.0f)};
    std::string text;
    if (bad > 0) text = std::to_string(bad) + " numbers of its vertices' colours are none from 0 on, 0 taken";
    if (are_codes)
        text += (text.empty() ? "" : "; ") +
                std::string("its vertices' colours go beyond 1: they are taken for codes up to 255");
    return text;
}

bool are_transparent(const std::vector<VertexColor>& colours) {
    return std::any_of(colours.begin(), colours.end(), [](const VertexColor& c) { return c.alpha < 1; });
}

}  // namespace realcam::io
