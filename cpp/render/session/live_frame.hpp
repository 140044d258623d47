#pragma once
#include <chrono>
#include <cstdint>

#include "../../camera/film/camera.hpp"
#include "../../checkpoint.hpp"
#include "../../error.hpp"
#include "../../platform.hpp"
#include "../../scene/render_space/render_space_scene.hpp"

namespace REALCAM_NAMESPACE {

/// Part of the scene that a backend has to prepare before the next picture.
enum class SceneChange {
    none,        ///< no part: the scene is the same
    transforms,  ///< instance transforms: RenderSpaceScene::move suffices
    all,         ///< everything: another scene, or the camera is too far from the origin of render space
};

/// Compares the scene and camera of the next picture with the scene of the last one. `last`: null before the first
/// picture.
SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera);

/// Handle of a live frame: a picture of a session, developed to 8 bits, which the device may still be working on. May
/// outlive the session.
class LiveFrame {
public:
    virtual ~LiveFrame() = default;
    virtual int width() const = 0;   ///< pixels
    virtual int height() const = 0;  ///< pixels
    virtual std::int64_t samples() const = 0;  ///< samples per pixel, accumulated up to this frame
    /// Waits until the frame is complete, at most for `timeout`; returns true if it is complete. Throws DeviceError.
    virtual bool wait_for(std::chrono::microseconds timeout) const = 0;
    /// Returns the 8-bit sRGB values, height x width x 3; waits until the frame is complete. Throws DeviceError, and
    /// Cancelled if the frame was stopped before its end.
    virtual const std::uint8_t* codes() const = 0;
};

/// Waits until the frame is complete. Throws Cancelled if `keep_going` returns false, and DeviceError.
void wait(const LiveFrame& frame, const KeepGoing& keep_going);

}  // namespace REALCAM_NAMESPACE
