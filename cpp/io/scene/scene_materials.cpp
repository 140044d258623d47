#include "scene_textures.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../text/printable.hpp"
#include "decoded_image.hpp"

// Conversion of the materials of scene files to those of the renderer.

namespace realcam::io {
namespace {

Color color_of(Vec3f v) {
    return {v.x, v.y, v.z};
}
/// Clamps to 0..1.
Color unit_range(Vec3f v) {
    return {std::clamp(v.x, 0.0f, 1.0f), std::clamp(v.y, 0.0f, 1.0f), std::clamp(v.z, 0.0f, 1.0f)};
}

/// Returns the albedo of single scattering of a dense medium whose albedo of multiple scattering is `multiple`, 0 to 1
/// (Kulla and Conty 2017, "Revisiting physically based shading at Imageworks", slide 44). `anisotropy`: mean cosine of
/// the scattering angle.
float single_scattering_albedo(float multiple, float anisotropy) {
    if (!(multiple > 0)) return 0;  // the fit's rounded coefficients would leave 6e-6
    const double a = static_cast<double>(multiple), g = static_cast<double>(anisotropy);
    const double s = 4.09712 + 4.20863 * a - std::sqrt(9.59217 + a * (41.6808 + a * 17.7126));
    return static_cast<float>(std::clamp((1 - s * s) / (1 - g * s * s), 0.0, 1.0));
}

/// Colours of the vertices of a material's triangles: whether there are any, and whether any alpha is below 1.
struct VertexColours {
    bool exist = false, are_transparent = false;
};

/// Converts one material. Warnings go to the scene.
class MaterialMaker {
public:
    /// `label`: beginning of the warnings; `scale`: metres per unit of the file.
    MaterialMaker(Scene& scene, SceneTextures& textures, std::string label, double scale)
        : scene_(scene), textures_(textures), label_(std::move(label)), scale_(scale) {}

    /// Returns the material for the renderer.
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

    /// Converts the statements for physically based rendering (Pr, Pm, Pc, Pcr).
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
        if (from.norm) return warn("has a bump map beside a normal map (norm); only the normal map is used");
        if (const auto found = textures_.find_heights(from.bump, from.bm)) material_.normal_texture = *found;
    }

    void set_roughness_and_metallic(const FileTexture& roughness, const FileTexture& metallic) {
        if (roughness && metallic && !roughness.has_same_mapping(metallic))
            warn(
                "has maps of roughness and metallic with different transforms or samplers; those of the roughness map "
                "are used for both");
        if (const auto found = textures_.find_roughness_and_metallic(roughness, metallic))
            material_.metallic_roughness_texture = *found;
    }

    /// Sets the lobes by the format's table of illumination models. In 3 to 9 the highlights are mirror images of the
    /// lights, so that there is no Phong lobe beside the mirror.
    void set_illumination_model(const MtlMaterial& from) {
        const float transmission = 1 - from.d;
        switch (from.illum) {
            case 0: make_unlit("illum 0"), set_dissolve(from); break;
            case 1: set_dissolve(from); break;
            case 3:
            case 8: set_mirror(from, FresnelTerm::none), set_dissolve(from); break;
            case 5: set_mirror(from, FresnelTerm::physical), set_dissolve(from); break;
            case 4:
            case 9: set_mirror(from, FresnelTerm::physical), set_film(transmission, from); break;
            case 6: set_mirror(from, FresnelTerm::none), set_refraction(transmission, from); break;
            case 7: set_mirror(from, FresnelTerm::physical), set_refraction(transmission, from); break;
            case 10: material_.only_shadows = 1; break;
            default:
                material_.specular = color_of(from.Ks);
                set_specular_map(from.map_Ks);
                material_.shininess = from.Ns;
                if (from.map_Ns) set_roughness_and_metallic(from.map_Ns, {});  // stored in green, as shininess expects
                set_dissolve(from);
        }
    }

    /// Sets a mirror of reflectance Ks.
    void set_mirror(const MtlMaterial& from, FresnelTerm fresnel) {
        material_.mirror = color_of(from.Ks);
        material_.fresnel = fresnel;
        if (from.map_Ks) warn("has a map_Ks, which is supported for highlights only, not for mirrors");
    }

    /// Sets the opacity to d, the coverage of the surface. With a transmission filter the surface becomes a coloured
    /// film.
    void set_dissolve(const MtlMaterial& from) {
        if (unit_range(from.Tf) != Color{1, 1, 1}) return set_film(1 - from.d, from);
        material_.opacity = from.d;
        set_opacity_map(from.map_d, TextureUse::opacity);
    }

    void warn_of_opacity_map(const MtlMaterial& from) {
        if (from.map_d) warn("has a map_d, which is not supported for coloured films and glass");
    }

    /// Makes the surface a film that transmits light without refraction.
    void set_film(float transmission, const MtlMaterial& from) {
        warn_of_opacity_map(from);
        if (!(transmission > 0)) return;
        material_.transmission = transmission;
        material_.filter = unit_range(from.Tf);
        material_.is_thin = 1;
        if (material_.model == MaterialModel::phong) material_.ior = 1;
    }

    /// Makes the surface glass. A transmission of 0, for a file without d, stands for 1.
    void set_refraction(float transmission, const MtlMaterial& from) {
        warn_of_opacity_map(from);
        material_.transmission = transmission > 0 ? transmission : 1;
        material_.filter = unit_range(from.Tf);
        material_.ior = from.Ni.value_or(1.5f);
    }

    void from_gltf(const GltfMaterial& from) {
        material_.model = MaterialModel::metallic_roughness;
        material_.specular = {1, 1, 1};
        if (const auto& gloss = from.specular_glossiness) {
            set_color(gloss->diffuse_factor, gloss->diffuse_texture);
            set_specular_glossiness(*gloss);
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

    /// Sets opacity by the alpha mode.
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

    /// Sets the opacity texture, unless it is opaque everywhere or cannot be read.
    void set_opacity_map(const FileTexture& map, TextureUse use) {
        if (!map) return;
        const SceneTextures::Found found = textures_.find(map, use);
        const bool has_effect = has_holes(scene_.textures[static_cast<std::size_t>(found.reference.texture)]);
        if (!found.is_stand_in && has_effect) material_.opacity_texture = found.reference;
    }

    /// Makes the surface emit its colour, whatever the lighting, as a screen does. Files do not state the luminance of
    /// white, which a camera needs. `feature`: the file's feature that requires this, for the warning.
    void make_unlit(const std::string& feature) {
        constexpr float kWhite = 100;  // cd/m^2, typical of a screen
        material_.model = MaterialModel::phong;
        material_.emission = kWhite * material_.diffuse;
        material_.emission_texture = material_.diffuse_texture;
        material_.vertex_emission = colours_.exist;
        material_.emits_on_both_sides = 1;
        material_.diffuse = material_.specular = {0, 0, 0};
        material_.diffuse_texture = material_.specular_texture = {};
        material_.transmission = 0;
        warn("is unlit (" + feature + "), and emits its colour like a screen of 100 cd/m^2");
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
                "has a thickness map, which is ignored: light travels to the opposite side of the surface, at the "
                "distance of the geometry");
        material_.is_thin = from.volume.thickness_factor > 0 ? 0 : 1;
        if (!material_.is_thin) set_interior(from.volume);
    }

    void set_interior(const GltfVolume& from) {
        // KHR_materials_volume: white light has the colour attenuationColor after attenuationDistance.
        const double distance_m = static_cast<double>(from.attenuation_distance) * scale_;
        if (!std::isfinite(distance_m)) return;
        const auto extinction = [&](float transmittance) {
            const double sigma = -std::log(std::max(static_cast<double>(transmittance), 1e-10)) / distance_m;
            return static_cast<float>(std::clamp(sigma, 0.0, 1e30));
        };
        const Vec3f color = from.attenuation_color, scattered = from.multiscatter_color_factor;
        material_.scattering_anisotropy = std::clamp(from.scatter_anisotropy, -kMaxAnisotropy, kMaxAnisotropy);
        const float g = material_.scattering_anisotropy;
        const Color sum = {extinction(color.x), extinction(color.y), extinction(color.z)};
        material_.scattering =
            sum * Color{single_scattering_albedo(scattered.x, g), single_scattering_albedo(scattered.y, g),
                        single_scattering_albedo(scattered.z, g)};
        material_.absorption = sum - material_.scattering;
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

    /// Converts KHR_materials_pbrSpecularGlossiness, which has a reflectance at normal incidence instead of an index of
    /// refraction: ior 0 stands for a reflectance of 1, which `specular` scales.
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

    /// Sets the diffuse colour.
    void set_color(Vec3f factor, const FileTexture& texture) {
        material_.diffuse = color_of(factor);
        if (!texture) return;
        const SceneTextures::Found found = textures_.find(texture, TextureUse::colour);
        material_.diffuse_texture = found.reference;
        if (found.is_stand_in) material_.diffuse = {1, 1, 1};  // so that the stand-in is visible
    }

    /// Sets a texture; one that cannot be read is left out, which is as if it were white.
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

/// Returns the vertex colours of each material of the file.
std::vector<VertexColours> vertex_colours(const FileScene& file) {
    std::vector<VertexColours> of_vertices;
    for (const FileVertices& v : file.vertices) of_vertices.push_back({!v.colours.empty(), are_transparent(v.colours)});
    std::vector<VertexColours> of_materials(file.materials.size());
    for (const FileMesh& mesh : file.meshes) {
        if (!of_vertices[mesh.vertices].exist) continue;
        for (const Triangle& triangle : mesh.triangles) {
            VertexColours& colours = of_materials[triangle.material];
            colours.exist = true;
            colours.are_transparent |= of_vertices[mesh.vertices].are_transparent;
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
