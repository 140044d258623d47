#include "axial_share.hpp"

#include "../coating/coated_surface.hpp"

namespace realcam {

AxialShares::AxialShares(const LensSystem& lens, double wavelength_nm) {
    const std::vector<double> indices = lens.indices(wavelength_nm);
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        std::array<Face, 2> faces;
        if (lens.surfaces[i].bends_light())
            for (const bool in_order : {false, true}) {
                const CoatedSurface surface = coated_surface(
                    lens, i, wavelength_nm, in_order ? LightDirection::to_film : LightDirection::to_scene, indices);
                const PolarisedResponse response = surface.at(1);
                faces[in_order] = {response.mean_reflectance(),
                                   surface.is_mirror() ? response.mean_reflectance() : response.mean_transmittance()};
            }
        surfaces_.push_back(faces);
    }
}

double AxialShares::operator()(const std::vector<Crossing>& crossings) const {
    double share = 1;
    for (const Crossing& crossing : crossings) {
        const Face& face = surfaces_[static_cast<std::size_t>(crossing.surface)][crossing.in_order];
        share *= crossing.is_reflected ? face.reflects : face.sends_on;
    }
    return share;
}

}  // namespace realcam
