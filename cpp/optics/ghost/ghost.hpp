#pragma once
#include <vector>

#include "../lens/paraxial.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens with its film appended as the last surface: a mirror with the film's curvature and placement, this
/// reflectance and a clear semi-diameter of `radius` mm. For light that the film reflects back into the lens.
LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius);

/// First-order data of a ghost: light that is reflected once by each of two surfaces on its way to the film.
struct GhostPath {
    double effective_focal_length;  ///< mm
    double back_focal_distance;  ///< last vertex to the focus of light from infinity, mm; negative: in front of the
                                 ///< vertex
    ParaxialRay of_height, of_slope;  ///< at the last vertex: the rays with (height, slope) = (1, 0) and (0, 1) at the
                                      ///< first vertex
    /// A surface on the path, and the heights of these two rays there.
    struct Meeting {
        int surface;
        double of_height, of_slope;
    };
    std::vector<Meeting> meetings;  ///< in the order of the light, without the film
};

/// Returns the first-order data of the ghost of a pair of surfaces.
///
/// Traces paraxial rays surface by surface; at each reflection, including those at mirrors, the index changes its sign
/// (R. H. Abd El-Maksoud and J. M. Sasian, "Paraxial ghost image analysis", Proc. SPIE 7428, 742807, 2009). Throws
/// InputError unless the pair is two refracting surfaces, or the film and a refracting surface, in that order, and
/// unless the lens is centred and rotationally symmetric.
GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, GhostPair pair);

}  // namespace REALCAM_NAMESPACE
