#pragma once
#include <vector>

#include "optics/derivatives/lens_variable.hpp"
#include "traced_ray.hpp"

// A lens with surfaces of several forms, and its variables, for tests of derivatives.

namespace realcam::test {

/// Tilts and decentres of a surface.
inline std::vector<LensVariable> tilts_and_decentres(int surface) {
    std::vector<LensVariable> list;
    for (int axis = 0; axis < 3; ++axis) {
        list.push_back({LensQuantity::tilt, surface, axis});
        list.push_back({LensQuantity::decentre, surface, axis});
    }
    return list;
}

/// A sphere, an ellipsoid, an asphere, the stop in glass, a plane.
inline LensSystem mixed_lens() {
    LensSystem lens = lens_of({refracting(40, 4, Glass::constant(1.6), 14), refracting(-70, 3, Glass::air(), 14),
                               refracting(30, 2, Glass::constant(1.7), 12), stop_plane(2, 10),
                               refracting(-50, 4, Glass::constant(1.5), 12), refracting(0, 0, Glass::air(), 12)});
    lens.surfaces[1].conic = 0.5;
    lens.surfaces[2].conic = -0.3;
    lens.surfaces[2].aspheric = {1e-5, -2e-8};
    lens.wavelength_nm = 587.6;
    return lens;
}

/// Curvatures, conics, aspheric terms, indices and thicknesses of mixed_lens().
inline std::vector<LensVariable> shape_variables() {
    std::vector<LensVariable> list;
    for (const int s : {0, 1, 2, 4, 5}) {
        list.push_back({LensQuantity::curvature, s});
        list.push_back({LensQuantity::aspheric, s, 4});
        list.push_back({LensQuantity::aspheric, s, 10});
        if (s != 5) list.push_back({LensQuantity::conic, s});
        list.push_back({LensQuantity::index, s});
    }
    for (const int s : {0, 1, 2, 3, 4}) list.push_back({LensQuantity::thickness, s});
    return list;
}

}  // namespace realcam::test
