#pragma once
#include <cstddef>
#include <string>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Interval of wavelengths, nm.
struct WavelengthRange {
    double first, last;

    bool operator==(const WavelengthRange&) const = default;
};

namespace known_wavelengths_detail {

std::string nm_text(double wavelength);

std::string glass_text(const LensSystem& lens, std::size_t surface);

}  // namespace known_wavelengths_detail

/// Throws InputError, naming the surface and the glass, if a glass is not known over the whole range: outside the
/// points of a table any index would be a guess. `purpose` begins the message.
void check_glasses_known(const LensSystem& lens, WavelengthRange range, const std::string& purpose);

}  // namespace REALCAM_NAMESPACE
