#pragma once
// Materials as scene files describe them. What a renderer makes of them is decided in scene_materials.cpp alone.

#include <optional>
#include <string>
#include <variant>

#include "../math/vec3.hpp"
#include "file_texture.hpp"
#include "mtl_material.hpp"

namespace realcam::io {

/// KHR_materials_pbrSpecularGlossiness.
struct GltfSpecularGlossiness {
    Vec3f diffuse_factor = {1, 1, 1}, specular_factor = {1, 1, 1};
    float glossiness_factor = 1, alpha = 1;
    FileTexture diffuse_texture;
};

struct GltfMaterial {
    Vec3f base_color_factor = {1, 1, 1};
    float alpha = 1, metallic_factor = 1, roughness_factor = 1, emissive_strength = 1;
    Vec3f emissive_factor = {0, 0, 0};
    FileTexture base_color_texture, metallic_roughness_texture, emissive_texture;
    std::string alpha_mode = "OPAQUE";
    std::optional<GltfSpecularGlossiness> specular_glossiness;
};

/// Nothing inside: what a mesh without a material has.
struct FileMaterial {
    std::string name;
    std::variant<std::monostate, MtlMaterial, GltfMaterial> content;

    /// The one that colours the surface.
    FileTexture colour_texture() const {
        if (const auto* mtl = std::get_if<MtlMaterial>(&content)) return mtl->map_Kd;
        const auto* gltf = std::get_if<GltfMaterial>(&content);
        if (!gltf) return {};
        return gltf->specular_glossiness ? gltf->specular_glossiness->diffuse_texture : gltf->base_color_texture;
    }
};

}  // namespace realcam::io
