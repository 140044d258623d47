#include "live_view.hpp"

namespace realcam {

std::shared_ptr<const LiveFrame> LiveView::shoot(const Camera& camera, const RenderSettings& settings, ToneCurve curve,
                                                 const KeepGoing& keep_going, std::shared_ptr<void> in_progress) {
    auto frame = session_->shoot(scene_, camera, settings, curve, keep_going, std::move(in_progress));
    has_frame_ = true;
    return frame;
}

void LiveView::show(Assembly scene) {
    session_->check(scene);
    scene_ = std::move(scene);
    has_frame_ = false;
}

Session& LiveView::collected() const {
    if (!has_frame_) throw InputError("there is no picture yet; shoot() takes one");
    return *session_;
}

Image LiveView::picture(const Camera& camera, const RenderSettings& settings, const KeepGoing& keep_going) const {
    Session& session = collected();
    session.set(scene_, camera, settings, keep_going);
    return session.picture(keep_going);
}

}  // namespace realcam
