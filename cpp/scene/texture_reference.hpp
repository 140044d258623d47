#pragma once
#include <cstdint>

#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// A texture of a scene, and where on its picture the vertices of a surface lie.
struct TextureReference {
    std::int32_t texture = -1;  ///< number in Scene::textures; -1: none
    /// The coordinates in the picture of a vertex at (u, v) are the dot products with (u, v, 1), v upwards in both.
    Vec3f to_u = {1, 0, 0}, to_v = {0, 1, 0};

    constexpr bool operator==(const TextureReference&) const = default;
};

}  // namespace REALCAM_NAMESPACE
