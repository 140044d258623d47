#pragma once
#include <optional>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The lens focused on an object plane `focus_distance` mm from the film (infinity allowed): real rays from the axial
/// point, over the full aperture, make their smallest spot on the film. Moves the film, or the focusing group.
/// A diaphragm that is closed does not refocus the lens, as on a camera.
/// Throws InputError where the lens cannot, also because glass or film are in the way. The object plane lies within
/// 1e-9 of its distance where it was asked for.
LensSystem focused(const LensSystem& lens, double focus_distance);

/// Last vertex to the film on which distant light makes its smallest spot; nothing where the lens makes no such image.
std::optional<double> film_distance_at_infinity(LensSystem lens);

/// The f-number as it is engraved: of the lens focused at infinity, with the diaphragm as it stands. A group that moves
/// to focus changes focal length and pupil, and the ring of the diaphragm does not turn with it. A lens that cannot be
/// focused at infinity has the f-number that it has as it stands.
double f_number_at_infinity(const LensSystem& lens);

/// By how much the f-number that is engraved may lie below the lens's own: it has two digits, and makers round it down.
inline constexpr double kEngravingError = 0.02;

/// The lens with its diaphragm closed to an f-number, of the lens at infinity (exact for paraxial rays), whatever it is
/// focused on: closing the diaphragm and focusing commute. A number below the lens's own by no more than
/// kEngravingError is wide open. Throws InputError where the lens is not as fast, or has no f-number.
LensSystem stopped_down(LensSystem lens, double f_number);

}  // namespace REALCAM_NAMESPACE
