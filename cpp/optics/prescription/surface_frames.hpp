#pragma once
#include <vector>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Frames of a lens's surfaces: transforms from the surface's own frame (origin at its vertex) to the lens frame, whose
/// origin is the front vertex before the front surface's own placement.
struct SurfaceFrames {
    std::vector<Affine<double>> surfaces;
    Affine<double> last_axis;  ///< axis behind the last surface, with origin at its vertex; the film is placed along it
};

SurfaceFrames surface_frames(const LensSystem& lens);

/// Transform from the frame of surface `index` + 1 to that of surface `index`. Exactly a translation by the thickness
/// if neither surface is moved.
Affine<double> frame_of_next(const LensSystem& lens, int index);

}  // namespace REALCAM_NAMESPACE
