#pragma once
#include <chrono>
#include <cstdint>

#include "../../camera/film/camera.hpp"
#include "../../checkpoint.hpp"
#include "../../error.hpp"
#include "../../platform.hpp"
#include "../../scene/render_space/render_space_scene.hpp"

namespace REALCAM_NAMESPACE {

/// Work of a backend before the next picture.
enum class SceneChange {
    none,
    transforms,  ///< RenderSpaceScene::move suffices
    all,     ///< another scene, or a camera too far from the position of the last
};

/// Compares a scene with that of the last picture. `last`: null before the first.
SceneChange scene_change(const RenderSpaceScene* last, const Assembly& scene, const Camera& camera);

/// One picture of a session while the device works on it. May outlive the session.
class LiveFrame {
public:
    virtual ~LiveFrame() = default;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual std::int64_t samples() const = 0;  ///< per pixel, accumulated up to this frame
    /// Waits until the frame is complete, at most for `longest`; returns true if it is. Throws DeviceError.
    virtual bool wait_for(std::chrono::microseconds longest) const = 0;
    /// height x width x 3, 8-bit sRGB; waits until the frame is complete. Throws DeviceError, and Cancelled if the
    /// frame was stopped before its end.
    virtual const std::uint8_t* codes() const = 0;
};

/// Waits until the frame is complete. Throws Cancelled if `keep_going` returns false, and DeviceError.
void wait(const LiveFrame& frame, const KeepGoing& keep_going);

}  // namespace REALCAM_NAMESPACE
