#pragma once
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

namespace lens_checks_detail {

[[noreturn]] inline void fail(std::size_t index, const std::string& message) {
    throw LensFileError(message, {}, 0, static_cast<int>(index) + 1);
}

std::string mm(double v);

/// With as many digits as a reader wants.
std::string short_mm(double v);

}  // namespace lens_checks_detail

// What makes a prescription one that cannot be built, and where. Each throws LensFileError, with the surface's number
// where it is about one.

void check_surfaces(const LensSystem& lens);

void check_iris(const IrisShape& iris);

void check_film_size(const LensSystem& lens);

void check_focusing(const LensSystem& lens);

/// That every zoom position is one that can be built.
void check_zoom(const LensSystem& lens);

/// Everything but the place of the film, which may not be known yet. Throws LensFileError.
void validate(const LensSystem& lens);

/// Why the film cannot lie where it does; empty where it can.
/// Throws LensFileError where a film that reaches out to `corner` from the axis, mm, is curved more than that.
void check_film_reach(const LensSystem& lens, double corner);

std::string film_distance_error(const LensSystem& lens);

}  // namespace REALCAM_NAMESPACE
