#include "surface_frames.hpp"

namespace realcam {

namespace {

const Surface& surface_of(const LensSystem& lens, int index) {
    return lens.surfaces[static_cast<std::size_t>(index)];
}

}  // namespace

SurfaceFrames surface_frames(const LensSystem& lens) {
    SurfaceFrames result;
    Affine<double> axis;
    for (const Surface& s : lens.surfaces) {
        const Affine<double> frame = axis * s.placement.frame();
        result.surfaces.push_back(frame);
        if (!s.placement.returns) axis = frame;
        result.last_axis = axis;
        axis = axis * along_axis(s.thickness);
    }
    return result;
}

Affine<double> frame_of_next(const LensSystem& lens, int index) {
    const Surface &here = surface_of(lens, index), &next = surface_of(lens, index + 1);
    const Affine<double> to_next = along_axis(here.thickness) * next.placement.frame();
    return here.placement.returns ? inverse_motion(here.placement.frame()) * to_next : to_next;
}

}  // namespace realcam
