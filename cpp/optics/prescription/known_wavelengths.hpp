#pragma once
#include <cstddef>
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Wavelengths from one to another, nm.
struct WavelengthRange {
    double first, last;

    bool operator==(const WavelengthRange&) const = default;
};

namespace known_wavelengths_detail {

std::string nm_text(double wavelength);

std::string glass_text(const LensSystem& lens, std::size_t surface);

}  // namespace known_wavelengths_detail

/// Throws InputError, with the surface and the glass, where a glass is not known at all of these wavelengths: outside
/// the points of a table whatever is said would be a guess.
void check_glasses_known(const LensSystem& lens, WavelengthRange range, const std::string& purpose);

}  // namespace REALCAM_NAMESPACE
