#pragma once
#include "instance_at.hpp"
#include "opacity.hpp"

namespace REALCAM_NAMESPACE {

// What traversal has to know of a ray besides its line: whether it stops at a triangle that it meets, and where
// instances are at its time.

/// A ray in a scene without holes and motion: it stops at everything.
struct PlainSceneRay {
    static constexpr bool is_plain = true;
};

struct AnySceneRay {
    static constexpr bool is_plain = false;
    const SceneView& scene;
    std::uint32_t number;  ///< by which it decides at holes
    float time;            ///< share of the exposure

    REALCAM_INLINE bool stops(Hit hit) const { return stops_ray(mesh_of(scene, hit.instance), hit, number); }
    REALCAM_INLINE InverseAffine<float> into_object(std::uint32_t instance) const {
        return instance_at(scene, instance, time).object_from_render;
    }
};

}  // namespace REALCAM_NAMESPACE
