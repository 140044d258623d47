#pragma once
#include <memory>
#include <utility>

#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// Live view of a scene through a camera that may change with every frame. Only cancel may be called from another
/// thread. Functions throw what those of Session throw.
class LiveView {
public:
    LiveView(std::shared_ptr<Session> session, Assembly scene) : session_(std::move(session)) {
        show(std::move(scene));
    }

    /// Starts a frame with settings.spp more samples of each pixel (see Session::shoot).
    std::shared_ptr<const LiveFrame> shoot(const Camera& camera, const RenderSettings& settings, ToneCurve curve,
                                           const KeepGoing& keep_going = {}, std::shared_ptr<void> in_progress = {});

    /// Sets the scene of the following frames. If it differs from the last one only in instance transforms, the next
    /// frame prepares only these.
    void show(Assembly scene);

    /// Returns the session, which holds the samples of all frames up to the last one. Throws InputError before the
    /// first frame of a scene.
    Session& collected() const;

    /// Returns the picture of all accumulated samples, with the layers of `settings`. The other settings and the camera
    /// must be those of the last frame. Throws as collected.
    Image picture(const Camera& camera, const RenderSettings& settings, const KeepGoing& keep_going = {}) const;

    /// Cancels all frames in progress; may be called from any thread. The next frame begins a new picture.
    void cancel() { session_->cancel(OnCancel::drop); }

private:
    std::shared_ptr<Session> session_;
    Assembly scene_;
    bool has_frame_ = false;  ///< true after the first frame of the current scene
};

}  // namespace REALCAM_NAMESPACE
