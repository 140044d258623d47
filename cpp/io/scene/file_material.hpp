#pragma once
// Materials as described in scene files. Only scene_materials.cpp decides how they are rendered.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "gltf_material.hpp"
#include "mtl_material.hpp"

namespace realcam::io {

/// Material of a scene file. Without content it is the default for meshes without a material.
struct FileMaterial {
    std::string name;
    std::variant<std::monostate, MtlMaterial, GltfMaterial> content;
    /// Without content: white instead of grey, because the vertex colours are the surface's colours.
    bool is_white = false;

    /// Returns the texture of the surface's colour.
    FileTexture colour_texture() const {
        if (const auto* mtl = std::get_if<MtlMaterial>(&content)) return mtl->map_Kd;
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf ? gltf->colour_texture() : FileTexture{};
    }

    /// Returns the texture coordinate sets of a glTF mesh that the textures use, that of the first texture first: its
    /// vertices get them as uvs and second_uvs.
    std::vector<std::uint32_t> uv_sets() const {
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf && !gltf->uv_sets.empty() ? gltf->uv_sets : std::vector<std::uint32_t>{0};
    }
};

}  // namespace realcam::io
