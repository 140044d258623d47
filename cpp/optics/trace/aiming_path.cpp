#include "aiming_path.hpp"

#include <limits>

namespace realcam {

AimingPath::AimingPath(const LensPath<double>& path) {
    const LensView<double> view = path.view();
    const auto copy = [&](auto& list, const auto* array) {
        if (array) list.assign(array, array + view.count);
    };
    kind_ = view.kind;
    copy(surfaces_, view.surfaces);
    copy(frames_, view.free.frames);
    copy(freeforms_, view.free.freeforms);
    copy(apertures_, view.free.apertures);
    iris_ = view.iris;
    frames_without_exit_ = frames_;
    for (FrameChanges<double>& frame : frames_without_exit_) frame.out = {};
}

namespace {

/// Removes the rim, the central hole and the iris blades of a surface.
void open_rim(SurfaceView<double>& surface) {
    surface.rim_squared = std::numeric_limits<double>::max();
    surface.hole_squared = -1;
    surface.has_blades = false;
}

}  // namespace

AimingPath AimingPath::open(const LensPath<double>& path) {
    AimingPath result(path);
    for (SurfaceView<double>& surface : result.surfaces_) open_rim(surface);
    result.apertures_.clear();
    return result;
}

AimingPath AimingPath::with_open_stop(const LensPath<double>& path, int stop) {
    AimingPath result(path);
    for (SurfaceView<double>& surface : result.surfaces_)
        if (surface.surface_index == stop) open_rim(surface);
    return result;
}

LensView<double> AimingPath::view() const {
    const auto data_of = [](const auto& list) { return list.empty() ? nullptr : list.data(); };
    return {surfaces_.data(),
            static_cast<int>(surfaces_.size()),
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
