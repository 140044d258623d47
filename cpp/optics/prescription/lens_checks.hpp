#pragma once
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

namespace lens_checks_detail {

/// Throws LensFileError with the message for surface `index` + 1.
[[noreturn]] inline void fail(std::size_t index, const std::string& message) {
    throw LensFileError(message, {}, 0, static_cast<int>(index) + 1);
}

/// Formats a length in mm with nine significant digits: "12.5 mm".
std::string mm(double v);

/// Formats a length in mm with three significant digits.
std::string short_mm(double v);

}  // namespace lens_checks_detail

// Checks that a prescription can be built. Each function throws LensFileError, with the surface's number if the error
// concerns a surface.

/// Checks each surface, its material, coating and placement, the number of stops and mirrors, and, unless
/// LensSystem::allow_overlap is set, that no faces overlap.
void check_surfaces(const LensSystem& lens);

/// Checks the number of blades, their rounding and rotation.
void check_iris(const IrisShape& iris);

/// Checks the film's size, placement and radius of curvature.
void check_film_size(const LensSystem& lens);

/// Checks that the focusing group is a range of the lens's surfaces.
void check_focusing(const LensSystem& lens);

/// Checks that the lens can be built in every zoom position.
void check_zoom(const LensSystem& lens);

/// Makes all of these checks, and checks the design wavelength and the settings of focus and stop: everything except
/// the film distance, which may not be known yet.
void validate(const LensSystem& lens);

/// Throws LensFileError if the film's radius of curvature is too short for a film that reaches out to `corner` from the
/// axis, mm.
void check_film_reach(const LensSystem& lens, double corner);

/// Returns the reason why the film distance is invalid; empty if it is valid.
std::string film_distance_error(const LensSystem& lens);

/// Like validate(lens), and checks the film distance.
void validate_with_film(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
