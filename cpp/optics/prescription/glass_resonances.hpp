#pragma once
#include <string>

#include "known_wavelengths.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the range between the nearest resonances of Sellmeier's formula on either side of the d line, nm. At a
/// resonance the glass is opaque, and beyond it the formula does not describe the glass. Returns (0, inf) for other
/// formulas.
WavelengthRange between_resonances(const Glass& glass);

/// Throws InputError, naming the surface and the glass, if a glass of the lens is not known at this wavelength: outside
/// the points of its table, or at or beyond a resonance of its formula. `purpose` begins the message.
void check_wavelength_in_glasses(const LensSystem& lens, double wavelength_nm, const std::string& purpose);

}  // namespace REALCAM_NAMESPACE
