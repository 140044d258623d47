#pragma once
// A scene in Embree's hierarchies and in those of the GPU, on the host.

#include <atomic>

#include "bvh/scene_bvh.hpp"
#include "bvh/traverse_scene.hpp"
#include "bvh_rays.hpp"
#include "embree/embree_scene.hpp"
#include "embree/packet_scene.hpp"

namespace realcam::test {

class EmbreeDevice {
public:
    EmbreeDevice() = default;
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;
    ~EmbreeDevice() { rtcReleaseDevice(device_); }
    operator RTCDevice() const { return device_; }

private:
    RTCDevice device_ = rtcNewDevice(nullptr);
};

class BothTraversals {
public:
    explicit BothTraversals(const Assembly& assembly, TimeInterval exposure = {})
        : on_embree_(embree_, assembly, {0, 0, 0}, exposure, stop_),
          placed_(assembly, {0, 0, 0}, exposure),
          bvh_(build_scene_bvh(placed_)) {
        for (const WideBvh& object : bvh_.objects) objects_.push_back(object.view());
        leaves_ = bvh_instances(bvh_, placed_, objects_);
    }

    PacketScene<SceneKind::any> packets() const {
        return {on_embree_.handle(), static_cast<std::uint32_t>(placed_.instances().size()), RayOrder::incoherent, 0};
    }
    const RenderSpaceScene& placed() const { return placed_; }
    SceneView scene() const { return placed_.view(); }
    SceneBvhView bvh() const { return {bvh_.static_geometry.view(), bvh_.instances.nodes.data(), leaves_.data()}; }

private:
    EmbreeDevice embree_;
    std::atomic<bool> stop_{false};
    EmbreeScene on_embree_;
    RenderSpaceScene placed_;
    SceneBvh bvh_;
    std::vector<WideBvhView> objects_;
    std::vector<BvhInstance> leaves_;
};

/// Rays from around a scene of some 10 m into it, at a time; `number(lane)` of each.
template <int N, class Number>
SceneRays<N> drawn_rays(BvhDraw& draw, float time, Number&& number) {
    SceneRays<N> rays;
    for (int i = 0; i < N; ++i) {
        const Vec3f from = draw.in_cube(25);
        rays.origin.set(i, from);
        rays.direction.set(i, normalized(draw.in_cube(12) - from));
        rays.far[i] = kFarAway;
        rays.active[i] = 1;
        rays.number[i] = number(i);
        rays.time[i] = time;
    }
    return rays;
}

}  // namespace realcam::test
