#pragma once
#include <cstdint>

#include "texture_transform.hpp"

namespace realcam::io {

/// A picture for a property of a material.
struct FileTexture {
    std::int32_t picture = -1;  ///< number in FileScene::pictures; -1: none
    std::uint32_t uv_set = 0;   ///< 0: FileVertices::uvs; 1: second_uvs
    TextureTransform transform;
    TextureSampler sampler = {};

    /// For a renderer, where the picture has this number in the scene.
    TextureReference reference(std::int32_t texture) const {
        TextureReference out = transform.of(texture);
        out.sampler = sampler;
        out.uv_set = static_cast<std::int8_t>(uv_set);
        return out;
    }
    /// Whether both lie alike on a surface.
    bool lies_as(const FileTexture& b) const { return transform == b.transform && sampler == b.sampler; }

    explicit operator bool() const { return picture >= 0; }
};

}  // namespace realcam::io
