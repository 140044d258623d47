#pragma once
#include <vector>

#include "../prescription/lens_limits.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Quantity of a lens prescription that can be a variable.
enum class LensQuantity {
    curvature,  ///< 1/mm
    conic,  ///< conic constant
    aspheric,  ///< coefficient of r^number, mm^(1 - number)
    thickness,  ///< distance to the next surface, mm; all surfaces that follow move
    index,  ///< refractive index of the medium behind the surface; changes by the same amount at all wavelengths
    decentre,  ///< mm along x, y, z: number 0, 1, 2
    tilt,  ///< degrees about x, y, z: number 0, 1, 2
    curvature_x,  ///< curvature in the x-z plane of a biconic or toroid, 1/mm
    conic_x,  ///< conic constant in the x-z plane of a biconic
    radial,  ///< coefficient of r^number, mm^(1 - number)
    xy,  ///< coefficient of x^number y^number_y
    terms,  ///< coefficient `number` of the kind of terms with index `row` in kFormTerms (surface_form.hpp)
    film_distance,  ///< distance from the last vertex to the film, mm; `surface` is ignored
};

/// A number of a lens prescription by which functions are differentiated.
///
/// Tilts and decentres of a surface without a placement move that surface alone. Those of a surface with one follow
/// SurfacePlacement::returns.
struct LensVariable {
    LensQuantity quantity = LensQuantity::curvature;
    int surface = 0;  ///< index, from 0
    int number = 0, number_y = 0;  ///< power, axis, or coefficient index; see LensQuantity
    int row = 0;  ///< only for LensQuantity::terms

    bool operator==(const LensVariable&) const = default;
};

/// Throws InputError if a variable refers to a surface or number that the lens does not have, or has no effect.
void check_variables(const LensSystem& lens, const std::vector<LensVariable>& variables);

}  // namespace REALCAM_NAMESPACE
