#pragma once
#include <array>
#include <vector>

#include "../prescription/crossing.hpp"

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

}  // namespace REALCAM_NAMESPACE
