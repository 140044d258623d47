#pragma once
#include <utility>
#include <vector>

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

}  // namespace realcam::test
