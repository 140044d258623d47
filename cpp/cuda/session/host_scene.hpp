#pragma once
#include <memory>
#include <vector>

#include "../../render/session/live_frame.hpp"
#include "device_renderer.hpp"

namespace realcam {

/// Host side of the scene that some GPUs hold, kept for incremental updates.
class HostScene {
public:
    /// Must be called once for each GPU, before the first scene.
    void add(DeviceRenderer& renderer) { renderers_.push_back(&renderer); }

    /// Returns the kind of update that `place` will perform.
    SceneChange change_to(const Assembly& assembly, const Camera& camera) const {
        return scene_change(placed_.get(), assembly, camera);
    }

    /// Updates the GPUs: nothing, instance transforms, or the whole scene, the latter also if the camera is too far
    /// from its previous position. Throws DeviceError, after which the next call starts from scratch. Throws Cancelled
    /// if `keep_going`, called on any thread, returns false.
    void place(const Assembly& assembly, const Camera& camera, const KeepGoing& keep_going = {});

    const RenderSpaceScene& placed() const { return *placed_; }

private:
    std::vector<DeviceRenderer*> renderers_;
    std::unique_ptr<RenderSpaceScene> placed_;
    SceneBvh bvh_;
};

}  // namespace realcam
