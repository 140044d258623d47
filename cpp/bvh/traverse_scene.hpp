#pragma once
#include "traverse_wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

// Two levels: objects, and the triangles of each. Within an object the traversal is watertight; between two of them,
// whose corners come from different roundings, there is no edge to be tight.

template <bool any>
struct InstanceRay {
    Vec3f origin, direction;

    REALCAM_INLINE InstanceRay(Vec3f from, Vec3f along) : origin(from), direction(along) {}
};

/// Whether the ray meets a triangle of the object at a parameter in [0, hit.distance). If so, `hit` says where.
template <bool any>
REALCAM_INLINE bool meets(const InstanceRay<any>& ray, const BvhInstance& instance, Hit& hit) {
    const InverseAffine<float>& into = instance.object_from_placed;
    const Hit inside =
        traverse<any>(instance.object, into.point(ray.origin), into.direction(ray.direction), hit.distance);
    if (inside.triangle == kNoTriangle) return false;
    hit = inside;
    hit.instance = instance.index;
    return true;
}

/// As closest_hit of one hierarchy. `instanced`: whether there is anything but the ground.
template <bool instanced>
REALCAM_HD inline Hit closest_hit(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far) {
    const Hit ground = closest_hit(bvh.ground, origin, direction, far);
    if constexpr (instanced) {
        const Hit object = traverse<false, InstanceRay<false>>(bvh.instances, origin, direction, ground.distance);
        if (object.triangle != kNoTriangle) return object;
    }
    return ground;
}

template <bool instanced>
REALCAM_HD inline bool any_hit(const SceneBvhView& bvh, Vec3f origin, Vec3f direction, float far) {
    if (any_hit(bvh.ground, origin, direction, far)) return true;
    if constexpr (instanced)
        return traverse<true, InstanceRay<true>>(bvh.instances, origin, direction, far).triangle != kNoTriangle;
    return false;
}

}  // namespace REALCAM_NAMESPACE
