#pragma once
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Frames of a lens's surfaces, each from the surface's own frame (vertex in the origin) to the lens frame. That begins
/// at the front vertex as it would stand without its placement.
struct SurfaceFrames {
    std::vector<Affine<double>> surfaces;
    Affine<double> last_axis;  ///< of the axis behind the last surface, from its vertex on: the film stands on it
};

SurfaceFrames surface_frames(const LensSystem& lens);

/// From the frame of surface `index` + 1 to that of surface `index`. Where neither surface is moved, exactly the
/// thickness.
Affine<double> frame_of_next(const LensSystem& lens, int index);

}  // namespace REALCAM_NAMESPACE
