#pragma once
#include "../optics/coating/coating_polynomials.hpp"

namespace REALCAM_NAMESPACE {

/// What the lens's surfaces pass on, in the order in which light meets them. A picture with coatings has either
/// polynomials for its one wavelength, on the way to the scene, or for a spectrum, on both ways. The others are null.
struct CoatingView {
    const CoatingPolynomials<kOneWavelengthTerms>* one_wavelength;
    const CoatingPolynomials<kSpectrumTerms>*to_scene, *to_film;
};

}  // namespace REALCAM_NAMESPACE
