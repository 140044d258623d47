#include "scene_materials.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "printable.hpp"

namespace realcam::io {
namespace {

float unit_range(float v) {
    return std::clamp(v, 0.0f, 1.0f);
}
Vec3f unit_range(Vec3f v) {
    return {unit_range(v.x), unit_range(v.y), unit_range(v.z)};
}
bool emits(Vec3f e) {
    return e.x > 0 || e.y > 0 || e.z > 0;
}

class MaterialMaker {
public:
    MaterialMaker(Scene& scene, SceneTextures& textures, std::string label)
        : scene_(scene), textures_(textures), label_(std::move(label)) {}

    Material make(const FileMaterial& from) {
        if (const auto* mtl = std::get_if<MtlMaterial>(&from.content)) from_mtl(*mtl);
        if (const auto* gltf = std::get_if<GltfMaterial>(&from.content)) from_gltf(*gltf);
        return material_;
    }

private:
    void warn(const std::string& text) { scene_.warnings.push_back(label_ + " " + text); }

    void from_mtl(const MtlMaterial& from) {
        set_colour(from.Kd, from.map_Kd);
        material_.specular = from.Ks;
        material_.shininess = from.Ns;
        set_emission(from.Ke, from.map_Ke);
        if (from.d < 1) warn("is transparent; it is shown opaque");
    }

    void from_gltf(const GltfMaterial& from) {
        float alpha = from.alpha;
        if (const auto& older = from.specular_glossiness) {
            set_colour(older->diffuse_factor, older->diffuse_texture);
            set_specular_glossiness(*older);
            alpha = older->alpha;
        } else {
            set_colour(from.base_color_factor, from.base_color_texture);
            set_metallic_roughness(from);
        }
        set_emission(from.emissive_strength * from.emissive_factor, from.emissive_texture);
        if (alpha < 1 && from.alpha_mode != AlphaMode::opaque) warn("is transparent; it is shown opaque");
    }

    void set_colour(Vec3f factor, const FileTexture& texture) {
        material_.diffuse = factor;
        if (!texture) return;
        const SceneTextures::Found found = textures_.find(texture);
        material_.diffuse_texture = found.reference.texture;
        if (found.is_stand_in)
            material_.diffuse = {1, 1, 1};  // it has to be seen
        else
            colour_map_ = texture;
    }

    // The glTF model, with its Fresnel term at normal incidence and a Phong lobe in place of GGX:
    //     specular = 0.04 (1 - metallic) + base metallic,    diffuse = base (1 - metallic) (1 - 0.04).
    // For base <= 1 the sum is at most 1. A Material has one number for the whole surface where glTF may have a map:
    // maps of metallic and roughness count by their mean, and so does a base-colour texture in the metal's highlight.
    void set_metallic_roughness(const GltfMaterial& from) {
        float metallic = from.metallic_factor, roughness = from.roughness_factor;
        if (from.metallic_roughness_texture) {
            if (const auto mean = textures_.mean_value(from.metallic_roughness_texture.picture)) {
                roughness *= mean->y;
                metallic *= mean->z;
            }
        }
        metallic = unit_range(metallic);
        const Vec3f base = unit_range(material_.diffuse);
        Vec3f metal = base;
        if (colour_map_ && metallic > 0) {
            if (const auto mean = textures_.mean_colour(colour_map_.picture)) metal = unit_range(*mean) * base;
        }
        constexpr float dielectric = 0.04f;
        const float plain = dielectric * (1 - metallic);
        material_.specular = Vec3f{plain, plain, plain} + metallic * metal;
        material_.diffuse = ((1 - metallic) * (1 - dielectric)) * base;
        material_.shininess = phong_exponent(roughness);
    }

    // Diffuse is weakened by the strongest channel of specular.
    void set_specular_glossiness(const GltfSpecularGlossiness& from) {
        const Vec3f specular = unit_range(from.specular_factor);
        const float rest = 1 - std::max({specular.x, specular.y, specular.z});
        material_.diffuse = rest * unit_range(material_.diffuse);
        material_.specular = specular;
        material_.shininess = phong_exponent(1 - unit_range(from.glossiness_factor));
    }

    void set_emission(Vec3f emission, const FileTexture& map) {
        material_.emission = emission;
        if (!map || !emits(emission)) return;
        if (const auto mean = textures_.mean_colour(map.picture)) material_.emission = emission * *mean;
        warn("emits by the mean of its emissive map");
    }

    Scene& scene_;
    SceneTextures& textures_;
    std::string label_;
    FileTexture colour_map_;  // unless it is a stand-in
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

void make_materials(Scene& scene, const FileScene& file, SceneTextures& textures) {
    std::vector<bool> is_used(file.materials.size(), false);
    for (const FileMesh& mesh : file.meshes)
        for (const Triangle& triangle : mesh.triangles) is_used[triangle.material] = true;
    scene.materials.assign(file.materials.size(), Material{});
    scene.material_names.assign(file.materials.size(), {});
    for (std::size_t i = 0; i < file.materials.size(); ++i) {
        if (!is_used[i]) continue;  // its textures need not exist
        const std::string& name = file.materials[i].name;
        scene.material_names[i] = printable(name);
        const std::string label =
            file.path + ": material " + std::to_string(i) + (name.empty() ? "" : ' ' + in_quotes(name));
        scene.materials[i] = MaterialMaker(scene, textures, label).make(file.materials[i]);
    }
}

}  // namespace realcam::io
