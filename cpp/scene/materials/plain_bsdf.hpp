#pragma once
#include "../../math/random.hpp"
#include "../../math/sampling.hpp"
#include "scattering.hpp"

namespace REALCAM_NAMESPACE {

/// Mirror reflection of a direction at a plane with this normal; both directions point away from the plane.
REALCAM_INLINE Vec3f mirrored_at(Vec3f normal, Vec3f direction) {
    return (2.0f * dot(direction, normal)) * normal - direction;
}

/// Normalised, energy-conserving Phong lobe (Lafortune and Willems 1994): BSDF times cosine for a reflectance of 1, in
/// local coordinates.
REALCAM_INLINE float phong_value(Vec3f eye, float shininess, Vec3f light) {
    const float density = phong_pdf({-eye.x, -eye.y, eye.z}, shininess, light);
    return (shininess + 2.0f) / (shininess + 1.0f) * density * light.z;
}

/// BSDF of a plain material (Material::is_plain): Lambertian and Phong lobes, for kernels that need no others.
class PlainBsdf {
public:
    Vec3f normal, geometric_normal;  ///< shading and geometric normal, unit, on the eye's side
    Vec3f eye;  ///< direction to the eye, unit
    Color diffuse, phong;  ///< reflectances of the two lobes
    float shininess;  ///< Phong exponent

    REALCAM_INLINE bool is_opaque() const { return true; }
    /// Removes the Lambertian lobe.
    REALCAM_INLINE void remove_diffuse_lobe() { diffuse = {0, 0, 0}; }
    /// Removes both lobes.
    REALCAM_INLINE void keep_delta_lobes() { diffuse = phong = {0, 0, 0}; }

    /// BSDF times cosine. `light`: direction to the light, unit.
    REALCAM_INLINE Color eval(Vec3f light) const {
        const float cosine = dot(normal, light);
        if (!(cosine > 0.0f && dot(geometric_normal, light) > 0.0f)) return {0, 0, 0};
        Color value = (kInvPi * cosine) * diffuse;
        if (!is_black(phong)) {
            const float density = phong_pdf(mirrored_at(normal, eye), shininess, light);
            value += ((shininess + 2.0f) / (shininess + 1.0f) * density * cosine) * phong;
        }
        return value;
    }

    /// Density of sample(), per steradian.
    REALCAM_INLINE float pdf(Vec3f light) const {
        const float probability = diffuse_probability();
        float density = probability * cosine_pdf(normal, light);
        if (probability < 1.0f) density += (1.0f - probability) * phong_pdf(mirrored_at(normal, eye), shininess, light);
        return density;
    }

    /// Samples a direction: chooses a lobe by its reflectance, then a direction by the lobe's density. The second
    /// argument, which Bsdf::sample has, is not used.
    REALCAM_INLINE BsdfSample sample(Vec2f u, float) const {
        BsdfSample result{normal, {0, 0, 0}, 0.0f, false};
        if (is_black(diffuse) && is_black(phong)) return result;
        const float probability = diffuse_probability();
        const bool is_diffuse = u.x < probability;
        u.x = is_diffuse ? remapped_random(u.x, probability) : remapped_random(u.x - probability, 1.0f - probability);
        result.direction = is_diffuse ? sample_cosine(normal, u) : sample_phong(mirrored_at(normal, eye), shininess, u);
        result.pdf = pdf(result.direction);
        if (result.pdf > 0.0f) result.weight = (1.0f / result.pdf) * eval(result.direction);
        return result;
    }

private:
    /// Probability of sampling the Lambertian lobe: by the largest reflectance of each lobe.
    REALCAM_INLINE float diffuse_probability() const {
        const float d = largest(diffuse), p = largest(phong);
        return d > 0.0f ? d / (d + p) : 0.0f;
    }
};

}  // namespace REALCAM_NAMESPACE
