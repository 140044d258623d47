#pragma once
#include <optional>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens focused on an object plane `focus_distance` mm from the film (infinity allowed): real rays from the
/// axial point, over the full aperture, make their smallest RMS spot on the film. Moves the film, or the focusing
/// group. The setting of the diaphragm does not change the focus, as on a camera. The distance of the plane in focus is
/// right to 1e-9 of itself. Throws InputError if the lens cannot focus there, also because glass or film would collide.
LensSystem focused(const LensSystem& lens, double focus_distance);

/// Distance from the last vertex to the film on which distant light makes its smallest RMS spot, mm. Returns
/// std::nullopt if the lens makes no such image.
std::optional<double> film_distance_at_infinity(LensSystem lens);

/// The f-number as engraved: that of the lens focused at infinity, with the current radius of the diaphragm. A group
/// that moves to focus changes focal length and pupil, and the diaphragm ring does not turn with it. If the lens cannot
/// be focused at infinity, returns the f-number of its current state.
double f_number_at_infinity(const LensSystem& lens);

/// Relative amount by which an engraved f-number may lie below the lens's own: it has two digits, and makers round it
/// down.
inline constexpr double kEngravingError = 0.02;

/// Returns the lens with its diaphragm closed to an f-number, defined for the lens at infinity (exact for paraxial
/// rays) whatever it is focused on: closing the diaphragm and focusing commute. A number below the lens's own by no
/// more than kEngravingError is wide open. Throws InputError if the lens is not that fast, or has no f-number.
LensSystem stopped_down(LensSystem lens, double f_number);

}  // namespace REALCAM_NAMESPACE
