#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "../../math/vec3.hpp"
#include "texture_transform.hpp"

namespace realcam::io {

// Members have the names of glTF 2.0 and its extensions, and their default values, with which an extension changes
// nothing. Numbers lie in the ranges of the format. A texture multiplies the factor of its name; it holds numbers if
// the comment names a channel, directions if it is a normal map, and otherwise colours.

/// KHR_materials_pbrSpecularGlossiness.
struct GltfSpecularGlossiness {
    Vec3f diffuse_factor = {1, 1, 1}, specular_factor = {1, 1, 1};
    float glossiness_factor = 1, alpha = 1;
    FileTexture diffuse_texture;  ///< alpha is coverage
    FileTexture specular_glossiness_texture;  ///< alpha is glossiness
};

/// KHR_materials_transmission.
struct GltfTransmission {
    float factor = 0;
    FileTexture texture;  ///< red
};

/// KHR_materials_volume and KHR_materials_volume_scatter. Lengths are in units of the file.
struct GltfVolume {
    float thickness_factor = 0;  ///< in the mesh's coordinates; 0: thin-walled, without interior
    FileTexture thickness_texture;  ///< green
    float attenuation_distance = std::numeric_limits<float>::infinity();  ///< in the scene's coordinates, above 0
    Vec3f attenuation_color = {1, 1, 1};  ///< colour of white light after that distance
    Vec3f multiscatter_color_factor = {0, 0, 0};  ///< albedo of multiple scattering
    float scatter_anisotropy = 0;  ///< mean cosine of the scattering angle, -1 to 1
};

/// KHR_materials_clearcoat.
struct GltfClearcoat {
    float factor = 0, roughness_factor = 0;
    FileTexture texture;  ///< red
    FileTexture roughness_texture;  ///< green
    FileTexture normal_texture;
    float normal_scale = 1;
};

/// KHR_materials_specular.
struct GltfSpecular {
    float factor = 1;
    Vec3f color_factor = {1, 1, 1};  ///< can be above 1
    FileTexture texture;  ///< alpha
    FileTexture color_texture;
};

/// Meaning of alpha: ignored (opaque), an alpha test against alpha_cutoff (mask), or coverage (blend).
enum class AlphaMode { opaque, mask, blend };

/// Material of a glTF file.
struct GltfMaterial {
    Vec3f base_color_factor = {1, 1, 1};
    float alpha = 1;  ///< fourth number of baseColorFactor
    float metallic_factor = 1, roughness_factor = 1;
    FileTexture base_color_texture;  ///< alpha is coverage
    FileTexture metallic_roughness_texture;  ///< roughness in green, metallic in blue

    FileTexture normal_texture;
    float normal_scale = 1;
    FileTexture occlusion_texture;  ///< red; not needed by a path tracer
    float occlusion_strength = 1;
    Vec3f emissive_factor = {0, 0, 0};  ///< any number: emission is checked with the lights of all formats
    FileTexture emissive_texture;
    float emissive_strength = 1;  ///< KHR_materials_emissive_strength; any number

    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;  ///< threshold for AlphaMode::mask
    bool double_sided = false;  ///< here only of effect on emission, which is then on both sides

    float ior = 1.5f;  ///< KHR_materials_ior: at least 1, or 0 for a reflectance given by `specular` alone
    bool unlit = false;  ///< KHR_materials_unlit
    GltfTransmission transmission;
    GltfVolume volume;
    GltfClearcoat clearcoat;
    GltfSpecular specular;
    std::optional<GltfSpecularGlossiness> specular_glossiness;  ///< replaces base colour, metallic and roughness

    /// Returns the texture of the surface's colour.
    FileTexture colour_texture() const {
        return specular_glossiness ? specular_glossiness->diffuse_texture : base_color_texture;
    }
    std::vector<std::uint32_t> uv_sets;  ///< n of TEXCOORD_n, indexed by FileTexture::uv_set: at most two

    /// Returns the textures that exist and have an effect, the colour texture first: all but the occlusion texture and
    /// the textures of the reflection model that is not used.
    std::vector<const FileTexture*> textures() const;
    std::vector<FileTexture*> textures();
};

}  // namespace realcam::io
