#pragma once
#include <string>

#include "lens_zemax_file.hpp"

namespace realcam::io {

/// Converts a surface's type, parameters and extra data to the shape and placement in its row. Returns the feature that
/// is not modelled, or an empty string.
std::string set_zemax_shape(ZemaxSurface& surface, double unit);

/// Converts the decentre and the spider of a surface's aperture to its row.
void set_zemax_aperture(ZemaxSurface& surface);

/// Shape of a surface in a .zmx file.
struct ZemaxShape {
    std::string type;
    /// Lines of its parameters, except those of even aspheres, which the writer adds.
    std::vector<std::string> lines;
    std::vector<std::string> aperture;  ///< lines of its aperture, if that is not a circle about the vertex
    std::vector<std::string> left_out;  ///< features that no surface type supports
};
ZemaxShape zemax_shape_of(const Surface& surface);

/// Returns the frame after a coordinate break: decentre, then tilts about x, y and z; in the reverse order if
/// `is_reversed`.
Affine<double> zemax_break(Vec3d decentre, Vec3d tilt_deg, bool is_reversed);

}  // namespace realcam::io
