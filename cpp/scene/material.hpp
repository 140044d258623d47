#pragma once
#include <array>
#include <cstdint>

#include "../math/color.hpp"
#include "../math/vec3.hpp"
#include "medium.hpp"

namespace REALCAM_NAMESPACE {

// Materials, in the same form for scenes in memory and for kernels.

/// Wrap mode outside 0..1: repeat the texture, clamp to the edge texels, or mirror it.
enum class TextureWrap : std::int8_t { repeat, clamp, mirror };

/// Interpolation between texel centres: bilinear, or nearest texel.
enum class TextureFilter : std::int8_t { linear, nearest };

/// Texture sampler, as in glTF.
struct TextureSampler {
    TextureWrap u = TextureWrap::repeat, v = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;

    constexpr bool operator==(const TextureSampler&) const = default;
};

/// Texture with the mapping of the vertices' UV coordinates to it.
struct TextureReference {
    std::int32_t texture = -1;  ///< index in Scene::textures; -1: no texture
    /// Affine texture transform: the texture coordinates of (u, v) are dot(to_u, (u, v, 1)) and dot(to_v, (u, v, 1)),
    /// with v up in both.
    Vec3f to_u = {1, 0, 0}, to_v = {0, 1, 0};
    TextureSampler sampler = {};
    std::int8_t uv_set = 0;  ///< 0: the vertices' uvs; 1: their second_uvs

    constexpr bool operator==(const TextureReference&) const = default;
};

/// Material model: determines which parameters of a Material are used, and their meaning.
enum class MaterialModel : std::int32_t {
    phong,  ///< Wavefront MTL: Lambertian and Phong lobes, mirrors, smooth glass
    metallic_roughness,  ///< glTF 2.0: GGX over a diffuse, metallic or transmitting base, under a clear coat
};

/// Angular dependence of a smooth interface's reflectance: constant (none), or by the Fresnel equations (physical).
enum class FresnelTerm : std::int32_t { none, physical };

/// Scattering and emission of a surface. Parameters have the meaning and units of the file formats.
struct Material {
    MaterialModel model = MaterialModel::phong;
    Color diffuse = {0.5f, 0.5f, 0.5f};  ///< phong: reflectance (MTL Kd); metallic_roughness: base colour
    /// Phong: reflectance of the Phong lobe (MTL Ks); metallic_roughness: factor of the dielectric's reflectance
    /// (KHR_materials_specular).
    Color specular = {0, 0, 0};
    Color emission = {0, 0, 0};  ///< radiance in cd/m^2, on the side of the geometric normal
    std::int32_t emits_on_both_sides = 0;  ///< not 0: emits on both sides
    float opacity = 1;  ///< coverage of the surface, 0 to 1; rays pass unaffected through the complement
    /// Above 0: alpha test; the surface is opaque if opacity reaches this value, and absent otherwise.
    float opacity_cutoff = 0;
    /// If not 0, the material is a shadow catcher, invisible except for the shadows on it (MTL's illumination model
    /// 10).
    std::int32_t only_shadows = 0;
    std::int32_t vertex_opacity = 0;  ///< if not 0, the vertex colours' alpha multiplies opacity
    /// If not 0, vertex colours multiply emission; they always multiply the diffuse colour.
    std::int32_t vertex_emission = 0;
    TextureReference opacity_texture;  ///< its alpha channel multiplies opacity
    TextureReference diffuse_texture, specular_texture, emission_texture;
    float ior = 1.5f;  ///< refractive index of the interior
    float transmission = 0;  ///< fraction of the dielectric part that transmits light, 0 to 1
    Color filter = {1, 1, 1};  ///< factor of transmitted light (MTL Tf); metallic_roughness uses the base colour
    Color absorption = {0, 0, 0};  ///< absorption coefficient of the interior, per metre (KHR_materials_volume)
    Color scattering = {0, 0, 0};  ///< scattering coefficient of the interior, per metre
    float scattering_anisotropy = 0;  ///< Medium::anisotropy of the interior
    std::int32_t is_thin = 0;  ///< not 0: thin-walled, without an interior; transmitted rays are not refracted

    // phong
    float shininess = 0;  ///< Phong exponent (MTL Ns)
    Color mirror = {0, 0, 0};  ///< mirror reflectance at normal incidence
    FresnelTerm fresnel = FresnelTerm::physical;  ///< for mirror and transmission

    // metallic_roughness
    float metallic = 0, roughness = 1;  ///< 0 to 1; GGX alpha is the square of the roughness
    float specular_weight = 1;  ///< factor of the dielectric's reflection at any angle (KHR_materials_specular)
    float clearcoat = 0,
          clearcoat_roughness = 0;  ///< weight and roughness of the coat, 0 to 1 (KHR_materials_clearcoat)
    /// Linear; roughness in green, metallic in blue; phong: green multiplies shininess.
    TextureReference metallic_roughness_texture;

    TextureReference normal_texture;  ///< tangent space, linear
    float normal_scale = 1;  ///< factor of the normal map's x and y

    // Textures that few materials have, all linear. Each multiplies the parameter of its name by one channel and is
    // read only if that parameter is not 0.
    TextureReference transmission_texture;  ///< red
    TextureReference specular_weight_texture;  ///< alpha
    TextureReference clearcoat_texture;  ///< red
    TextureReference clearcoat_roughness_texture;  ///< green
    TextureReference clearcoat_normal_texture;  ///< tangent space; without it the coat has the mesh's normals
    float clearcoat_normal_scale = 1;

    constexpr bool operator==(const Material&) const = default;

    /// Returns the medium behind the surface; meaningful if the material transmits light and is not thin.
    constexpr Medium interior() const { return {absorption + scattering, scattering, scattering_anisotropy}; }
    /// True if the material has an interior that scatters light.
    constexpr bool has_scattering_interior() const { return transmission > 0 && is_thin == 0 && !is_black(scattering); }
    /// True if the surface emits light.
    constexpr bool emits() const { return !is_black(emission); }
    /// True for an opaque surface with Lambertian and Phong lobes and emission on one side, with no texture except for
    /// diffuse.
    constexpr bool is_plain() const {
        return model == MaterialModel::phong && transmission == 0 && is_black(mirror) && normal_texture.texture < 0 &&
               specular_texture.texture < 0 && emission_texture.texture < 0 && metallic_roughness_texture.texture < 0 &&
               !has_holes() && emits_on_both_sides == 0;
    }
    /// True if some rays pass the surface unaffected (opacity or shadow catcher).
    constexpr bool has_holes() const {
        return opacity < 1 || opacity_texture.texture >= 0 || only_shadows != 0 || vertex_opacity != 0;
    }
};

/// All texture references of a Material, as pointers to members.
inline constexpr std::array<TextureReference Material::*, 11> kMaterialTextures = {
    &Material::diffuse_texture,         &Material::specular_texture,
    &Material::emission_texture,        &Material::metallic_roughness_texture,
    &Material::normal_texture,          &Material::opacity_texture,
    &Material::transmission_texture,    &Material::specular_weight_texture,
    &Material::clearcoat_texture,       &Material::clearcoat_roughness_texture,
    &Material::clearcoat_normal_texture};

/// Features that a scene requires of the kernels; kernels are compiled for each kind, because unused features cost
/// speed.
enum class SceneKind : std::int32_t {
    plain,  ///< all materials are plain (Material::is_plain), no vertex colours, no motion, no scattering medium
    opaque,  ///< no material has holes (Material::has_holes), no motion, no scattering medium
    any,  ///< no restriction
};

}  // namespace REALCAM_NAMESPACE
