#pragma once
#include "../../math/key_interval.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Transforms of moving instances while the shutter is open. Times are fractions of the exposure, 0 to 1. Keys are
// equally spaced in time, and matrix entries are interpolated linearly between them, as in Embree.

/// Returns the transform at a time, interpolated between `count` keys, which are at least 2.
REALCAM_INLINE Affine<float> transform_at(const Affine<float>* keys, std::int32_t count, float time) {
    const KeyInterval interval = key_interval(time, count);
    return mix(keys[interval.first], keys[interval.first + 1], interval.share);
}

/// Returns the instance of this index with its transforms at a time.
REALCAM_INLINE InstanceView instance_at(const SceneView& scene, std::uint32_t index, float time) {
    InstanceView instance = scene.instances[index];
    if (instance.key_count > 0) {
        instance.render_from_object = transform_at(scene.keys + instance.first_key, instance.key_count, time);
        instance.object_from_render = instance.render_from_object.inverse();
    }
    return instance;
}

}  // namespace REALCAM_NAMESPACE
