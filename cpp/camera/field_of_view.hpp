#pragma once
#include "../optics/prescription/lens_system.hpp"
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Angle to the axis, in front of the lens, of the light that lands `image_height_mm` from the middle of the film,
/// radians. It is the mean direction of the real rays in the meridional plane. Where few of those tried pass the stop,
/// it is that of the ray through its middle. NaN where no ray from there passes the lens.
double field_angle(const LensSystem& lens, double image_height_mm);

/// The same at the height nearest below it that gets light: a film may be larger than the lens's image.
double widest_field_angle(const LensSystem& lens, double image_height_mm);

}  // namespace REALCAM_NAMESPACE
