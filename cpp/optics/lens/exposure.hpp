#pragma once
#include <array>
#include <vector>

#include "../../platform.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the axial ray along any path through a lens: the product of the surfaces' reflectances and
/// transmittances at normal incidence.
class AxialShares {
public:
    /// Throws InputError if an index is not known at this wavelength.
    AxialShares(const LensSystem& lens, double wavelength_nm);

    double operator()(const std::vector<Crossing>& crossings) const;

private:
    /// Stops and apertures, which bend no light, have no losses.
    struct Face {
        double reflects = 1;
        double sends_on = 1;  ///< on the direct path: transmittance of glass, reflectance of a mirror
    };
    std::vector<std::array<Face, 2>> surfaces_;  ///< for each surface, indexed by Crossing::in_order
};

/// Irradiance at the film's centre for unit radiance: the area that passes the lens in direction cosines, pi
/// sin^2(theta') less a central obstruction. Computed with real meridional rays; the iris is treated as round. Throws
/// InputError unless the lens is a centred lens of revolution.
double axis_irradiance(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
