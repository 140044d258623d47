#pragma once
#include <memory>
#include <utility>

#include "session.hpp"

namespace REALCAM_NAMESPACE {

/// A scene before a camera that changes with every frame. Not for two threads at once, but for cancel. Functions throw
/// what those of Session throw.
class LiveView {
public:
    LiveView(std::shared_ptr<Session> session, Assembly scene) : session_(std::move(session)) {
        show(std::move(scene));
    }

    /// Starts to take settings.spp samples more of each pixel (see Session::shoot).
    std::shared_ptr<const LiveFrame> shoot(const Camera& camera, const RenderSettings& settings, ToneCurve curve,
                                           const KeepGoing& keep_going = {}, std::shared_ptr<void> under_way = {});

    /// The scene of the frames to come. Of one in which only transforms differ, only these are prepared.
    void show(Assembly scene);

    /// What holds all that the frames up to the last have collected. Throws InputError before the first of a scene.
    Session& collected() const;

    /// All that they have collected, with the layers of the settings, which else are those of the last frame, as its
    /// camera is. Throws as collected.
    Image picture(const Camera& camera, const RenderSettings& settings, const KeepGoing& keep_going = {}) const;

    /// Gives up all frames under way, from any thread. The next frame begins a new picture.
    void cancel() { session_->cancel(Collected::drop); }

private:
    std::shared_ptr<Session> session_;
    Assembly scene_;
    bool has_frame_ = false;  ///< of the scene
};

}  // namespace REALCAM_NAMESPACE
