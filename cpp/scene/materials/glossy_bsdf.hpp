#pragma once
#include "light_sample.hpp"
#include "make_bsdf.hpp"

namespace REALCAM_NAMESPACE {

// BSDF without branches for loops over many points on a CPU (GlossyBsdf), and its parameters.

/// Parameters of a GlossyBsdf: those of a material, evaluated at one point, that affect its lobes.
struct GlossySurface {
    Color base = {0, 0, 0};  ///< reflectance of the Lambertian lobe, or of a metal's facets at normal incidence
    Color f0 = {0, 0, 0};  ///< reflectance of a dielectric's facets at normal incidence
    float f90 = 0;  ///< reflectance of a dielectric's facets at grazing incidence
    float metallic = 0;  ///< metallic fraction of the surface, 0 to 1
    float alpha = 1;  ///< GGX alpha, at least kSmoothAlpha
};

/// True if GlossyBsdf can represent the material at a point.
REALCAM_INLINE bool is_glossy(const SurfacePoint& point) {
    const Material& m = *point.material;
    if (m.only_shadows || point.transmission > 0.0f) return false;
    if (m.model == MaterialModel::phong) return is_black(point.specular) && is_black(m.mirror);
    return !(point.clearcoat > 0.0f) && make_bsdf_detail::alpha_of(point.roughness) >= kSmoothAlpha;
}

/// Returns the parameters of a point, for which is_glossy must hold.
REALCAM_INLINE GlossySurface glossy_surface(const SurfacePoint& point) {
    using namespace make_bsdf_detail;
    const Material& m = *point.material;
    if (m.model == MaterialModel::phong) return {point.diffuse, {0, 0, 0}, 0.0f, 0.0f, 1.0f};
    return {unit_range(point.diffuse), unit_range((point.specular_weight * normal_reflectance(m.ior)) * point.specular),
            point.specular_weight, unit_range(point.metallic), alpha_of(point.roughness)};
}

/// Returns the lobe that weights the choice of lights at a surface. `normal`: on the eye's side.
REALCAM_INLINE LightLobe light_lobe(const GlossySurface& surface, Vec3f normal, Vec3f to_eye) {
    const float cosine = dot(normal, to_eye), grazing = fifth_power(1.0f - select(cosine > 0.0f, cosine, 0.0f));
    const float base = largest(surface.base), f0 = largest(surface.f0);
    const float dielectric = f0 + (surface.f90 - f0) * grazing, metal = base + (1.0f - base) * grazing;
    const float specular = dielectric + (metal - dielectric) * surface.metallic,
                diffuse = (1.0f - surface.metallic) * base;
    // A lobe about as broad as the Lambertian one favours the same lights and is not worth evaluating at each node of
    // the light tree.
    constexpr float kBroadAlpha = 0.5f;
    const bool is_used = (specular > 0.0f) & (surface.alpha < kBroadAlpha);
    return {to_eye, surface.alpha, select(is_used, specular / (specular + diffuse), 0.0f)};
}

/// Returns the lobe that weights the choice of lights at any surface point. If GlossyBsdf cannot represent the
/// material, the lobe has a share of 0, and lights are chosen by their illuminance alone.
REALCAM_INLINE LightLobe light_lobe(const SurfacePoint& point, Vec3f to_eye) {
    return is_glossy(point) ? light_lobe(glossy_surface(point), point.normal, to_eye) : LightLobe{};
}

/// BSDF of most opaque surfaces: a Lambertian lobe under a rough microfacet lobe. Free of branches, so that loops over
/// many points vectorise. On a GPU, and for other materials, Bsdf is used instead. Directions are unit, in the scene's
/// axes, and point away from the surface.
class GlossyBsdf {
public:
    /// BSDF times cosine of each lobe, and the sampling densities of the lobes per steradian. Zero if the direction is
    /// below the surface.
    struct Value {
        Color diffuse, specular;
        float diffuse_pdf, specular_pdf;
    };

    /// `normal`: shading normal, on the eye's side.
    REALCAM_INLINE GlossyBsdf(const GlossySurface& surface, Vec3f normal, Vec3f geometric_normal, Vec3f to_eye)
        : frame_(visible_normal(normal, to_eye)),
          geometric_normal_(geometric_normal),
          eye_(frame_.to_local(to_eye)),
          alpha_(surface.alpha),
          eye_albedo_(inlined_ggx_albedo(eye_.z, alpha_)) {
        const GgxAlbedo mean = inlined_ggx_mean_albedo(alpha_);
        energy_loss_ = 1.0f - mean.all;
        above_diffuse_ = FacetReflectance::from_f0_f90(surface.f0, surface.f90, energy_loss_);
        reflectance_ =
            mix(above_diffuse_, FacetReflectance::from_f0_f90(surface.base, 1.0f, energy_loss_), surface.metallic);
        // Fractions that the microfacets transmit to the Lambertian lobe below: for the eye's direction, and on
        // average.
        const Color transmitted_to_eye = grey(1.0f) - above_diffuse_.albedo(eye_albedo_);
        const Color transmitted = grey(1.0f) - above_diffuse_.albedo(mean),
                    diffuse = (1.0f - surface.metallic) * surface.base;
        const auto at_least = [](float v) { return select(v > 1e-4f, v, 1e-4f); };
        diffuse_ = diffuse * transmitted_to_eye /
                   Color{at_least(transmitted.r), at_least(transmitted.g), at_least(transmitted.b)};
        diffuse_albedo_ = largest(diffuse * transmitted_to_eye);
        specular_albedo_ = largest(reflectance_.albedo(eye_albedo_));
    }

    /// Albedos for the eye's direction, by which a lobe is chosen.
    REALCAM_INLINE float diffuse_albedo() const { return diffuse_albedo_; }
    REALCAM_INLINE float specular_albedo() const { return specular_albedo_; }

    /// Evaluates both lobes for a direction to the light.
    REALCAM_INLINE Value eval(Vec3f to_light) const {
        const Vec3f light = frame_.to_local(to_light);
        const bool is_possible = (light.z > 0.0f) & (dot(geometric_normal_, to_light) > 0.0f);
        // Directions below the surface must not index outside the tables.
        const float cosine = select(is_possible, light.z, 1.0f), pdf = kInvPi * cosine;
        const GgxAlbedo light_albedo = inlined_ggx_albedo(cosine, alpha_);
        const Color diffuse = pdf * diffuse_ * (grey(1.0f) - above_diffuse_.albedo(light_albedo));
        const Vec3f h = normalized(eye_ + light);
        const float density = ggx_density(h, alpha_) / (4.0f * eye_.z), lambda = ggx_lambda(eye_, alpha_);
        // ggx_masking and ggx_masking_shadowing, with the terms that they share.
        const float masking = 1.0f / (1.0f + lambda),
                    masking_shadowing = 1.0f / (1.0f + lambda + ggx_lambda(light, alpha_));
        const float both_losses = (1.0f - eye_albedo_.all) * (1.0f - light_albedo.all);
        const float multiple_scattering = select(energy_loss_ > 1e-6f, both_losses * pdf / energy_loss_, 0.0f);
        const Color specular =
            (density * masking_shadowing) * schlick(reflectance_.f0, reflectance_.f90, dot(eye_, h)) +
            multiple_scattering * reflectance_.multiple;
        const float specular_pdf = eye_albedo_.all * masking * density + (1.0f - eye_albedo_.all) * (2.0f * kSpherePdf);
        const Color black = {0, 0, 0};
        return {select(is_possible, diffuse, black), select(is_possible, specular, black),
                select(is_possible, pdf, 0.0f), select(is_possible, specular_pdf, 0.0f)};
    }

    /// Samples a direction of one lobe; it may lie below the surface.
    REALCAM_INLINE Vec3f sample(bool is_diffuse, Vec2f u) const {
        const Vec3f h = sample_ggx(eye_, alpha_, {u.x / eye_albedo_.all, u.y});
        const Vec3f mirrored = (2.0f * dot(eye_, h)) * h - eye_;
        // Multiple scattering is sampled uniformly over the hemisphere (MicrofacetReflection::sample).
        const float rescaled = (u.x - eye_albedo_.all) / (1.0f - eye_albedo_.all);
        const Vec3f uniform = sample_sphere({select(rescaled < 1.0f, 0.5f * rescaled, 0.5f), u.y});
        const Vec3f specular = select(u.x < eye_albedo_.all, mirrored, uniform);
        return frame_.to_world(select(is_diffuse, sample_cosine({0, 0, 1}, u), specular));
    }

private:
    /// Branch-free version of make_bsdf_detail::visible_normal.
    REALCAM_INLINE static Vec3f visible_normal(Vec3f normal, Vec3f to_eye) {
        constexpr float kMinCosine = 1e-3f;
        const float cosine = dot(normal, to_eye);
        return select(cosine >= kMinCosine, normal, normalized(normal + (kMinCosine - cosine) * to_eye));
    }

    ShadingFrame frame_;
    Vec3f geometric_normal_;
    Vec3f eye_;  ///< direction to the eye, local
    float alpha_;  ///< GGX alpha
    float energy_loss_;  ///< 1 - mean albedo of single scattering
    GgxAlbedo eye_albedo_;  ///< directional albedo of single scattering for the eye's direction
    FacetReflectance above_diffuse_, reflectance_;
    Color diffuse_;  ///< reflectance times all factors that depend only on the direction of view
    float diffuse_albedo_, specular_albedo_;
};

}  // namespace REALCAM_NAMESPACE
