#pragma once
#include <cstddef>
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Interval of wavelengths, nm.
struct WavelengthRange {
    double first, last;  ///< shortest and longest wavelength

    bool operator==(const WavelengthRange&) const = default;
};

namespace known_wavelengths_detail {

/// Formats a wavelength in nm, rounded to a tenth: "656.3".
std::string nm_text(double wavelength_nm);

/// Names a glass of the lens in a message: "the glass of surface 3 (N-BK7) of LENS". `surface`: index from 0.
std::string glass_text(const LensSystem& lens, std::size_t surface);

}  // namespace known_wavelengths_detail

/// Throws InputError, naming the surface and the glass, if the refractive index of a glass is not known over the whole
/// range: outside the points of a table any index would be a guess. `purpose` begins the message.
void check_glasses_known(const LensSystem& lens, WavelengthRange range, const std::string& purpose);

}  // namespace REALCAM_NAMESPACE
