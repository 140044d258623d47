#pragma once
#include <memory>
#include <vector>

#include "../render/scene_change.hpp"
#include "device_renderer.hpp"

namespace realcam {

/// The scene that some GPUs have, and what of it the host needs to change it.
class HostScene {
public:
    /// Once for each GPU, before the first scene.
    void add(DeviceRenderer& renderer) { renderers_.push_back(&renderer); }

    /// What `place` will have to do.
    SceneChange change_to(const Assembly& assembly, const Camera& camera) const {
        return scene_change(placed_.get(), assembly, camera);
    }

    /// Copies what has changed: nothing, the transforms of instances, or everything; the latter also for a camera that
    /// is too far from the place of the last. Throws DeviceError; the next call begins anew then.
    /// Throws Cancelled where `keep_going`, asked on any thread, returns false.
    void place(const Assembly& assembly, const Camera& camera, const KeepGoing& keep_going = {});

    const RenderSpaceScene& placed() const { return *placed_; }

private:
    std::vector<DeviceRenderer*> renderers_;
    std::unique_ptr<RenderSpaceScene> placed_;
    SceneBvh bvh_;
};

}  // namespace realcam
