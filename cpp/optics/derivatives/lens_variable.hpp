#pragma once
#include <vector>

#include "../prescription/lens_limits.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

enum class LensQuantity {
    curvature,      ///< 1/mm
    conic,
    aspheric,  ///< coefficient of r^number, mm^(1 - number)
    thickness,  ///< mm; all that follows moves
    index,  ///< of the medium behind the surface; changes by the same at all wavelengths
    decentre,  ///< mm along x, y, z: number 0, 1, 2
    tilt,  ///< degrees about x, y, z: number 0, 1, 2
    curvature_x,  ///< of a biconic or toroid, 1/mm
    conic_x,  ///< of a biconic
    radial,  ///< coefficient of r^number, mm^(1 - number)
    xy,  ///< coefficient of x^number y^number_y
    terms,  ///< coefficient `number` of the terms of row `row` of kFormTerms
    film_distance,  ///< last vertex to film, mm; `surface` is ignored
};

/// A number of a lens by which functions are differentiated.
///
/// Tilts and decentres of a surface without a placement move that surface alone. Those of a surface with one follow
/// SurfacePlacement::returns.
struct LensVariable {
    LensQuantity quantity = LensQuantity::curvature;
    int surface = 0;  ///< from 0
    int number = 0, number_y = 0;
    int row = 0;

    bool operator==(const LensVariable&) const = default;
};

/// Throws InputError for a surface or number that the lens does not have, and for variables without an effect.
void check_variables(const LensSystem& lens, const std::vector<LensVariable>& variables);

}  // namespace REALCAM_NAMESPACE
