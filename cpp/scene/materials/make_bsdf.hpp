#pragma once
#include "../geometry/surface_point.hpp"
#include "bsdf.hpp"
#include "plain_bsdf.hpp"

namespace REALCAM_NAMESPACE {

// Conversion of a surface point's material parameters to a BSDF, and its albedo for denoising.

namespace make_bsdf_detail {

/// Tilts the shading normal towards the eye if the eye would otherwise be below the shading plane.
REALCAM_INLINE Vec3f visible_normal(Vec3f normal, Vec3f to_eye) {
    constexpr float kMinCosine = 1e-3f;
    const float cosine = dot(normal, to_eye);
    return cosine >= kMinCosine ? normal : normalized(normal + (kMinCosine - cosine) * to_eye);
}

/// Clamps to 0..1.
REALCAM_INLINE float unit_range(float v) {
    return v > 0.0f ? (v < 1.0f ? v : 1.0f) : 0.0f;
}
REALCAM_INLINE Color unit_range(Color c) {
    return {unit_range(c.r), unit_range(c.g), unit_range(c.b)};
}

/// GGX alpha of a glTF roughness.
REALCAM_INLINE float alpha_of(float roughness) {
    const float r = unit_range(roughness);
    return r * r;
}

/// Fresnel reflectance of a dielectric at normal incidence.
REALCAM_INLINE float normal_reflectance(float ior) {
    const float root = (ior - 1.0f) / (ior + 1.0f);
    return root * root;
}

/// Returns the interface of a transmitting material. `weight`, `filter`, `alpha`: see DielectricInterface;
/// `eye_cosine`: between the normal and the direction to the eye.
REALCAM_INLINE DielectricInterface make_interface(const SurfacePoint& point, float weight, Color filter, float alpha,
                                                  float eye_cosine) {
    const Material& m = *point.material;
    DielectricInterface interface;
    interface.weight = weight;
    interface.filter = filter;
    interface.is_thin = m.is_thin != 0;
    const float ior = m.ior > 1e-3f ? m.ior : 1e-3f;  // files may hold an index of 0
    interface.eta = interface.is_thin || point.is_front ? ior : 1.0f / ior;
    interface.alpha = alpha;
    interface.prepare(eye_cosine);
    return interface;
}

/// Sets the lobes of a phong material.
REALCAM_INLINE void add_phong(Bsdf& bsdf, const SurfacePoint& point) {
    const Material& m = *point.material;
    const float opaque = 1.0f - point.transmission;
    bsdf.diffuse = opaque * point.diffuse;
    bsdf.phong = opaque * point.specular;
    bsdf.shininess = point.shininess;
    if (point.transmission > 0.0f) {
        bsdf.interface = make_interface(point, point.transmission, m.filter, 0.0f, bsdf.eye.z);
        if (m.fresnel == FresnelTerm::none) bsdf.interface.fixed_reflectance = unit_range(largest(m.mirror));
    } else if (!is_black(m.mirror)) {
        if (m.fresnel == FresnelTerm::none) {
            bsdf.mirror = m.mirror;
        } else {
            // Keeps the total reflectance at normal incidence: the diffuse lobe below the mirror is scaled up to
            // compensate for the mirror's reflectance.
            const Color f0 = unit_range(m.mirror);
            bsdf.specular = MicrofacetReflection(0.0f, bsdf.eye.z);
            bsdf.specular.reflectance = bsdf.above_diffuse = FacetReflectance::from_f0_f90(f0, 1.0f, 0.0f);
            const auto below_mirror = [](float d, float mirror) {
                return d > 0.0f ? unit_range(d / (1.0f - mirror)) : 0.0f;
            };
            bsdf.diffuse = {below_mirror(point.diffuse.r, f0.r), below_mirror(point.diffuse.g, f0.g),
                            below_mirror(point.diffuse.b, f0.b)};
        }
    }
}

/// Sets the lobes of a metallic_roughness material: glTF 2.0, appendix B, with its extensions. The dielectric and the
/// metal share one specular lobe, because Schlick's term is linear in its two reflectances.
REALCAM_INLINE void add_metallic_roughness(Bsdf& bsdf, const SurfacePoint& point, Vec3f to_eye) {
    const Material& m = *point.material;
    const Color base = unit_range(point.diffuse);
    const float metallic = unit_range(point.metallic), alpha = alpha_of(point.roughness);
    // Weights of the transmitting dielectric, and of the metal and the opaque dielectric together.
    const float transmitting = (1.0f - metallic) * point.transmission, opaque = 1.0f - transmitting;
    if (transmitting > 0.0f) bsdf.interface = make_interface(point, transmitting, base, alpha, bsdf.eye.z);
    if (opaque > 0.0f) {
        const float metal = metallic / opaque;  // weight of the metal within the opaque part
        bsdf.specular = MicrofacetReflection(alpha, bsdf.eye.z);
        const float energy_loss = bsdf.specular.energy_loss;
        const Color f0 = unit_range((point.specular_weight * normal_reflectance(m.ior)) * point.specular);
        const auto dielectric = FacetReflectance::from_f0_f90(f0, point.specular_weight, energy_loss);
        bsdf.specular.reflectance = mix(dielectric, FacetReflectance::from_f0_f90(base, 1.0f, energy_loss), metal);
        bsdf.specular_weight = opaque;
        bsdf.above_diffuse = dielectric;
        bsdf.diffuse = (opaque * (1.0f - metal)) * base;
    }
    if (point.clearcoat > 0.0f) {
        bsdf.coat_weight = unit_range(point.clearcoat);
        bsdf.coat_rotation = HalfRotation(bsdf.frame.to_local(visible_normal(point.coat_normal, to_eye)));
        bsdf.coat = MicrofacetReflection(alpha_of(point.clearcoat_roughness), bsdf.coat_rotation(bsdf.eye).z);
        constexpr float kCoatF0 = 0.04f;  // of a refractive index of 1.5 (KHR_materials_clearcoat)
        bsdf.coat.reflectance = FacetReflectance::from_f0_f90(grey(kCoatF0), 1.0f, bsdf.coat.energy_loss);
    }
}

}  // namespace make_bsdf_detail

/// Returns the BSDF of a point for a direction of view, `to_eye` (unit): a PlainBsdf for SceneKind::plain, for which
/// all materials must be plain (Material::is_plain), and a Bsdf otherwise.
template <SceneKind scene_kind>
REALCAM_INLINE auto make_bsdf(const SurfacePoint& point, Vec3f to_eye) {
    using namespace make_bsdf_detail;
    if constexpr (scene_kind == SceneKind::plain) {
        const Material& m = *point.material;
        return PlainBsdf{point.normal, point.geometric_normal, to_eye, point.diffuse, m.specular, m.shininess};
    } else {
        Bsdf bsdf(visible_normal(point.normal, to_eye), point.geometric_normal, to_eye);
        if (point.material->model == MaterialModel::phong)
            add_phong(bsdf, point);
        else
            add_metallic_roughness(bsdf, point, to_eye);
        bsdf.prepare();
        return bsdf;
    }
}

/// Albedo of a surface point, 0 to 1, independent of light and view, as Open Image Denoise defines it: the reflectances
/// of the lobes at normal incidence, layered. Transmitted light counts as reflected, so that clear glass is white.
/// Clear coats are ignored.
REALCAM_INLINE Color albedo_of(const SurfacePoint& point) {
    using make_bsdf_detail::unit_range;
    const Material& m = *point.material;
    const float transmission = unit_range(point.transmission);
    if (m.model == MaterialModel::phong) {
        const Color opaque = point.diffuse + point.specular + m.mirror;
        return unit_range((1.0f - transmission) * unit_range(opaque) + transmission * unit_range(m.filter));
    }
    const Color base = unit_range(point.diffuse);
    const Color f0 = unit_range((point.specular_weight * make_bsdf_detail::normal_reflectance(m.ior)) * point.specular);
    const Color layered = f0 + (grey(1.0f) - f0) * base;
    const Color dielectric = (1.0f - transmission) * layered + transmission * base;
    return unit_range(mix(dielectric, base, unit_range(point.metallic)));
}

}  // namespace REALCAM_NAMESPACE
