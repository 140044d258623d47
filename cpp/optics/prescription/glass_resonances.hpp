#pragma once
#include <string>

#include "known_wavelengths.hpp"

namespace REALCAM_NAMESPACE {

/// Wavelengths between the resonances of Sellmeier's formula on either side of the d line, nm. At a resonance the glass
/// is opaque, and beyond it the formula gives numbers that are no glass's index. Other formulas have none.
WavelengthRange between_resonances(const Glass& glass);

/// Throws InputError, with the surface and the glass, at a wavelength at which a glass of the lens is not known. This
/// is outside the points of its table, or at or beyond a resonance of its formula.
void check_wavelength_in_glasses(const LensSystem& lens, double wavelength_nm, const std::string& purpose);

}  // namespace REALCAM_NAMESPACE
