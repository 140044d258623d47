#pragma once
#include "../../math/random.hpp"
#include "instance_at.hpp"
#include "surface_point.hpp"

namespace REALCAM_NAMESPACE {

// Stochastic opacity: a ray that hits a surface with holes stops there with the probability of its opacity. The
// expected picture equals that of partial transmission, for shadows and for visible surfaces, however many surfaces
// overlap, and rays need not be split.

/// Opacity of a surface at a hit, 0 to 1.
REALCAM_INLINE float opacity_at(const MeshView& mesh, const Triangle& triangle, Hit hit) {
    const Material& material = mesh.materials[triangle.material];
    float opacity = material.opacity;
    const TextureReference& map = material.opacity_texture;
    if (map.texture >= 0 && mesh.uvs) opacity *= texture_alpha(mesh, triangle, hit, map);
    if (material.vertex_opacity) opacity *= vertex_alpha(mesh, triangle, hit);
    if (material.opacity_cutoff > 0.0f) return opacity >= material.opacity_cutoff ? 1.0f : 0.0f;
    return opacity;
}

// A ray's number is the seed of its random decisions: independent for each ray, and identical in all backends. It is
// odd for shadow rays and even for path rays.

/// Returns the number of a path ray (even, not 0) from a random hash.
REALCAM_INLINE std::uint32_t path_ray_number(std::uint32_t hash) {
    return (hash & ~1u) | 2u;
}
/// Returns the number of a shadow ray (odd) from a random hash.
REALCAM_INLINE std::uint32_t shadow_ray_number(std::uint32_t hash) {
    return hash | 1u;
}

/// Number of a ray that decides deterministically: it stops at surfaces with an opacity of at least 0.5 and passes
/// shadow catchers. A single ray that represents a whole pixel must not depend on chance.
inline constexpr std::uint32_t kDeterministicRay = 0;

/// True if the ray of this number stops at a hit on a mesh. Shadow rays pass shadow catchers, which so cast no shadows.
REALCAM_INLINE bool stops_ray(const MeshView& mesh, Hit hit, std::uint32_t ray_number) {
    const Triangle& triangle = mesh.triangles[hit.triangle];
    const Material& material = mesh.materials[triangle.material];
    if (!material.has_holes()) return true;
    if (material.only_shadows && ((ray_number & 1u) || ray_number == kDeterministicRay)) return false;
    if (ray_number == kDeterministicRay) return opacity_at(mesh, triangle, hit) >= 0.5f;
    return unit_float(hash32(hash32(ray_number, hit.triangle), hit.instance)) < opacity_at(mesh, triangle, hit);
}

// Properties of a ray, apart from its origin and direction, that traversal needs: how to decide whether it stops at a
// hit, and the time at which it sees moving instances.

/// Ray in a scene without holes and motion: it stops at every hit.
struct PlainSceneRay {
    static constexpr bool is_plain = true;
};

/// Ray in a scene of any kind.
struct AnySceneRay {
    static constexpr bool is_plain = false;
    const SceneView& scene;
    std::uint32_t number;  ///< seed of its decisions at holes
    float time;  ///< fraction of the exposure

    /// True if the ray stops at the hit.
    REALCAM_INLINE bool stops(Hit hit) const { return stops_ray(mesh_of(scene, hit.instance), hit, number); }
    /// Returns the transform from render space into the frame of the instance's object, at the ray's time.
    REALCAM_INLINE InverseAffine<float> into_object(std::uint32_t instance) const {
        return instance_at(scene, instance, time).object_from_render;
    }
};

}  // namespace REALCAM_NAMESPACE
