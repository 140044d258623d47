#pragma once
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

namespace lens_checks_detail {

[[noreturn]] inline void fail(std::size_t index, const std::string& message) {
    throw LensFileError(message, {}, 0, static_cast<int>(index) + 1);
}

std::string mm(double v);

/// Formats a length with three significant digits.
std::string short_mm(double v);

}  // namespace lens_checks_detail

// Checks that a prescription can be built. Each function throws LensFileError, with the surface's number if the error
// concerns a surface.

void check_surfaces(const LensSystem& lens);

void check_iris(const IrisShape& iris);

void check_film_size(const LensSystem& lens);

void check_focusing(const LensSystem& lens);

/// Checks that the lens can be built in every zoom position.
void check_zoom(const LensSystem& lens);

/// Checks everything except the film distance, which may not be known yet. Throws LensFileError.
void validate(const LensSystem& lens);

/// Throws LensFileError if the film's radius of curvature is too short for a film that reaches out to `corner` from the
/// axis, mm.
void check_film_reach(const LensSystem& lens, double corner);

/// Returns the reason why the film distance is invalid; empty if it is valid.
std::string film_distance_error(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
