#pragma once
#include <cstdint>

#include "texture_transform.hpp"

namespace realcam::io {

/// Texture of a material property.
struct FileTexture {
    std::int32_t picture = -1;  ///< index in FileScene::pictures, or -1
    std::uint32_t uv_set = 0;   ///< 0: FileVertices::uvs; 1: second_uvs
    TextureTransform transform;
    TextureSampler sampler = {};

    /// Returns the reference for the renderer; `texture`: index of the picture in the scene's textures.
    TextureReference reference(std::int32_t texture) const {
        TextureReference out = transform.of(texture);
        out.sampler = sampler;
        out.uv_set = static_cast<std::int8_t>(uv_set);
        return out;
    }
    /// True if both are mapped to a surface in the same way.
    bool lies_as(const FileTexture& b) const { return transform == b.transform && sampler == b.sampler; }

    explicit operator bool() const { return picture >= 0; }
};

}  // namespace realcam::io
