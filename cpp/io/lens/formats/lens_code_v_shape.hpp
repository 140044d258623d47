#pragma once
#include <string>
#include <vector>

#include "../../../optics/prescription/surface.hpp"

namespace realcam::io {

/// What a .seq file says of a surface beside its curvature and thickness.
struct CodeVShape {
    std::string commands;  ///< a line for each
    double constant = 0;  ///< term of the sag, by which the surface has to be moved along its axis
    std::vector<std::string> left_out;  ///< what it has no words for: "has a polygonal aperture, which ..."
};

CodeVShape code_v_shape_of(const Surface& surface);

/// XDE to CDE, and DAR where the placement returns. Empty: it is in place.
std::string code_v_placement(const SurfacePlacement& placement);

}  // namespace realcam::io
