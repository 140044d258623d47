#pragma once
#include <string>

#include "lens_zemax_file.hpp"

namespace realcam::io {

/// Brings what a surface's type, parameters and extra data say of its shape and place into its row. Returns what there
/// is no model of; empty: nothing.
std::string set_zemax_shape(ZemaxSurface& surface, double unit);

/// Brings decentre and spider of its aperture into its row.
void set_zemax_aperture(ZemaxSurface& surface);

/// What a surface is in a .zmx file.
struct ZemaxShape {
    std::string type;
    std::vector<std::string> lines;     ///< its parameters; even aspheres' are the writer's
    std::vector<std::string> aperture;  ///< where it is no circle about the vertex
    std::vector<std::string> left_out;  ///< what no type there has
};
ZemaxShape zemax_shape_of(const Surface& surface);

/// The frame behind a coordinate break: decentre, then tilts about x, y and z; with the other order all of it the other
/// way round.
Affine<double> zemax_break(Vec3d decentre, Vec3d tilt_deg, bool is_reversed);

}  // namespace realcam::io
