#pragma once
// Materials as scene files describe them. What a renderer makes of them is decided in scene_materials.cpp alone.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "gltf_material.hpp"
#include "mtl_material.hpp"

namespace realcam::io {

/// Nothing inside: what a mesh without a material has.
struct FileMaterial {
    std::string name;
    std::variant<std::monostate, MtlMaterial, GltfMaterial> content;
    bool is_white = false;  ///< of nothing: not grey, because the colours of the vertices are the surface's own

    /// The one that colours the surface.
    FileTexture colour_texture() const {
        if (const auto* mtl = std::get_if<MtlMaterial>(&content)) return mtl->map_Kd;
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf ? gltf->colour_texture() : FileTexture{};
    }

    /// The sets of a glTF mesh's texture coordinates by which its textures lie, first those of the first texture: its
    /// vertices get them as uvs and second_uvs.
    std::vector<std::uint32_t> uv_sets() const {
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        return gltf && !gltf->uv_sets.empty() ? gltf->uv_sets : std::vector<std::uint32_t>{0};
    }
};

}  // namespace realcam::io
