#pragma once
#include <cstdint>

#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Wrap mode outside 0..1: repeat the texture, clamp to the edge texels, or mirror it.
enum class TextureWrap : std::int8_t { repeat, clamp, mirror };

/// Interpolation between texel centres: bilinear, or nearest texel.
enum class TextureFilter : std::int8_t { linear, nearest };

/// Texture sampler, as in glTF.
struct TextureSampler {
    TextureWrap u = TextureWrap::repeat, v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;

    constexpr bool operator==(const TextureSampler&) const = default;
};

/// Texture with the mapping of the vertices' UV coordinates to it.
struct TextureReference {
    std::int32_t texture = -1;  ///< index in Scene::textures; -1: no texture
    /// Affine texture transform: the texture coordinates of (u, v) are dot(to_u, (u, v, 1)) and dot(to_v, (u, v, 1)),
    /// with v up in both.
    Vec3f to_u = {1, 0, 0}, to_v = {0, 1, 0};
    TextureSampler sampler = {};
    std::int8_t uv_set = 0;  ///< 0: the vertices' uvs; 1: their second_uvs

    constexpr bool operator==(const TextureReference&) const = default;
};

}  // namespace REALCAM_NAMESPACE
