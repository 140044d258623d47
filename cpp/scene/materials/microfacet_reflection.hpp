#pragma once
#include "ggx_albedo.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

/// Reflectance of microfacets: Schlick's term for single scattering, and the albedo of the multiple-scattering lobe.
struct FacetReflectance {
    Color f0 = {0, 0, 0};  ///< at normal incidence
    float f90 = 0;  ///< at grazing incidence
    Color multiple = {0, 0, 0};  ///< albedo of multiple scattering (Kulla and Conty 2017)

    /// Returns the reflectance with this Schlick term.
    /// `energy_loss`: cosine-weighted mean of the energy that single scattering on perfectly reflecting facets loses.
    REALCAM_INLINE static FacetReflectance from_f0_f90(Color f0, float f90, float energy_loss) {
        const Color mean = (1.0f / 21.0f) * (20.0f * f0 + grey(f90));  // cosine-weighted mean of Schlick's term
        return {f0, f90, (1.0f - energy_loss) * mean * mean / (grey(1.0f) - energy_loss * mean)};
    }
    /// Directional albedo of single and multiple scattering; `facets`: of single scattering with reflectance 1.
    REALCAM_INLINE Color albedo(GgxAlbedo facets) const {
        return (facets.all - facets.grazing) * f0 + grey(facets.grazing * f90) + (1.0f - facets.all) * multiple;
    }
};

/// Linear interpolation from a (t = 0) to b (t = 1).
REALCAM_INLINE FacetReflectance mix(const FacetReflectance& a, const FacetReflectance& b, float t) {
    return {mix(a.f0, b.f0, t), a.f90 + t * (b.f90 - a.f90), mix(a.multiple, b.multiple, t)};
}

/// GGX microfacet reflection with multiple scattering: the energy that single scattering loses returns in a nearly
/// diffuse lobe (Kulla and Conty 2017). Directions are local, unit, and point away from the surface; `eye`, the
/// direction to the eye, is above it.
struct MicrofacetReflection {
    float alpha = 1;  ///< GGX alpha; below kSmoothAlpha: a mirror, for which eval and pdf are 0
    float energy_loss = 0;  ///< cosine-weighted mean of the energy that single scattering loses
    GgxAlbedo to_eye = {0, 0};  ///< directional albedo of single scattering for the eye's direction
    GgxAlbedo mean = {0, 0};  ///< its cosine-weighted mean over the hemisphere
    FacetReflectance reflectance;

    REALCAM_HD MicrofacetReflection() {}
    /// Leaves `reflectance` to be set by the caller.
    REALCAM_HD MicrofacetReflection(float alpha_, float eye_cosine) : alpha(alpha_), to_eye(facets_at(eye_cosine)) {
        mean = is_smooth() ? GgxAlbedo{1.0f, 1.0f / 21.0f} : ggx_mean_albedo(alpha);
        energy_loss = 1.0f - mean.all;
    }

    REALCAM_INLINE bool is_smooth() const { return alpha < kSmoothAlpha; }
    /// Directional albedo of single scattering at a cosine.
    REALCAM_INLINE GgxAlbedo facets_at(float cosine) const {
        return is_smooth() ? GgxAlbedo{1.0f, fifth_power(1.0f - cosine)} : ggx_albedo(cosine, alpha);
    }
    /// Directional albedo of the lobe for the eye's direction.
    REALCAM_INLINE Color albedo_to_eye() const { return reflectance.albedo(to_eye); }

    /// BSDF times cosine.
    REALCAM_INLINE Color eval(Vec3f eye, Vec3f light) const {
        if (is_smooth()) return {0, 0, 0};
        return single_scattering(eye, light) + multiple_scattering(light.z, ggx_albedo(light.z, alpha));
    }

    /// Density of sample(), per steradian.
    REALCAM_INLINE float pdf(Vec3f eye, Vec3f light) const {
        if (is_smooth()) return 0.0f;
        const Vec3f h = normalized(eye + light);
        return to_eye.all * ggx_pdf(eye, h, alpha) / (4.0f * dot(eye, h)) + (1.0f - to_eye.all) * (2.0f * kSpherePdf);
    }

    /// Samples a direction, which may lie below the surface.
    REALCAM_INLINE Vec3f sample(Vec3f eye, Vec2f u) const {
        if (is_smooth()) return {-eye.x, -eye.y, eye.z};
        if (u.x < to_eye.all) {
            const Vec3f h = sample_ggx(eye, alpha, {u.x / to_eye.all, u.y});
            return (2.0f * dot(eye, h)) * h - eye;
        }
        // Uniform over the hemisphere, not by cosine: on smooth surfaces energy is lost at grazing incidence.
        const float rescaled = (u.x - to_eye.all) / (1.0f - to_eye.all);
        return sample_sphere({rescaled < 1.0f ? 0.5f * rescaled : 0.5f, u.y});
    }

private:
    /// Single scattering: BSDF times cosine.
    REALCAM_INLINE Color single_scattering(Vec3f eye, Vec3f light) const {
        const Vec3f h = normalized(eye + light);
        const float for_reflectance_1 =
            ggx_density(h, alpha) * ggx_masking_shadowing(eye, light, alpha) / (4.0f * eye.z);
        return for_reflectance_1 * schlick(reflectance.f0, reflectance.f90, dot(eye, h));
    }
    /// Multiple scattering: BSDF times cosine. `to_light`: directional albedo at the light's cosine.
    REALCAM_INLINE Color multiple_scattering(float cosine, GgxAlbedo to_light) const {
        if (!(energy_loss > 1e-6f)) return {0, 0, 0};
        return ((1.0f - to_eye.all) * (1.0f - to_light.all) * kInvPi * cosine / energy_loss) * reflectance.multiple;
    }
};

}  // namespace REALCAM_NAMESPACE
