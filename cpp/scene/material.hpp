#pragma once
#include <array>
#include <cstdint>

#include "../math/color.hpp"
#include "texture_reference.hpp"

namespace REALCAM_NAMESPACE {

/// Which parameters of a Material count, and what they mean.
enum class MaterialModel : std::int32_t {
    phong,               ///< Wavefront's MTL: Lambert's and Phong's lobe, mirrors, smooth glass
    metallic_roughness,  ///< glTF 2.0: GGX over a diffuse, metallic or transmitting base, under a clear coat
};

/// Whether a smooth border's reflectance grows towards grazing incidence.
enum class FresnelTerm : std::int32_t { none, physical };

/// How a surface scatters and emits light. Parameters are those of the file formats, as they are there.
struct Material {
    MaterialModel model = MaterialModel::phong;
    Color diffuse = {0.5f, 0.5f, 0.5f};  ///< phong: reflectance (MTL Kd). metallic_roughness: the base colour
    Color specular = {0, 0, 0};  ///< phong: reflectance of Phong's lobe (MTL Ks). metallic_roughness: what the
                                 ///< dielectric's reflectance is multiplied by (KHR_materials_specular)
    Color emission = {0, 0, 0};  ///< radiance in cd/m^2, on the side of the geometric normal
    std::int32_t emits_on_both_sides = 0;  ///< not 0: on the other side, too
    float opacity = 1;  ///< share of the surface that is there; through the rest rays go as if there were nothing
    float opacity_cutoff =
        0;  ///< above 0: all of the surface is there where opacity reaches this, and nothing elsewhere
    std::int32_t only_shadows = 0;  ///< not 0: invisible, but for the shadows on it (MTL's illumination model 10)
    std::int32_t vertex_opacity = 0;  ///< not 0: the alpha of the vertices' colours multiplies opacity
    std::int32_t vertex_emission =
        0;  ///< not 0: the vertices' colours multiply emission, as they do the diffuse colour
    TextureReference opacity_texture;  ///< its alpha channel multiplies opacity
    TextureReference diffuse_texture, specular_texture, emission_texture;
    float ior = 1.5f;  ///< refractive index on the inside
    float transmission = 0;  ///< share of the dielectric part that lets light through
    Color filter = {1, 1, 1};  ///< what passes is multiplied by (MTL Tf); metallic_roughness: by the base colour
    Color absorption = {0, 0, 0};  ///< inside, per metre (KHR_materials_volume)
    std::int32_t is_thin = 0;  ///< not 0: a film with nothing inside, rays go on behind it as they came

    // phong
    float shininess = 0;  ///< Phong exponent (MTL Ns)
    Color mirror = {0, 0, 0};  ///< reflectance as a mirror, at normal incidence
    FresnelTerm fresnel = FresnelTerm::physical;  ///< of mirror and transmission

    // metallic_roughness
    float metallic = 0, roughness = 1;
    float specular_weight = 1;  ///< of the dielectric's reflection, at any angle
    float clearcoat = 0, clearcoat_roughness = 0;
    TextureReference metallic_roughness_texture;  ///< roughness in green, metallic in blue, linear; phong: in green
                                                  ///< what shininess is multiplied by

    TextureReference normal_texture;  ///< tangent space, linear
    float normal_scale = 1;

    // Seldom there, and read only where the number that they multiply is not 0. Linear.
    TextureReference transmission_texture;  ///< red
    TextureReference specular_weight_texture;  ///< alpha
    TextureReference clearcoat_texture;  ///< red
    TextureReference clearcoat_roughness_texture;  ///< green
    TextureReference clearcoat_normal_texture;  ///< tangent space; without one the coat has the mesh's normals
    float clearcoat_normal_scale = 1;

    constexpr bool operator==(const Material&) const = default;

    constexpr bool emits() const { return !is_black(emission); }
    /// Lambert's and Phong's lobe on an opaque surface, emission on one side, and no textures but for diffuse.
    constexpr bool is_plain() const {
        return model == MaterialModel::phong && transmission == 0 && is_black(mirror) && normal_texture.texture < 0 &&
               specular_texture.texture < 0 && emission_texture.texture < 0 && metallic_roughness_texture.texture < 0 &&
               !has_holes() && emits_on_both_sides == 0;
    }
    /// Whether some rays that meet the surface go on as if it were not there.
    constexpr bool has_holes() const {
        return opacity < 1 || opacity_texture.texture >= 0 || only_shadows != 0 || vertex_opacity != 0;
    }
};

inline constexpr std::array<TextureReference Material::*, 11> kMaterialTextures = {
    &Material::diffuse_texture,         &Material::specular_texture,
    &Material::emission_texture,        &Material::metallic_roughness_texture,
    &Material::normal_texture,          &Material::opacity_texture,
    &Material::transmission_texture,    &Material::specular_weight_texture,
    &Material::clearcoat_texture,       &Material::clearcoat_roughness_texture,
    &Material::clearcoat_normal_texture};

/// What a scene asks of the kernels: code for more than is there would cost speed.
enum class SceneKind : std::int32_t {
    plain,  ///< Material::is_plain holds for all materials, no vertices have colours, and nothing moves
    opaque,  ///< no material has holes, and nothing moves
    any,
};

}  // namespace REALCAM_NAMESPACE
