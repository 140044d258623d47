#pragma once
#include "../../optics/coating/coating_polynomials.hpp"
#include "diffraction/diffraction_view.hpp"
#include "dispersion/dispersion_view.hpp"
#include "effects.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the lens's surfaces, in the order in which light meets them. A picture with coatings has
/// polynomials either for its one wavelength, towards the scene, or for a spectrum, in both directions. The other
/// pointers are null.
struct CoatingView {
    const CoatingPolynomials<kOneWavelengthTerms>* one_wavelength;
    const CoatingPolynomials<kSpectrumTerms>*to_scene, *to_film;
};

/// Views of the tables for a camera's effects, for the render kernels. The view of an effect that is off is empty.
struct EffectViews {
    Effects effects;  ///< effects for which the camera was set up
    DispersionView dispersion;
    CoatingView coatings;
    DiffractionView diffraction;

    /// Calls move(array, count) for every array. `surfaces`: number of surfaces of the lens.
    template <class Move>
    void move_arrays(int surfaces, Move&& move) {
        move(dispersion.to_scene, surfaces);
        move(dispersion.to_film, surfaces);
        move(dispersion.film_surfaces, surfaces);
        dispersion.film_free.move_arrays(surfaces, move);
        move(dispersion.cells, dispersion.cell_count);
        move(coatings.one_wavelength, surfaces);
        move(coatings.to_scene, surfaces);
        move(coatings.to_film, surfaces);
        const int nodes = diffraction.radii * diffraction.azimuths;
        move(diffraction.nodes, nodes);
        move(diffraction.entries, nodes * kDiffractionEntries);
        move(diffraction.edges, nodes * kDiffractionEdges);
    }
};

}  // namespace REALCAM_NAMESPACE
