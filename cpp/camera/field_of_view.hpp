#pragma once
#include "../optics/prescription/lens_system.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Angle to the axis, in front of the lens, of the light that reaches the film at `image_height_mm` from the axis,
/// radians: the mean direction of real meridional rays or, if few of those traced pass the stop, the direction of the
/// chief ray. NaN if no ray from there passes the lens.
double field_angle(const LensSystem& lens, double image_height_mm);

/// field_angle at the largest height, in steps of 2%, that receives light: a film may be larger than the lens's image.
/// 0 if no height does.
double widest_field_angle(const LensSystem& lens, double image_height_mm);

}  // namespace REALCAM_NAMESPACE
