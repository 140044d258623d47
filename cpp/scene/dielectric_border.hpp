#pragma once
#include "fresnel.hpp"
#include "ggx_albedo.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

/// A border that reflects one part of the light and lets the other through: smooth, or rough by GGX microfacets (Walter
/// et al. 2007). In local coordinates, with `eye` above the surface. Radiance is that of the side on which it is: on
/// entering a medium it grows by the index squared. What a film's facets lose by a single reflection or passage comes
/// back on both sides alike, as in MicrofacetReflection; a medium's border loses it.
struct DielectricBorder {
    float weight = 0;  ///< all that it does is multiplied by this; 0: there is none
    Color filter = {1, 1, 1};  ///< of what passes
    float eta = 1;  ///< index below over index above
    float alpha = 0;  ///< below kSmoothAlpha: smooth
    float fixed_reflectance = -1;  ///< at any angle; negative: Fresnel's
    bool is_thin = false;  ///< a film: what passes goes on straight
    float found_at_eye = 1;  ///< of light from there, what single reflections and passages of a film find
    float lost = 0;  ///< the mean of what they lose

    REALCAM_INLINE bool is_smooth() const { return alpha < kSmoothAlpha; }

    /// Called when alpha is set.
    REALCAM_INLINE void prepare(float eye_cosine) {
        if (is_smooth() || !is_thin) return;
        found_at_eye = ggx_albedo(eye_cosine, alpha).all;
        lost = 1.0f - ggx_mean_albedo(alpha).all;
    }

    REALCAM_INLINE float reflectance(float cosine) const {
        const float fresnel = dielectric_fresnel(cosine, eta);
        if (is_thin) {
            // Between the two borders of a film light goes to and fro.
            const float one = fixed_reflectance < 0.0f ? fresnel : fixed_reflectance;
            return fixed_reflectance < 0.0f ? 2.0f * one / (1.0f + one) : one;
        }
        return fixed_reflectance < 0.0f || fresnel >= 1.0f ? fresnel : fixed_reflectance;
    }

    /// Where a ray goes on below a facet whose normal is h; z = 0: nowhere.
    REALCAM_INLINE Vec3f refracted(Vec3f eye, Vec3f h) const {
        const float cosine = dot(eye, h), sine2 = (1.0f - cosine * cosine) / (eta * eta);
        if (!(sine2 < 1.0f)) return {0, 0, 0};
        return (cosine / eta - std::sqrt(1.0f - sine2)) * h - (1.0f / eta) * eye;
    }

    /// The facet that takes eye to light.
    REALCAM_INLINE Vec3f facet(Vec3f eye, Vec3f light) const {
        if (light.z > 0.0f) return normalized(eye + light);
        if (is_thin) return normalized(eye + Vec3f{light.x, light.y, -light.z});
        const Vec3f h = normalized(eye + eta * light);
        return h.z < 0.0f ? -h : h;
    }

    /// BSDF times cosine.
    REALCAM_INLINE Color eval(Vec3f eye, Vec3f light) const {
        if (is_smooth() || light.z == 0.0f) return {0, 0, 0};
        const Vec3f h = facet(eye, light);
        const float c = dot(eye, h);
        if (!(c > 0.0f)) return {0, 0, 0};
        const float reflected = reflectance(c);
        const Vec3f upper = is_thin ? Vec3f{light.x, light.y, std::fabs(light.z)} : light;
        if (!is_thin && light.z < 0.0f) {
            const float d = dot(light, h), way = c + eta * d;
            if (!(d < 0.0f) || way == 0.0f) return {0, 0, 0};
            const float both = ggx_visible_to_both(eye, light, alpha);
            const float value = (1.0f - reflected) * ggx_density(h, alpha) * both * c * -d / (eye.z * way * way);
            return (weight * value) * filter;
        }
        const float shape = ggx_density(h, alpha) * ggx_visible_to_both(eye, upper, alpha) / (4.0f * eye.z);
        const float several = weight * 0.5f * facets_again(std::fabs(light.z));
        return light.z > 0.0f ? grey(weight * shape * reflected + several)
                              : (weight * shape * (1.0f - reflected) + several) * filter;
    }

    /// Density of sample, per steradian.
    REALCAM_INLINE float pdf(Vec3f eye, Vec3f light) const {
        if (is_smooth() || light.z == 0.0f) return 0.0f;
        const Vec3f h = facet(eye, light);
        const float c = dot(eye, h);
        if (!(c > 0.0f)) return 0.0f;
        const float reflected = reflectance(c), facets = ggx_pdf(eye, h, alpha);
        if (!is_thin && light.z < 0.0f) {
            const float d = dot(light, h), way = c + eta * d;
            if (!(d < 0.0f) || way == 0.0f) return 0.0f;
            return (1.0f - reflected) * facets * eta * eta * -d / (way * way);
        }
        return found_at_eye * (light.z > 0.0f ? reflected : 1.0f - reflected) * facets / (4.0f * c) +
               (1.0f - found_at_eye) * kSpherePdf;
    }

    /// `choice`: of reflection or passage. The weight and density are those of a smooth border; rough ones have eval
    /// and pdf. Black where the light would meet the facets again: that is left out.
    REALCAM_INLINE BsdfSample sample(Vec3f eye, Vec2f u, float choice) const {
        if (u.x >= found_at_eye) {
            const float fresh = (u.x - found_at_eye) / (1.0f - found_at_eye);
            return {sample_sphere({fresh < 1.0f ? fresh : 1.0f, u.y}), grey(1.0f), kDelta, false};
        }
        const Vec3f h = is_smooth() ? Vec3f{0, 0, 1} : sample_ggx(eye, alpha, {u.x / found_at_eye, u.y});
        const float c = dot(eye, h), reflected = reflectance(c);
        constexpr Color kNone = {0, 0, 0};
        if (choice < reflected || is_thin) {
            const Vec3f mirrored = (2.0f * c) * h - eye;
            if (!(mirrored.z > 0.0f)) return {mirrored, kNone, 0.0f, false};
            if (choice < reflected) return {mirrored, grey(1.0f), kDelta, false};
            return {{mirrored.x, mirrored.y, -mirrored.z}, filter, kDelta, false};
        }
        const Vec3f below = refracted(eye, h);
        return {below, below.z < 0.0f ? (1.0f / (eta * eta)) * filter : kNone, kDelta, true};
    }

private:
    /// Of light that meets several facets of a film: value times cosine, for both sides together.
    REALCAM_INLINE float facets_again(float cosine) const {
        if (!(lost > 1e-6f)) return 0.0f;
        return (1.0f - found_at_eye) * (1.0f - ggx_albedo(cosine, alpha).all) * 0.3183098862f * cosine / lost;
    }
};

}  // namespace REALCAM_NAMESPACE
