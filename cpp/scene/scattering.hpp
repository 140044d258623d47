#pragma once
#include "../math/color.hpp"
#include "../math/sampling.hpp"

namespace REALCAM_NAMESPACE {

/// Density of a direction that has no alternative: a mirror's, and that of a ray from the camera.
inline constexpr float kDelta = __builtin_huge_valf();

/// A direction drawn from a BSDF.
struct BsdfSample {
    Vec3f direction;
    Color weight;  ///< BSDF times cosine over density; black: the path ends
    float pdf;     ///< of the whole BSDF, per steradian; kDelta where one lobe allows this direction only
    bool refracted = false;  ///< into or out of the material's inside
};

/// Right-handed axes with a surface's normal as z.
struct ShadingFrame {
    Vec3f x, y, z;

    REALCAM_INLINE explicit ShadingFrame(Vec3f normal) : z(normal) { tangent_frame(normal, x, y); }
    REALCAM_INLINE Vec3f to_local(Vec3f v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    REALCAM_INLINE Vec3f to_world(Vec3f v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace REALCAM_NAMESPACE
