#include "aiming_path.hpp"

#include <limits>

namespace realcam {

AimingPath::AimingPath(const LensPath<double>& path) {
    const LensView<double> view = path.view();
    const auto copy_of = [&](auto& list, const auto* from) {
        if (from) list.assign(from, from + view.count);
    };
    kind_ = view.kind;
    copy_of(steps_, view.surfaces);
    copy_of(frames_, view.free.frames);
    copy_of(freeforms_, view.free.freeforms);
    copy_of(apertures_, view.free.apertures);
    iris_ = view.iris;
    frames_without_exit_ = frames_;
    for (FrameChanges<double>& frame : frames_without_exit_) frame.out = {};
}

namespace {

void open_rim(SurfaceView<double>& step) {
    step.rim_squared = std::numeric_limits<double>::max();
    step.hole_squared = -1;
    step.has_blades = false;
}

}  // namespace

AimingPath AimingPath::open(const LensPath<double>& path) {
    AimingPath result(path);
    for (SurfaceView<double>& step : result.steps_) open_rim(step);
    result.apertures_.clear();
    return result;
}

AimingPath AimingPath::with_open_stop(const LensPath<double>& path, int stop) {
    AimingPath result(path);
    for (SurfaceView<double>& step : result.steps_)
        if (step.surface_index == stop) open_rim(step);
    return result;
}

LensView<double> AimingPath::view() const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    return {steps_.data(),
            static_cast<int>(steps_.size()),
            kind_,
            iris_,
            {data_of(frames_), data_of(freeforms_), data_of(apertures_)}};
}

LensView<double> AimingPath::first(int count) const {
    LensView<double> view = this->view();
    view.count = count;
    if (view.free.frames) view.free.frames = frames_without_exit_.data();
    return view;
}

}  // namespace realcam
