#pragma once
#include <span>
#include <vector>

#include "../prescription/glass.hpp"
#include "../prescription/lens_system.hpp"

// Perturbations of a lens by manufacturing errors (tolerance operands).

namespace REALCAM_NAMESPACE {

/// Returns the glass of a melt whose index at the d line is larger by `index_change` and whose Abbe number is larger by
/// the fraction `abbe_fraction`. Both are met exactly; between the spectral lines the dispersion follows the formula of
/// the glass. Throws InputError if the result is not a valid glass, or if `abbe_fraction` is not 0 and the dispersion
/// of the glass is not known.
Glass with_melt_error(const Glass& glass, double index_change, double abbe_fraction);

/// Kind of manufacturing error, as of a tolerance operand.
enum class PerturbationKind {
    radius,  ///< radius of curvature, mm
    radius_percent,  ///< radius of curvature, percent
    radius_fringes,  ///< sag at the rim, in half wavelengths (kFringeLine_nm)
    thickness,  ///< distance to the next surface, mm; all surfaces that follow move
    index,  ///< refractive index at the d line of the glass behind the surface
    abbe_percent,  ///< Abbe number of that glass, percent
    surface_tilt_x,  ///< tilt of the surface alone about its vertex, about the x axis, degrees
    surface_tilt_y,  ///< likewise about the y axis
    surface_decentre_x,  ///< displacement of the surface alone along x, mm
    surface_decentre_y,  ///< likewise along y
    element_tilt_x,  ///< tilt of surfaces `first` to `last` about the midpoint between them, about the x axis, degrees
    element_tilt_y,  ///< likewise about the y axis
    element_decentre_x,  ///< displacement of surfaces `first` to `last` along x, mm
    element_decentre_y,  ///< likewise along y
    irregularity_0,  ///< astigmatism with the largest sag along x, in half wavelengths from valley to peak
    irregularity_45,  ///< astigmatism like irregularity_0, with the largest sag along x = y
};

/// Perturbation of a surface or element; its size is stated separately.
struct Perturbation {
    PerturbationKind kind;
    int first;  ///< index of the surface, from 0
    int last;  ///< index of the last surface of an element; otherwise equal to `first`

    bool operator==(const Perturbation&) const = default;
};

/// Wavelength of the mercury e line: the unit of fringes in ISO 10110-5 is half of it.
inline constexpr double kFringeLine_nm = 546.07;

/// Returns the perturbed lens. `sizes`: size of each perturbation, in the unit of its kind; size 0 changes nothing.
/// Tilts and decentres do not move the surfaces behind. Errors of surfaces are applied before those of the elements
/// that contain them. Only the existence of the surfaces is checked, so that thousands of copies take little time; for
/// further checks see lens_checks.hpp. Throws InputError if a surface does not exist, or if an error cannot be applied
/// to it.
LensSystem perturbed(const LensSystem& lens, const std::vector<Perturbation>& perturbations,
                     std::span<const double> sizes);

/// Moves surfaces `first` to `last` together, as one rigid body. Each surface gets a placement of its own
/// (move_each_alone), so that it can be moved again. If the axis turns at one of them, as at a fold mirror, this is not
/// possible, and move_element places the surfaces as a whole. Throws InputError as move_element does.
void move_rigidly(LensSystem& lens, int first, int last, const Affine<double>& motion);

}  // namespace REALCAM_NAMESPACE
