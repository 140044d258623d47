#pragma once
#include "../optics/coating/coating_polynomials.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the lens's surfaces, in the order in which light meets them. A picture with coatings has
/// polynomials either for its one wavelength, towards the scene, or for a spectrum, in both directions. The other
/// pointers are null.
struct CoatingView {
    const CoatingPolynomials<kOneWavelengthTerms>* one_wavelength;
    const CoatingPolynomials<kSpectrumTerms>*to_scene, *to_film;
};

}  // namespace REALCAM_NAMESPACE
