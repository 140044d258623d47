#pragma once
#include <string>
#include <vector>

#include "../../../optics/prescription/surface.hpp"

namespace realcam::io {

/// Shape of a surface in a .seq file, apart from curvature and thickness.
struct CodeVShape {
    std::string commands;  ///< one per line
    double constant = 0;  ///< constant term of the sag, by which the surface is moved along its axis
    std::vector<std::string> left_out;  ///< features that the format lacks: "has a polygonal aperture, which ..."
};

CodeVShape code_v_shape_of(const Surface& surface);

/// Returns XDE to CDE, and DAR if the placement returns; empty if the surface is neither decentred nor tilted.
std::string code_v_placement(const SurfacePlacement& placement);

}  // namespace realcam::io
