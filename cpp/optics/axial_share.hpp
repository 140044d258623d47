#pragma once
#include <vector>

#include "coated_surface.hpp"
#include "crossing.hpp"

namespace REALCAM_NAMESPACE {

/// What is left of light along the axis that takes this way: the product of what the surfaces reflect and let pass at
/// normal incidence. Throws InputError where an index is not known.
inline double axial_share(const LensSystem& lens, const std::vector<Crossing>& way, double wavelength_nm) {
    const std::vector<double> indices = lens.indices(wavelength_nm);
    double share = 1;
    for (const Crossing& crossing : way) {
        const auto index = static_cast<std::size_t>(crossing.surface);
        if (!lens.surfaces[index].bends_light()) continue;
        const CoatedSurface surface =
            coated_surface(lens, index, wavelength_nm,
                           crossing.in_order ? LightDirection::to_film : LightDirection::to_scene, indices);
        const PolarisedResponse response = surface.at(1);
        share *=
            crossing.is_reflected || surface.is_mirror() ? response.mean_reflectance() : response.mean_transmittance();
    }
    return share;
}

}  // namespace REALCAM_NAMESPACE
