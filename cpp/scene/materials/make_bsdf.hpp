#pragma once
#include "../geometry/surface_point.hpp"
#include "bsdf.hpp"
#include "plain_bsdf.hpp"

namespace REALCAM_NAMESPACE {

namespace make_bsdf_detail {

/// Tilts a shading normal under which the eye would be below the surface towards the eye, until it is not.
REALCAM_INLINE Vec3f visible_normal(Vec3f normal, Vec3f to_eye) {
    constexpr float kLeastCosine = 1e-3f;
    const float cosine = dot(normal, to_eye);
    return cosine >= kLeastCosine ? normal : normalized(normal + (kLeastCosine - cosine) * to_eye);
}

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

REALCAM_INLINE DielectricBorder border_of(const SurfacePoint& point, float weight, Color filter, float alpha,
                                          float eye_cosine) {
    const Material& m = *point.material;
    DielectricBorder border;
    border.weight = weight;
    border.filter = filter;
    border.is_thin = m.is_thin != 0;
    const float ior = m.ior > 1e-3f ? m.ior : 1e-3f;
    border.eta = border.is_thin || point.is_front ? ior : 1.0f / ior;
    border.alpha = alpha;
    border.prepare(eye_cosine);
    return border;
}

REALCAM_INLINE void add_phong(Bsdf& bsdf, const SurfacePoint& point) {
    const Material& m = *point.material;
    const float opaque = 1.0f - point.transmission;
    bsdf.diffuse = opaque * point.diffuse;
    bsdf.phong = opaque * point.specular;
    bsdf.shininess = point.shininess;
    if (point.transmission > 0.0f) {
        bsdf.border = border_of(point, point.transmission, m.filter, 0.0f, bsdf.eye.z);
        if (m.fresnel == FresnelTerm::none) bsdf.border.fixed_reflectance = unit_range(largest(m.mirror));
    } else if (!is_black(m.mirror)) {
        if (m.fresnel == FresnelTerm::none) {
            bsdf.mirror = m.mirror;
        } else {
            // Keeps the total reflectance at normal incidence: the diffuse lobe below the mirror is scaled up to
            // compensate for the mirror's reflectance.
            const Color f0 = unit_range(m.mirror);
            bsdf.specular = MicrofacetReflection(0.0f, bsdf.eye.z);
            bsdf.specular.reflectance = bsdf.above_diffuse = FacetReflectance::between(f0, 1.0f, 0.0f);
            const auto under = [](float d, float mirror) { return d > 0.0f ? unit_range(d / (1.0f - mirror)) : 0.0f; };
            bsdf.diffuse = {under(point.diffuse.r, f0.r), under(point.diffuse.g, f0.g), under(point.diffuse.b, f0.b)};
        }
    }
}

// glTF 2.0, appendix B, with its extensions. The dielectric and the metal share one specular lobe, because Schlick's
// term is linear in its two reflectances.
REALCAM_INLINE void add_metallic_roughness(Bsdf& bsdf, const SurfacePoint& point, Vec3f to_eye) {
    const Material& m = *point.material;
    const Color base = unit_range(point.diffuse);
    const float metallic = unit_range(point.metallic), alpha = alpha_of(point.roughness);
    const float passing = (1.0f - metallic) * point.transmission, opaque = 1.0f - passing;
    if (passing > 0.0f) bsdf.border = border_of(point, passing, base, alpha, bsdf.eye.z);
    if (opaque > 0.0f) {
        const float metal = metallic / opaque;
        bsdf.specular = MicrofacetReflection(alpha, bsdf.eye.z);
        const float lost = bsdf.specular.lost;
        const Color f0 = unit_range((point.specular_weight * normal_reflectance(m.ior)) * point.specular);
        const auto dielectric = FacetReflectance::between(f0, point.specular_weight, lost);
        bsdf.specular.reflectance = mix(dielectric, FacetReflectance::between(base, 1.0f, lost), metal);
        bsdf.specular_weight = opaque;
        bsdf.above_diffuse = dielectric;
        bsdf.diffuse = (opaque * (1.0f - metal)) * base;
    }
    if (point.clearcoat > 0.0f) {
        bsdf.coat_weight = unit_range(point.clearcoat);
        bsdf.coat_turn = HalfTurn(bsdf.frame.to_local(visible_normal(point.coat_normal, to_eye)));
        bsdf.coat = MicrofacetReflection(alpha_of(point.clearcoat_roughness), bsdf.coat_turn(bsdf.eye).z);
        bsdf.coat.reflectance = FacetReflectance::between(grey(0.04f), 1.0f, bsdf.coat.lost);
    }
}

}  // namespace make_bsdf_detail

/// BSDF of a point for a direction of view. For SceneKind::plain all materials must be plain (Material::is_plain).
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
