#pragma once
#include "ggx_albedo.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

/// Reflectance of microfacets: Schlick's term for single scattering, and the albedo of the multiple-scattering lobe.
struct FacetReflectance {
    Color f0 = {0, 0, 0};
    float f90 = 0;
    Color multiple = {0, 0, 0};

    /// `lost`: cosine-weighted mean of the energy that single scattering on perfectly reflecting facets loses.
    REALCAM_INLINE static FacetReflectance between(Color f0, float f90, float lost) {
        const Color mean = (1.0f / 21.0f) * (20.0f * f0 + grey(f90));  // cosine-weighted mean of Schlick's term
        return {f0, f90, (1.0f - lost) * mean * mean / (grey(1.0f) - lost * mean)};
    }
    REALCAM_INLINE Color albedo(GgxAlbedo facets) const {
        return (facets.all - facets.grazing) * f0 + grey(facets.grazing * f90) + (1.0f - facets.all) * multiple;
    }
};

REALCAM_INLINE FacetReflectance mix(const FacetReflectance& a, const FacetReflectance& b, float share_of_b) {
    return {mix(a.f0, b.f0, share_of_b), a.f90 + share_of_b * (b.f90 - a.f90), mix(a.multiple, b.multiple, share_of_b)};
}

/// GGX microfacet reflection with multiple scattering: the energy that single scattering loses returns in a nearly
/// diffuse lobe (Kulla and Conty 2017). In local coordinates, with `to_eye` above the surface.
struct MicrofacetReflection {
    float alpha = 1;  ///< GGX alpha; below kSmoothAlpha: a mirror, for which eval and pdf are 0
    float lost = 0;  ///< cosine-weighted mean of the energy that single scattering loses
    GgxAlbedo to_eye = {0, 0}, mean = {0, 0};
    FacetReflectance reflectance;

    REALCAM_HD MicrofacetReflection() {}
    /// Leaves `reflectance` to be set by the caller.
    REALCAM_HD MicrofacetReflection(float alpha_, float eye_cosine) : alpha(alpha_), to_eye(facets_at(eye_cosine)) {
        mean = is_smooth() ? GgxAlbedo{1.0f, 1.0f / 21.0f} : ggx_mean_albedo(alpha);
        lost = 1.0f - mean.all;
    }

    REALCAM_INLINE bool is_smooth() const { return alpha < kSmoothAlpha; }
    REALCAM_INLINE GgxAlbedo facets_at(float cosine) const {
        return is_smooth() ? GgxAlbedo{1.0f, fifth_power(1.0f - cosine)} : ggx_albedo(cosine, alpha);
    }
    /// Directional albedo for the eye's direction.
    REALCAM_INLINE Color albedo_to_eye() const { return reflectance.albedo(to_eye); }

    /// BSDF times cosine.
    REALCAM_INLINE Color eval(Vec3f eye, Vec3f light) const {
        if (is_smooth()) return {0, 0, 0};
        return single(eye, light) + several(light.z, ggx_albedo(light.z, alpha));
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
        const float fresh = (u.x - to_eye.all) / (1.0f - to_eye.all);
        return sample_sphere({fresh < 1.0f ? 0.5f * fresh : 0.5f, u.y});
    }

private:
    REALCAM_INLINE Color single(Vec3f eye, Vec3f light) const {
        const Vec3f h = normalized(eye + light);
        const float shape = ggx_density(h, alpha) * ggx_visible_to_both(eye, light, alpha) / (4.0f * eye.z);
        return shape * schlick(reflectance.f0, reflectance.f90, dot(eye, h));
    }
    REALCAM_INLINE Color several(float cosine, GgxAlbedo to_light) const {
        if (!(lost > 1e-6f)) return {0, 0, 0};
        return ((1.0f - to_eye.all) * (1.0f - to_light.all) * 0.3183098862f * cosine / lost) * reflectance.multiple;
    }
};

}  // namespace REALCAM_NAMESPACE
