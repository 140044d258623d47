#pragma once
#include <vector>

#include "../lens/paraxial.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens with its film appended as the last surface, for light that the film reflects back into the lens. It
/// is a mirror with the curvature and placement of the film, this reflectance, and a clear semi-diameter of `radius`
/// mm.
LensSystem with_film_mirror(LensSystem lens, double reflectance, double radius);

/// First-order data of a ghost: light that is reflected once by each of two surfaces on its way to the film. Its
/// paraxial rays are described by two basis rays, which have (height, slope) = (1, 0) and (0, 1) at the first vertex.
struct GhostPath {
    double effective_focal_length;  ///< mm
    /// Distance from the last vertex to the focus of light from infinity, mm; negative: in front of the vertex.
    double back_focal_distance;
    ParaxialRay of_height, of_slope;  ///< the two basis rays at the last vertex, behind the lens
    /// A surface on the path, with the heights of the two basis rays there.
    struct SurfaceHeights {
        int surface;  ///< index, from 0
        double of_height, of_slope;  ///< heights, mm
    };
    std::vector<SurfaceHeights> surface_heights;  ///< in the order of the light, without the film
};

/// Returns the first-order data of the ghost that a pair of surfaces causes. `pair`: indices of the surfaces that
/// reflect, in the order of the light; the film has the index after the last surface.
///
/// Traces paraxial rays surface by surface; at each reflection, including those at mirrors, the index changes its sign
/// (R. H. Abd El-Maksoud and J. M. Sasian, "Paraxial ghost image analysis", Proc. SPIE 7428, 742807, 2009). Throws
/// InputError unless the pair is two refracting surfaces, or the film and a refracting surface, in that order, and
/// unless the lens is centred and rotationally symmetric.
GhostPath ghost_path(const LensSystem& lens, double wavelength_nm, GhostPair pair);

}  // namespace REALCAM_NAMESPACE
