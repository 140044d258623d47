#pragma once
#include <memory>

#include "../scene/placed_scene.hpp"
#include "embree_api.hpp"

namespace realcam {

/// A placed scene with its Embree BVH.
class EmbreeScene {
public:
    /// Throws DeviceError (out of memory, for one).
    EmbreeScene(RTCDevice device, std::shared_ptr<const Scene> scene, Vec3d origin_m);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    const std::shared_ptr<const Scene>& scene() const { return scene_; }
    const PlacedScene& placed() const { return placed_; }
    RTCScene handle() const { return handle_; }

private:
    std::shared_ptr<const Scene> scene_;
    PlacedScene placed_;
    RTCScene handle_;
};

}  // namespace realcam
