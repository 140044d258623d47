#pragma once
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// sRGB transfer function (IEC 61966-2-1), from a code value of 0..255 to linear.
REALCAM_INLINE float srgb_to_linear(std::uint8_t code) {
    const float v = static_cast<float>(code) * (1.0f / 255.0f);
    return v <= 0.04045f ? v * (1.0f / 12.92f) : std::pow((v + 0.055f) * (1.0f / 1.055f), 2.4f);
}

REALCAM_INLINE Color texel(const TextureView& texture, int column, int row) {
    // Repeats: the remainder of a negative number is negative in C++.
    column = (column % texture.width + texture.width) % texture.width;
    row = (row % texture.height + texture.height) % texture.height;
    const std::int64_t at = static_cast<std::int64_t>(row) * texture.width + column;
    if (!texture.rgba) {
        const float* p = texture.linear_rgba + 4 * at;
        return {p[0], p[1], p[2]};
    }
    const std::uint8_t* p = texture.rgba + 4 * at;
    if (texture.encoding == TextureEncoding::srgb)
        return {srgb_to_linear(p[0]), srgb_to_linear(p[1]), srgb_to_linear(p[2])};
    constexpr float kStep = 1.0f / 255.0f;
    return {kStep * static_cast<float>(p[0]), kStep * static_cast<float>(p[1]), kStep * static_cast<float>(p[2])};
}

/// Bilinear lookup, linear light.
REALCAM_INLINE Color sample_texture(const TextureView& texture, Vec2f uv) {
    // Transforms may take coordinates beyond what a float holds.
    if (!(std::fabs(uv.x) + std::fabs(uv.y) < 1e30f)) uv = {0, 0};
    // Far outside 0..1 the fraction is taken first, so that the integers below cannot overflow.
    const float x = (uv.x - std::floor(uv.x)) * static_cast<float>(texture.width) - 0.5f;
    const float y = (1.0f - (uv.y - std::floor(uv.y))) * static_cast<float>(texture.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const int column = static_cast<int>(left), row = static_cast<int>(top);
    const float fx = x - left, fy = y - top;
    const Color upper = (1.0f - fx) * texel(texture, column, row) + fx * texel(texture, column + 1, row);
    const Color lower = (1.0f - fx) * texel(texture, column, row + 1) + fx * texel(texture, column + 1, row + 1);
    return (1.0f - fy) * upper + fy * lower;
}

}  // namespace REALCAM_NAMESPACE
