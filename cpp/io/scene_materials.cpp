#include "scene_materials.hpp"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace realcam::io {
namespace {

std::optional<Vec3f> colour(const aiMaterial& material, const char* key, unsigned type, unsigned index) {
    aiColor4D value;
    if (material.Get(key, type, index, value) != aiReturn_SUCCESS) return std::nullopt;
    return Vec3f{value.r, value.g, value.b};
}

std::optional<float> number(const aiMaterial& material, const char* key, unsigned type, unsigned index) {
    ai_real value = 0;
    if (material.Get(key, type, index, value) != aiReturn_SUCCESS) return std::nullopt;
    return value;
}

std::optional<std::string> picture(const aiMaterial& material, aiTextureType type, unsigned index = 0) {
    aiString name;
    if (material.GetTexture(type, index, &name) != aiReturn_SUCCESS || name.length == 0) return std::nullopt;
    return std::string(name.C_Str());
}

float unit_range(float v) {
    return std::clamp(v, 0.0f, 1.0f);
}
Vec3f unit_range(Vec3f v) {
    return {unit_range(v.x), unit_range(v.y), unit_range(v.z)};
}

class MaterialReader {
public:
    MaterialReader(Scene& scene, SceneTextures& textures, const aiMaterial& from, std::string label)
        : scene_(scene), textures_(textures), from_(from), label_(std::move(label)) {}

    /// `json`: the material in a glTF file, null where the mesh has none.
    Material read(SceneFormat format, const Json& json) {
        // assimp gives meshes without a material one of its own.
        aiString name;
        from_.Get(AI_MATKEY_NAME, name);
        if (format == SceneFormat::gltf ? json.is_null() : name == aiString(AI_DEFAULT_MATERIAL_NAME)) return material_;
        if (const auto c = colour(from_, AI_MATKEY_COLOR_DIFFUSE)) material_.diffuse = *c;
        read_texture();
        if (format == SceneFormat::obj) {
            if (const auto c = colour(from_, AI_MATKEY_COLOR_SPECULAR)) material_.specular = *c;
            if (const auto n = number(from_, AI_MATKEY_SHININESS)) material_.shininess = *n;
        } else if (const auto glossiness = number(from_, AI_MATKEY_GLOSSINESS_FACTOR)) {
            from_specular_glossiness(*glossiness);
        } else {
            from_metallic_roughness(number(from_, AI_MATKEY_METALLIC_FACTOR).value_or(1.0f),
                                    number(from_, AI_MATKEY_ROUGHNESS_FACTOR).value_or(1.0f));
        }
        read_emission(json);
        if (number(from_, AI_MATKEY_OPACITY).value_or(1.0f) < 1.0f) warn("is transparent; it is shown opaque");
        return material_;
    }

private:
    void warn(const std::string& text) { scene_.warnings.push_back(label_ + " " + text); }

    void read_texture() {
        const auto name = picture(from_, aiTextureType_DIFFUSE);
        if (!name) return;
        const SceneTextures::Found found = textures_.find(*name);
        material_.diffuse_texture = found.index;
        if (found.stand_in) {
            material_.diffuse = {1, 1, 1};  // it has to be seen
        } else {
            colour_map_ = *name;
        }
    }

    // The glTF model, with its Fresnel term at normal incidence and a Phong lobe in place of GGX:
    //     specular = 0.04 (1 - metallic) + base metallic,    diffuse = base (1 - metallic) (1 - 0.04).
    // For base <= 1 the sum is at most 1. A Material has one number for the whole surface where glTF may have a map:
    // maps of metallic and roughness count by their mean, and so does a base-colour texture in the metal's highlight.
    void from_metallic_roughness(float metallic, float roughness) {
        if (const auto map = picture(from_, AI_MATKEY_GLTF_PBRMETALLICROUGHNESS_METALLICROUGHNESS_TEXTURE)) {
            if (const auto mean = textures_.mean_value(*map)) {
                roughness *= mean->y;
                metallic *= mean->z;
            }
        }
        metallic = unit_range(metallic);
        const Vec3f base = unit_range(material_.diffuse);
        Vec3f metal = base;
        if (!colour_map_.empty() && metallic > 0) {
            if (const auto mean = textures_.mean_colour(colour_map_)) metal = *mean * base;
        }
        constexpr float dielectric = 0.04f;
        const float plain = dielectric * (1 - metallic);
        material_.specular = Vec3f{plain, plain, plain} + metallic * metal;
        material_.diffuse = ((1 - metallic) * (1 - dielectric)) * base;
        material_.shininess = phong_exponent(roughness);
    }

    // KHR_materials_pbrSpecularGlossiness: diffuse is weakened by the strongest channel of specular.
    void from_specular_glossiness(float glossiness) {
        const Vec3f specular = unit_range(colour(from_, AI_MATKEY_COLOR_SPECULAR).value_or(Vec3f{1, 1, 1}));
        const float rest = 1 - std::max({specular.x, specular.y, specular.z});
        material_.diffuse = rest * unit_range(material_.diffuse);
        material_.specular = specular;
        material_.shininess = phong_exponent(1 - unit_range(glossiness));
    }

    void read_emission(const Json& json) {
        const auto factor = colour(from_, AI_MATKEY_COLOR_EMISSIVE);
        if (!factor) return;
        // Not every version of assimp tells the strength.
        const Json& strength = json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
        material_.emission = static_cast<float>(strength.number(1)) * *factor;
        const Vec3f e = material_.emission;
        if (!(e.x > 0 || e.y > 0 || e.z > 0)) return;
        if (const auto map = picture(from_, aiTextureType_EMISSIVE)) {
            if (const auto mean = textures_.mean_colour(*map)) material_.emission = e * *mean;
            warn("shines by the mean of its emissive map");
        }
    }

    Scene& scene_;
    SceneTextures& textures_;
    const aiMaterial& from_;
    std::string label_;
    std::string colour_map_;  // empty: none
    Material material_;
};

}  // namespace

// A Phong lobe of exponent n is as wide as a Blinn-Phong lobe of 4 n, and that one as a microfacet lobe with
// alpha^2 = 2 / (4 n + 2); glTF has alpha = roughness^2.
float phong_exponent(float roughness) {
    const float alpha = std::max(unit_range(roughness), 0.01f) * unit_range(roughness);
    const float alpha_squared = std::max(alpha * alpha, 1e-8f);
    return std::clamp((2.0f / alpha_squared - 2.0f) / 4.0f, 0.0f, 20000.0f);
}

void read_materials(Scene& scene, const ImportedScene& file, SceneTextures& textures, const std::string& path) {
    const aiScene& content = file.content();
    std::vector<bool> used(content.mNumMaterials, false);
    for (unsigned m = 0; m < content.mNumMeshes; ++m) used[content.mMeshes[m]->mMaterialIndex] = true;

    const Json no_json;
    scene.materials.assign(content.mNumMaterials, Material{});
    scene.material_names.assign(content.mNumMaterials, {});
    for (unsigned i = 0; i < content.mNumMaterials; ++i) {
        if (!used[i]) continue;  // its textures need not exist
        const aiMaterial& from = *content.mMaterials[i];
        aiString name;
        from.Get(AI_MATKEY_NAME, name);
        if (name != aiString(AI_DEFAULT_MATERIAL_NAME)) scene.material_names[i] = name.C_Str();
        std::string label = path + ": material " + std::to_string(i);
        if (name.length > 0) label += " \"" + std::string(name.C_Str()) + "\"";
        scene.materials[i] = MaterialReader(scene, textures, from, label)
                                 .read(file.format(), file.gltf() ? file.gltf()->material(i) : no_json);
    }
}

}  // namespace realcam::io
