#pragma once
#include "../math/random.hpp"
#include "surface_point.hpp"

namespace REALCAM_NAMESPACE {

// A ray that meets a surface with holes stops there with the probability of its opacity. So the picture's mean is that
// of light which is let through in part, for shadows as for what is seen, however many surfaces lie behind each other,
// and no ray has to be split.

/// Share of a surface that is there, at a place on one of its triangles.
REALCAM_INLINE float opacity_at(const MeshView& mesh, const Triangle& triangle, Hit hit) {
    const Material& material = mesh.materials[triangle.material];
    float opacity = material.opacity;
    const TextureReference& map = material.opacity_texture;
    if (map.texture >= 0 && mesh.uvs) opacity *= texture_alpha(mesh, triangle, hit, map);
    if (material.vertex_opacity) opacity *= vertex_alpha(mesh, triangle, hit);
    if (material.opacity_cutoff > 0.0f) return opacity >= material.opacity_cutoff ? 1.0f : 0.0f;
    return opacity;
}

// By the number of a ray each one decides anew, and each backend alike. It is odd for shadow rays.
REALCAM_INLINE std::uint32_t path_ray_number(std::uint32_t hash) {
    return (hash & ~1u) | 2u;
}
REALCAM_INLINE std::uint32_t shadow_ray_number(std::uint32_t hash) {
    return hash | 1u;
}

/// The number of a ray that stops at surfaces with an opacity of half or more, and passes those that show shadows
/// alone. One ray that stands for a whole pixel must not depend on chance.
inline constexpr std::uint32_t kDecidedRay = 0;

/// Whether a ray stops at a hit on a mesh.
REALCAM_INLINE bool stops_ray(const MeshView& mesh, Hit hit, std::uint32_t ray) {
    const Triangle& triangle = mesh.triangles[hit.triangle];
    const Material& material = mesh.materials[triangle.material];
    if (!material.has_holes()) return true;
    if (material.only_shadows && ((ray & 1u) || ray == kDecidedRay)) return false;
    if (ray == kDecidedRay) return opacity_at(mesh, triangle, hit) >= 0.5f;
    return unit_float(hash32(hash32(ray, hit.triangle), hit.instance)) < opacity_at(mesh, triangle, hit);
}

}  // namespace REALCAM_NAMESPACE
