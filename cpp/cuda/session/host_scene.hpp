#pragma once
#include <memory>
#include <vector>

#include "../../render/session/live_frame.hpp"
#include "device_renderer.hpp"

namespace realcam {

/// The scene that the GPUs of a session hold: the host's copy, which incremental updates need, and its upload.
class HostScene {
public:
    /// Adds a GPU to which scenes are uploaded. Must be called for each GPU before the first scene.
    void add(DeviceRenderer& renderer) { renderers_.push_back(&renderer); }

    /// Returns the kind of update that `place` will perform.
    SceneChange change_to(const Assembly& assembly, const Camera& camera) const {
        return scene_change(placed_.get(), assembly, camera);
    }

    /// Uploads to all GPUs what has changed since the last call: nothing, instance transforms, or the whole scene. The
    /// latter also if the camera is too far from the origin of render space. Throws DeviceError, after which the next
    /// call starts from scratch. Throws Cancelled if `keep_going`, called on any thread, returns false.
    void place(const Assembly& assembly, const Camera& camera, const KeepGoing& keep_going = {});

    /// The scene in render space. Requires a successful `place`.
    const RenderSpaceScene& placed() const { return *placed_; }

private:
    std::vector<DeviceRenderer*> renderers_;
    std::unique_ptr<RenderSpaceScene> placed_;
    SceneBvh bvh_;
};

}  // namespace realcam
