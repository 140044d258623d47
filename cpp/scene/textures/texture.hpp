#pragma once
#include <utility>

#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Texture lookups: decoding of texels, wrap modes, bilinear interpolation and mipmap levels.

namespace texture_detail {

/// sRGB transfer function (IEC 61966-2-1), from a code value of 0..255 to linear.
constexpr float linear_of_code(int code) {
    const double v = code / 255.0, base = (v + 0.055) / 1.055, square = base * base;
    // base^2.4 by Newton's method for the fifth root of base^2, because std::pow is not constexpr.
    double root = 1;
    for (int i = 0; i < 60; ++i) root -= (root - square / (root * root * root * root)) / 5;
    return static_cast<float>(v <= 0.04045 ? v / 12.92 : square * root);
}

template <int... codes>
REALCAM_INLINE float linear_by_table(std::uint8_t code, std::integer_sequence<int, codes...>) {
    // An array of floats: nvcc initialises an array of a class with a constructor to zeros.
    static constexpr float kLinear[] = {linear_of_code(codes)...};
    return kLinear[code];
}

}  // namespace texture_detail

/// Returns the linear value, 0 to 1, of an 8-bit sRGB code. Uses a table, because a bilinear lookup decodes twelve
/// values.
REALCAM_INLINE float srgb_to_linear(std::uint8_t code) {
    return texture_detail::linear_by_table(code, std::make_integer_sequence<int, 256>{});
}

/// Maps a row or column index from -1 to `count` into the texture of `count` texels: to the opposite edge if the
/// texture repeats, otherwise to the edge texel.
REALCAM_INLINE int wrapped_texel(int texel, int count, TextureWrap wrap) {
    const bool repeats = wrap == TextureWrap::repeat;
    if (texel < 0) return repeats ? texel + count : 0;
    return texel < count ? texel : repeats ? texel - count : count - 1;
}

/// Index of a texel in row-major order.
REALCAM_INLINE std::int64_t texel_index(const TextureView& texture, int column, int row) {
    return static_cast<std::int64_t>(row) * texture.width + column;
}

/// Linear colour of a texel.
REALCAM_INLINE Color texel(const TextureView& texture, int column, int row) {
    const std::int64_t index = texel_index(texture, column, row);
    if (!texture.rgba) {
        const float* p = texture.linear_rgba + 4 * index;
        return {p[0], p[1], p[2]};
    }
    const std::uint8_t* p = texture.rgba + 4 * index;
    if (texture.encoding == TextureEncoding::srgb)
        return {srgb_to_linear(p[0]), srgb_to_linear(p[1]), srgb_to_linear(p[2])};
    constexpr float kStep = 1.0f / 255.0f;
    return {kStep * static_cast<float>(p[0]), kStep * static_cast<float>(p[1]), kStep * static_cast<float>(p[2])};
}

/// Alpha of a texel, 0 to 1.
REALCAM_INLINE float texel_alpha(const TextureView& texture, int column, int row) {
    const std::int64_t index = 4 * texel_index(texture, column, row) + 3;
    return texture.rgba ? static_cast<float>(texture.rgba[index]) * (1.0f / 255.0f) : texture.linear_rgba[index];
}

/// Width or height of the next coarser mipmap level.
REALCAM_INLINE std::int32_t half_size(std::int32_t size) {
    return size > 1 ? size / 2 : 1;
}

/// Number of texels of all coarser levels.
REALCAM_INLINE std::int64_t coarse_texels(const TextureView& texture) {
    std::int64_t sum = 0;
    std::int32_t width = texture.width, height = texture.height;
    for (int i = 0; i < texture.coarse_levels; ++i) {
        width = half_size(width);
        height = half_size(height);
        sum += std::int64_t{width} * height;
    }
    return sum;
}

/// View of a single mipmap level: 0 is the texture itself; levels beyond the coarsest are clamped to it.
REALCAM_INLINE TextureView level_of(TextureView texture, int level) {
    std::int64_t offset = 0, texels = 0;  // offset: texels of the coarse levels before this one
    const int last = level < texture.coarse_levels ? level : texture.coarse_levels;
    if (last <= 0) return texture;
    for (int i = 0; i < last; ++i) {
        offset += texels;
        texture.width = half_size(texture.width);
        texture.height = half_size(texture.height);
        texels = std::int64_t{texture.width} * texture.height;
    }
    if (texture.rgba)
        texture.rgba = texture.coarse_rgba + 4 * offset;
    else
        texture.linear_rgba = texture.coarse_linear_rgba + 4 * offset;
    return texture;
}

/// The four texels around a point, with the bilinear weights.
struct BilinearTexels {
    int column, row;  ///< indices of the upper left texel
    float right, down;  ///< weights of the right column and of the lower row, 0 to 1
    int next_column, next_row;  ///< indices of the lower right texel
};

/// Maps a coordinate to 0..1 according to the wrap mode.
REALCAM_INLINE float wrapped_coordinate(float u, TextureWrap wrap) {
    if (wrap == TextureWrap::repeat) return u - std::floor(u);
    if (wrap == TextureWrap::clamp) return u < 0.0f ? 0.0f : u > 1.0f ? 1.0f : u;
    const float in_period = u - 2.0f * std::floor(0.5f * u);  // mirrored textures have a period of 2
    return in_period > 1.0f ? 2.0f - in_period : in_period;
}

/// Returns the texels around texture coordinates, which may be any numbers; for a nearest filter, weights of 0 and 1.
REALCAM_INLINE BilinearTexels bilinear_texels(const TextureView& texture, Vec2f uv, TextureSampler sampler) {
    // Texture transforms may make coordinates overflow.
    if (!(std::fabs(uv.x) + std::fabs(uv.y) < 1e30f)) uv = {0, 0};
    // The fraction is taken first, so that the integers below cannot overflow for coordinates far outside 0..1.
    const float x = wrapped_coordinate(uv.x, sampler.u) * static_cast<float>(texture.width) - 0.5f;
    const float y = (1.0f - wrapped_coordinate(uv.y, sampler.v)) * static_cast<float>(texture.height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y);
    const int column = static_cast<int>(left), row = static_cast<int>(top);
    BilinearTexels texels = {wrapped_texel(column, texture.width, sampler.u),
                             wrapped_texel(row, texture.height, sampler.v),
                             x - left,
                             y - top,
                             wrapped_texel(column + 1, texture.width, sampler.u),
                             wrapped_texel(row + 1, texture.height, sampler.v)};
    if (sampler.filter == TextureFilter::nearest) {
        texels.right = texels.right < 0.5f ? 0.0f : 1.0f;
        texels.down = texels.down < 0.5f ? 0.0f : 1.0f;
    }
    return texels;
}

/// Bilinear interpolation of texel_at(column, row), a function that returns a texel's value.
template <class TexelAt>
REALCAM_INLINE auto interpolate_texels(BilinearTexels texels, TexelAt&& texel_at) {
    const auto upper = (1.0f - texels.right) * texel_at(texels.column, texels.row) +
                       texels.right * texel_at(texels.next_column, texels.row);
    const auto lower = (1.0f - texels.right) * texel_at(texels.column, texels.next_row) +
                       texels.right * texel_at(texels.next_column, texels.next_row);
    return (1.0f - texels.down) * upper + texels.down * lower;
}

/// Bilinear lookup; returns linear values.
REALCAM_INLINE Color sample_texture(const TextureView& texture, Vec2f uv, TextureSampler sampler = {}) {
    return interpolate_texels(bilinear_texels(texture, uv, sampler),
                              [&](int column, int row) { return texel(texture, column, row); });
}

/// Bilinear lookup of the alpha channel.
REALCAM_INLINE float sample_texture_alpha(const TextureView& texture, Vec2f uv, TextureSampler sampler = {}) {
    return interpolate_texels(bilinear_texels(texture, uv, sampler),
                              [&](int column, int row) { return texel_alpha(texture, column, row); });
}

}  // namespace REALCAM_NAMESPACE
