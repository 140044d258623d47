#include "glass_resonances.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

WavelengthRange between_resonances(const Glass& glass) {
    WavelengthRange range{0, kInfinity};
    const Glass::Parts parts = glass.parts();
    if (parts.formula != Glass::Formula::sellmeier) return range;
    for (std::size_t i = 1; i < parts.coefficients.size(); i += 2) {
        if (!(parts.coefficients[i] > 0)) continue;
        const double resonance = 1000 * std::sqrt(parts.coefficients[i]);  // C = wavelength^2, um^2
        if (resonance < kLineD_nm)
            range.first = std::max(range.first, resonance);
        else
            range.last = std::min(range.last, resonance);
    }
    return range;
}

void check_wavelength_in_glasses(const LensSystem& lens, double wavelength_nm, const std::string& purpose) {
    using namespace known_wavelengths_detail;
    check_glasses_known(lens, {wavelength_nm, wavelength_nm}, purpose);
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        if (lens.surfaces[i].type != SurfaceType::refracting) continue;
        const Glass& glass = lens.surfaces[i].material;
        const WavelengthRange range = between_resonances(glass);
        if (wavelength_nm > range.first && wavelength_nm < range.last) continue;
        throw InputError(purpose + ": " + glass_text(lens, i) +
                         (wavelength_nm <= range.first
                              ? " lets no light pass below its resonance at " + nm_text(range.first)
                              : " lets no light pass above its resonance at " + nm_text(range.last)) +
                         " nm; " + nm_text(wavelength_nm) + " nm was requested");
    }
}

}  // namespace realcam
