#pragma once
#include "instance_at.hpp"
#include "opacity.hpp"

namespace REALCAM_NAMESPACE {

// Properties of a ray, apart from its origin and direction, that traversal needs: whether it stops at a hit, and the
// time at which it sees moving instances.

/// Ray in a scene without holes and motion: it stops at every hit.
struct PlainSceneRay {
    static constexpr bool is_plain = true;
};

struct AnySceneRay {
    static constexpr bool is_plain = false;
    const SceneView& scene;
    std::uint32_t number;  ///< seed of its decisions at holes (opacity.hpp)
    float time;  ///< fraction of the exposure

    REALCAM_INLINE bool stops(Hit hit) const { return stops_ray(mesh_of(scene, hit.instance), hit, number); }
    REALCAM_INLINE InverseAffine<float> into_object(std::uint32_t instance) const {
        return instance_at(scene, instance, time).object_from_render;
    }
};

}  // namespace REALCAM_NAMESPACE
