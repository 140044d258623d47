#pragma once
#include <cstdint>

#include "texture_transform.hpp"

namespace realcam::io {

/// A picture for a property of a material.
struct FileTexture {
    std::int32_t picture = -1;  ///< number in FileScene::pictures; -1: none
    std::uint32_t uv_set = 0;   ///< of a glTF mesh
    TextureTransform transform;

    explicit operator bool() const { return picture >= 0; }
};

}  // namespace realcam::io
