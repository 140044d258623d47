#pragma once
#include <cstdint>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// A texture of a scene, and where on its picture the vertices of a surface lie.
struct TextureReference {
    std::int32_t texture = -1;  ///< number in Scene::textures; -1: none
    /// By rows, finite: (t[0] u + t[1] v + t[2], t[3] u + t[4] v + t[5]) are the coordinates in the picture of a vertex
    /// at (u, v), v upwards in both.
    float transform[6] = {1, 0, 0, 0, 1, 0};

    constexpr bool operator==(const TextureReference&) const = default;
};

}  // namespace REALCAM_NAMESPACE
