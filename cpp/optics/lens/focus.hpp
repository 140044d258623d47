#pragma once
#include <optional>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens focused on an object plane `focus_distance` mm from the film (infinity allowed): real rays from the
/// axial point, over the full aperture, make their smallest RMS spot on the film. Moves the film, or the focusing
/// group. As on a camera, the lens is focused wide open, whatever the setting of the diaphragm. The distance of the
/// plane in focus is accurate to a relative error of 1e-9. Throws InputError if the lens cannot focus there, also
/// because its faces, or a face and the film, would overlap.
LensSystem focused(const LensSystem& lens, double focus_distance);

/// Returns the distance from the last vertex to the film on which light from infinity makes its smallest RMS spot, mm;
/// std::nullopt if the lens makes no such image.
std::optional<double> film_distance_at_infinity(LensSystem lens);

/// Returns the f-number as engraved on the diaphragm ring: that of the lens focused at infinity, with the current
/// radius of the diaphragm. (Focusing by a group changes the focal length and the pupil, but not the setting of the
/// ring.) If the lens cannot be focused at infinity, returns the f-number of its current state.
double f_number_at_infinity(const LensSystem& lens);

/// Relative amount by which an engraved f-number may lie below the exact one of the lens wide open: it has two digits,
/// and makers round it down.
inline constexpr double kEngravingError = 0.02;

/// Returns the lens with its diaphragm closed to an f-number, which is defined for paraxial rays of the lens focused at
/// infinity, whatever it is focused on: closing the diaphragm and focusing commute. A number below that of the lens
/// wide open by at most a fraction of kEngravingError opens the diaphragm fully. Throws InputError if the lens is not
/// that fast, or has no f-number.
LensSystem stopped_down(LensSystem lens, double f_number);

}  // namespace REALCAM_NAMESPACE
