#include "scene_textures.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../text/printable.hpp"
#include "decoded_image.hpp"

namespace realcam::io {
namespace {

Color color_of(Vec3f v) {
    return {v.x, v.y, v.z};
}
Color unit_range(Vec3f v) {
    return {std::clamp(v.x, 0.0f, 1.0f), std::clamp(v.y, 0.0f, 1.0f), std::clamp(v.z, 0.0f, 1.0f)};
}

/// Colours of the vertices of a material's triangles.
struct VertexColours {
    bool exist = false, are_transparent = false;
};

class MaterialMaker {
public:
    /// `scale`: metres per unit of the file.
    MaterialMaker(Scene& scene, SceneTextures& textures, std::string label, double scale)
        : scene_(scene), textures_(textures), label_(std::move(label)), scale_(scale) {}

    Material make(const FileMaterial& from, const VertexColours& colours) {
        colours_ = colours;
        if (from.is_white) material_.diffuse = {1, 1, 1};
        if (const auto* mtl = std::get_if<MtlMaterial>(&from.content)) from_mtl(*mtl);
        const auto* gltf = std::get_if<GltfMaterial>(&from.content);
        if (gltf) from_gltf(*gltf);
        if (!gltf && colours_.are_transparent) material_.vertex_opacity = 1;
        return material_;
    }

private:
    void warn(const std::string& text) { scene_.warnings.push_back(label_ + " " + text); }

    void from_mtl(const MtlMaterial& from) {
        set_color(from.Kd, from.map_Kd);
        set_emission(color_of(from.Ke), from.map_Ke);
        set_normal_map(from.norm, 1);
        set_bump_map(from);
        if (from.Pr || from.Pm) {
            set_mtl_metallic_roughness(from);
        } else {
            set_illumination_model(from);
        }
    }

    void set_mtl_metallic_roughness(const MtlMaterial& from) {
        material_.model = MaterialModel::metallic_roughness;
        material_.specular = {1, 1, 1};
        material_.roughness = from.Pr.value_or(1);
        material_.metallic = from.Pm.value_or(0);
        material_.clearcoat = from.Pc;
        material_.clearcoat_roughness = from.Pcr;
        material_.ior = from.Ni.value_or(1.5f);
        if (from.map_Pr || from.map_Pm) set_roughness_and_metallic(from.map_Pr, from.map_Pm);
        set_dissolve(from);
    }

    /// Converts the bump map; heights are in texels, times -bm. A normal map takes precedence, because it is more
    /// exact.
    void set_bump_map(const MtlMaterial& from) {
        if (!from.bump || from.bm == 0) return;
        if (from.norm) return warn("has a bump map beside a normal map (norm), which alone counts");
        if (const auto found = textures_.find_heights(from.bump, from.bm)) material_.normal_texture = *found;
    }

    void set_roughness_and_metallic(const FileTexture& roughness, const FileTexture& metallic) {
        if (roughness && metallic && !roughness.lies_as(metallic))
            warn(
                "has maps of roughness and metallic that lie differently on the surface; both lie as that of "
                "roughness");
        if (const auto found = textures_.find_roughness_and_metallic(roughness, metallic))
            material_.metallic_roughness_texture = *found;
    }

    // Follows the format's table of illumination models. In 3 to 9 the highlights are mirror images of the lights, so
    // that there is no Phong lobe beside the mirror.
    void set_illumination_model(const MtlMaterial& from) {
        const float passing = 1 - from.d;
        switch (from.illum) {
            case 0: make_unlit("illum 0"), set_dissolve(from); break;
            case 1: set_dissolve(from); break;
            case 3:
            case 8: set_mirror(from, FresnelTerm::none), set_dissolve(from); break;
            case 5: set_mirror(from, FresnelTerm::physical), set_dissolve(from); break;
            case 4:
            case 9: set_mirror(from, FresnelTerm::physical), set_film(passing, from); break;
            case 6: set_mirror(from, FresnelTerm::none), set_refraction(passing, from); break;
            case 7: set_mirror(from, FresnelTerm::physical), set_refraction(passing, from); break;
            case 10: material_.only_shadows = 1; break;
            default:
                material_.specular = color_of(from.Ks);
                set_specular_map(from.map_Ks);
                material_.shininess = from.Ns;
                if (from.map_Ns) set_roughness_and_metallic(from.map_Ns, {});  // stored in green, as shininess expects
                set_dissolve(from);
        }
    }

    void set_mirror(const MtlMaterial& from, FresnelTerm fresnel) {
        material_.mirror = color_of(from.Ks);
        material_.fresnel = fresnel;
        if (from.map_Ks) warn("has a map of Ks, which is modelled for highlights only");
    }

    /// Applies d, the coverage of the surface. With a transmission filter it becomes a coloured film.
    void set_dissolve(const MtlMaterial& from) {
        if (unit_range(from.Tf) != Color{1, 1, 1}) return set_film(1 - from.d, from);
        material_.opacity = from.d;
        set_opacity_map(from.map_d, TextureUse::opacity);
    }

    /// Makes a surface that transmits light without refraction.
    void set_film(float share, const MtlMaterial& from) {
        if (from.map_d) warn("has a map_d, which is not modelled for what lets light through coloured or as glass");
        if (!(share > 0)) return;
        material_.transmission = share;
        material_.filter = unit_range(from.Tf);
        material_.is_thin = 1;
        if (material_.model == MaterialModel::phong) material_.ior = 1;
    }

    void set_refraction(float share, const MtlMaterial& from) {
        if (from.map_d) warn("has a map_d, which is not modelled for what lets light through coloured or as glass");
        material_.transmission = share > 0 ? share : 1;
        material_.filter = unit_range(from.Tf);
        material_.ior = from.Ni.value_or(1.5f);
    }

    void from_gltf(const GltfMaterial& from) {
        material_.model = MaterialModel::metallic_roughness;
        material_.specular = {1, 1, 1};
        if (const auto& older = from.specular_glossiness) {
            set_color(older->diffuse_factor, older->diffuse_texture);
            set_specular_glossiness(*older);
        } else {
            set_color(from.base_color_factor, from.base_color_texture);
            set_metallic_roughness(from);
        }
        set_normal_map(from.normal_texture, from.normal_scale);
        set_emission(from.emissive_strength * color_of(from.emissive_factor), from.emissive_texture);
        material_.emits_on_both_sides = from.double_sided;
        set_clearcoat(from.clearcoat);
        set_alpha(from);
        if (from.unlit) make_unlit("KHR_materials_unlit");
    }

    void set_alpha(const GltfMaterial& from) {
        if (from.alpha_mode == AlphaMode::opaque) return;
        material_.vertex_opacity = colours_.are_transparent;
        material_.opacity = from.specular_glossiness ? from.specular_glossiness->alpha : from.alpha;
        set_opacity_map(from.colour_texture(), TextureUse::colour);
        // With a cutoff of 0 everything is opaque.
        if (from.alpha_mode == AlphaMode::mask && !(from.alpha_cutoff > 0)) {
            material_.opacity = 1;
            material_.opacity_texture = {};
            material_.vertex_opacity = 0;
        } else if (from.alpha_mode == AlphaMode::mask) {
            material_.opacity_cutoff = std::min(from.alpha_cutoff, 1.0f);
            if (from.alpha_cutoff > 1) material_.opacity = 0;
        }
    }

    void set_opacity_map(const FileTexture& map, TextureUse use) {
        if (!map) return;
        const SceneTextures::Found found = textures_.find(map, use);
        const bool says_something = has_holes(scene_.textures[static_cast<std::size_t>(found.reference.texture)]);
        if (!found.is_stand_in && says_something) material_.opacity_texture = found.reference;
    }

    /// Makes the surface emit its colour independent of lighting, as a screen does; a camera needs the luminance of
    /// white for this.
    void make_unlit(const std::string& why) {
        constexpr float kWhite = 100;  // cd/m^2, typical of a screen
        material_.model = MaterialModel::phong;
        material_.emission = kWhite * material_.diffuse;
        material_.emission_texture = material_.diffuse_texture;
        material_.vertex_emission = colours_.exist;
        material_.emits_on_both_sides = 1;
        material_.diffuse = material_.specular = {0, 0, 0};
        material_.diffuse_texture = material_.specular_texture = {};
        material_.transmission = 0;
        warn("is unlit (" + why + "): its colour is shown as a screen of 100 cd/m^2 shows it");
    }

    void set_metallic_roughness(const GltfMaterial& from) {
        material_.metallic = from.metallic_factor;
        material_.roughness = from.roughness_factor;
        set_map(&Material::metallic_roughness_texture, from.metallic_roughness_texture, TextureUse::data);
        material_.ior = from.ior;
        material_.specular = color_of(from.specular.color_factor);
        material_.specular_weight = from.specular.factor;
        set_specular_map(from.specular.color_texture);
        set_map(&Material::specular_weight_texture, from.specular.texture, TextureUse::data);
        set_gltf_transmission(from);
    }

    void set_gltf_transmission(const GltfMaterial& from) {
        if (!(from.transmission.factor > 0)) return;
        material_.transmission = from.transmission.factor;
        set_map(&Material::transmission_texture, from.transmission.texture, TextureUse::data);
        if (from.volume.thickness_texture)
            warn(
                "has a map of its thickness, which the surface itself says here: light goes as far as to its other "
                "side");
        material_.is_thin = from.volume.thickness_factor > 0 ? 0 : 1;
        // KHR_materials_volume: attenuation_color is what is left of white light after attenuationDistance.
        const double distance_m = static_cast<double>(from.volume.attenuation_distance) * scale_;
        const auto absorption = [&](float left) {
            const double sigma = -std::log(std::max(static_cast<double>(left), 1e-10)) / distance_m;
            return static_cast<float>(std::clamp(sigma, 0.0, 1e30));
        };
        const Vec3f left = from.volume.attenuation_color;
        if (std::isfinite(distance_m) && !material_.is_thin)
            material_.absorption = {absorption(left.x), absorption(left.y), absorption(left.z)};
    }

    void set_clearcoat(const GltfClearcoat& from) {
        material_.clearcoat = from.factor;
        material_.clearcoat_roughness = from.roughness_factor;
        if (!(from.factor > 0)) return;
        set_map(&Material::clearcoat_texture, from.texture, TextureUse::data);
        set_map(&Material::clearcoat_roughness_texture, from.roughness_texture, TextureUse::data);
        set_map(&Material::clearcoat_normal_texture, from.normal_texture, TextureUse::data);
        material_.clearcoat_normal_scale = from.normal_scale;
    }

    // Uses reflectances at normal incidence instead of an index of refraction: ior 0 stands for a reflectance of 1,
    // which `specular` scales.
    void set_specular_glossiness(const GltfSpecularGlossiness& from) {
        material_.metallic = 0;
        material_.roughness = 1 - from.glossiness_factor;
        material_.ior = 0;
        material_.specular = unit_range(from.specular_factor);
        if (!from.specular_glossiness_texture) return;
        set_specular_map(from.specular_glossiness_texture);
        const auto found = textures_.find_glossiness(from.specular_glossiness_texture, from.glossiness_factor);
        if (!found) return;
        material_.metallic_roughness_texture = *found;
        material_.roughness = 1;
    }

    void set_color(Vec3f factor, const FileTexture& texture) {
        material_.diffuse = color_of(factor);
        if (!texture) return;
        const SceneTextures::Found found = textures_.find(texture, TextureUse::colour);
        material_.diffuse_texture = found.reference;
        if (found.is_stand_in) material_.diffuse = {1, 1, 1};  // so that the stand-in is visible
    }

    /// Sets a texture; one that cannot be read counts as white.
    void set_map(TextureReference Material::* member, const FileTexture& map, TextureUse use) {
        if (!map) return;
        const SceneTextures::Found found = textures_.find(map, use);
        if (!found.is_stand_in) material_.*member = found.reference;
    }

    void set_specular_map(const FileTexture& map) { set_map(&Material::specular_texture, map, TextureUse::colour); }

    void set_normal_map(const FileTexture& map, float scale) {
        set_map(&Material::normal_texture, map, TextureUse::data);
        if (material_.normal_texture.texture >= 0) material_.normal_scale = scale;
    }

    void set_emission(Color emission, const FileTexture& map) {
        material_.emission = emission;
        if (!is_black(emission)) set_map(&Material::emission_texture, map, TextureUse::colour);
    }

    Scene& scene_;
    SceneTextures& textures_;
    std::string label_;
    double scale_;
    VertexColours colours_;
    Material material_;
};

std::vector<VertexColours> vertex_colours(const FileScene& file) {
    std::vector<VertexColours> of_vertices;
    for (const FileVertices& v : file.vertices) of_vertices.push_back({!v.colours.empty(), are_transparent(v.colours)});
    std::vector<VertexColours> of_materials(file.materials.size());
    for (const FileMesh& mesh : file.meshes) {
        if (!of_vertices[mesh.vertices].exist) continue;
        for (const Triangle& triangle : mesh.triangles) {
            VertexColours& all = of_materials[triangle.material];
            all.exist = true;
            all.are_transparent |= of_vertices[mesh.vertices].are_transparent;
        }
    }
    return of_materials;
}

}  // namespace

void make_materials(Scene& scene, const FileScene& file, double scale, SceneTextures& textures) {
    std::vector<bool> is_used(file.materials.size(), false);
    for (const FileMesh& mesh : file.meshes)
        for (const Triangle& triangle : mesh.triangles) is_used[triangle.material] = true;
    const std::vector<VertexColours> colours = vertex_colours(file);
    scene.materials.assign(file.materials.size(), Material{});
    scene.material_names.assign(file.materials.size(), {});
    for (std::size_t i = 0; i < file.materials.size(); ++i) {
        if (!is_used[i]) continue;  // its textures may be missing
        const std::string& name = file.materials[i].name;
        scene.material_names[i] = printable(name);
        const std::string label =
            file.path + ": material " + std::to_string(i) + (name.empty() ? "" : ' ' + in_quotes(name));
        scene.materials[i] = MaterialMaker(scene, textures, label, scale).make(file.materials[i], colours[i]);
    }
}

}  // namespace realcam::io
