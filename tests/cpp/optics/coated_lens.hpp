#pragma once
#include <utility>
#include <vector>

#include "optics/coating/coated_surface.hpp"
#include "optics/prescription/coating.hpp"

namespace realcam::test {

/// A quarter, a half and a quarter of a wave, as in docs/coatings.md: the usual form of a broadband coating.
inline Coating three_layers() {
    std::vector<CoatingLayer> layers;
    for (const auto& [index, waves] : {std::pair(1.38, 0.25), {2.1, 0.5}, {1.7, 0.25}}) {
        const CoatingMaterial film = CoatingMaterial::transparent(Glass::constant(index));
        layers.push_back({film, thickness_of_waves(film, waves, 550)});
    }
    return layered_coating(std::move(layers), "three layers");
}

/// A lens with a coating on all faces in air, and aluminium on its mirrors.
inline LensSystem coated(LensSystem lens, const Coating& coating) {
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (is_face_in_air(lens, i)) lens.surfaces[i].coating = coating;
    for (Surface& surface : lens.surfaces)
        if (surface.type == SurfaceType::mirror) surface.coating = *named_coating("aluminium");
    return lens;
}

}  // namespace realcam::test
