#pragma once
#include <array>
#include <vector>

#include "../prescription/crossing.hpp"

namespace REALCAM_NAMESPACE {

/// What is left of light along the axis, for any way through a lens: the product of what the surfaces reflect and let
/// pass at normal incidence.
class AxialShares {
public:
    /// Throws InputError where an index is not known at that wavelength.
    AxialShares(const LensSystem& lens, double wavelength_nm);

    double operator()(const std::vector<Crossing>& way) const;

private:
    /// A surface that bends no light keeps all of it.
    struct Face {
        double reflects = 1;
        double sends_on = 1;  ///< towards the film: what glass lets pass and a mirror reflects
    };
    std::vector<std::array<Face, 2>> surfaces_;  ///< each met against the lens's order, and in it
};

}  // namespace REALCAM_NAMESPACE
