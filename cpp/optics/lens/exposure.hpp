#pragma once
#include <array>
#include <vector>

#include "../../platform.hpp"
#include "../prescription/clearance.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Transmittance of the axial ray along any path through a lens: the product of the surfaces' reflectances and
/// transmittances at normal incidence.
class AxialTransmittance {
public:
    /// Throws InputError if an index is not known at this wavelength.
    AxialTransmittance(const LensSystem& lens, double wavelength_nm);

    /// Returns the transmittance of a path, 0 to 1.
    double operator()(const std::vector<Crossing>& crossings) const;

private:
    /// Powers at normal incidence of a surface for light from one side. Those of stops and apertures are 1.
    struct Face {
        double reflectance = 1;
        double direct = 1;  ///< on the direct path: transmittance of glass, reflectance of a mirror
    };
    std::vector<std::array<Face, 2>> surfaces_;  ///< for each surface; the second index is Crossing::in_order
};

/// Returns the irradiance at the film's centre for unit radiance: the area, in optical direction cosines, of the cone
/// of rays that passes the lens. For an unobstructed lens in air that is pi sin^2(theta'). It is computed with real
/// meridional rays; the iris is treated as round. The film may lie before the last mirror. Throws InputError if the
/// lens is not rotationally symmetric otherwise.
double axis_irradiance(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
