#pragma once
#include <vector>

#include "../lens/paraxial.hpp"
#include "../prescription/crossing.hpp"

namespace REALCAM_NAMESPACE {

/// First-order data of light that two surfaces reflect once each on its way to the film.
struct GhostPath {
    double effective_focal_length;  ///< mm
    double back_focal_distance;     ///< last vertex to where light from infinity is focused, mm; negative: before it
    ParaxialRay of_height, of_slope;  ///< at the last vertex, what has height or slope 1 alone at the first one
    /// A surface that it meets, and the heights there of those two rays.
    struct Meeting {
        int surface;
        double of_height, of_slope;
    };
    std::vector<Meeting> meetings;  ///< in its order; the film is none
};

/// The ghost of a pair of surfaces.
///
/// A paraxial ray meets the surfaces one by one; at each reflection, a mirror's too, the index changes its sign (R. H.
/// Abd El-Maksoud and J. M. Sasian, "Paraxial ghost image analysis", Proc. SPIE 7428, 742807, 2009). Throws InputError
/// where the two are not refracting surfaces, or the film and one of these, in that order, and where the lens is no
/// centred one of revolution.
GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, GhostPair pair);

}  // namespace REALCAM_NAMESPACE
