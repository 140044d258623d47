#pragma once
#include "../../math/color.hpp"
#include "../../math/sampling.hpp"

namespace REALCAM_NAMESPACE {

// Fresnel terms and local frames that all BSDFs use.

REALCAM_INLINE float fifth_power(float v) {
    const float v2 = v * v;
    return v2 * v2 * v;
}

/// Schlick's approximation of Fresnel reflectance (1994): f0 at normal, f90 at grazing incidence.
REALCAM_INLINE Color schlick(Color f0, float f90, float cosine) {
    return mix(f0, grey(f90), fifth_power(1.0f - cosine));
}

/// Fresnel reflectance of a dielectric interface for unpolarised light; 1 for total reflection. `eta`: index behind the
/// interface over the index in front of it; `cosine`: of the angle of incidence, above 0.
REALCAM_INLINE float dielectric_fresnel(float cosine, float eta) {
    const float sine2_behind = (1.0f - cosine * cosine) / (eta * eta);
    if (!(sine2_behind < 1.0f)) return 1.0f;
    const float cosine_behind = std::sqrt(1.0f - sine2_behind);
    const float parallel = (eta * cosine - cosine_behind) / (eta * cosine + cosine_behind);
    const float perpendicular = (cosine - eta * cosine_behind) / (cosine + eta * cosine_behind);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Density of a direction sampled from a delta distribution: a mirror reflection, or a ray from the camera.
inline constexpr float kDelta = __builtin_huge_valf();
/// Value of a density that marks a ray that comes directly from the film.
inline constexpr float kFromFilm = -1.0f;

/// Direction sampled from a BSDF.
struct BsdfSample {
    Vec3f direction;  ///< unit, away from the surface
    Color weight;  ///< BSDF times cosine over density; black ends the path
    float pdf;  ///< density of all lobes together, per steradian; kDelta if sampled from a delta lobe
    bool refracted = false;  ///< the ray enters or leaves the material's interior
};

/// Right-handed orthonormal basis with a surface's normal as z.
struct ShadingFrame {
    Vec3f x, y, z;

    REALCAM_INLINE explicit ShadingFrame(Vec3f normal) : z(normal) { tangent_frame(normal, x, y); }
    REALCAM_INLINE Vec3f to_local(Vec3f v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    REALCAM_INLINE Vec3f to_world(Vec3f v) const { return v.x * x + v.y * y + v.z * z; }
};

/// Rotation by 180 degrees that swaps the z axis and another normal, and so converts directions between the frames of
/// the two normals, in either direction. The azimuth is arbitrary, which does not matter to isotropic lobes.
struct HalfRotation {
    Vec3f normal = {0, 0, 1};  ///< unit, above the surface

    HalfRotation() = default;
    REALCAM_INLINE explicit HalfRotation(Vec3f n) : normal(n) {}

    /// True if the other normal is the z axis: directions remain as they are.
    REALCAM_INLINE bool is_identity() const { return normal.x == 0.0f && normal.y == 0.0f; }
    REALCAM_INLINE Vec3f operator()(Vec3f v) const {
        if (is_identity()) return v;
        const Vec3f axis = {normal.x, normal.y, normal.z + 1.0f};  // half vector of the two normals
        return (dot(axis, v) / axis.z) * axis - v;  // axis . axis = 2 axis.z
    }
};

}  // namespace REALCAM_NAMESPACE
