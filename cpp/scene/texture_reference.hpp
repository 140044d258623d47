#pragma once
#include <cstdint>

#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// What is seen of a picture beyond its edges: it again, its outermost texels, or its mirror image.
enum class TextureWrap : std::int8_t { repeat, clamp, mirror };

/// What is seen between the middles of texels: what lies between them, or the nearest.
enum class TextureFilter : std::int8_t { linear, nearest };

/// How a picture is looked up: what glTF calls a sampler.
struct TextureSampler {
    TextureWrap u = TextureWrap::repeat, v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;

    constexpr bool operator==(const TextureSampler&) const = default;
};

/// A texture of a scene, and where on its picture the vertices of a surface lie.
struct TextureReference {
    std::int32_t texture = -1;  ///< number in Scene::textures; -1: none
    /// The coordinates in the picture of a vertex at (u, v) are the dot products with (u, v, 1), v upwards in both.
    Vec3f to_u = {1, 0, 0}, to_v = {0, 1, 0};
    TextureSampler sampler = {};
    std::int8_t uv_set = 0;  ///< 0: the vertices' uvs; 1: their second_uvs

    constexpr bool operator==(const TextureReference&) const = default;
};

}  // namespace REALCAM_NAMESPACE
