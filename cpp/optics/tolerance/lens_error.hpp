#pragma once
#include <vector>

#include "../prescription/glass.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the glass of a melt whose index at the d line is larger by `index` and whose Abbe number is larger by the
/// fraction `abbe`. Both are met exactly, and between the lines the dispersion follows the glass's formula. Throws
/// InputError if the result is no valid glass, or if `abbe` is not 0 and the glass's dispersion is unknown.
Glass with_melt_error(const Glass& glass, double index, double abbe);

/// Kind of manufacturing error.
enum class ErrorKind {
    radius,  ///< radius of curvature, mm
    radius_percent,  ///< radius of curvature, percent
    radius_fringes,  ///< sag at the rim, half wavelengths
    thickness,  ///< to the next surface, mm; all that follows moves with it
    index,  ///< index at the d line of the glass behind the surface
    abbe_percent,  ///< Abbe number of that glass, percent
    surface_tilt_x,
    surface_tilt_y,  ///< about the surface's vertex, degrees; nothing else moves
    surface_decentre_x,
    surface_decentre_y,  ///< mm
    element_tilt_x,
    element_tilt_y,  ///< surfaces `first` to `last` about the midpoint between them, degrees
    element_decentre_x,
    element_decentre_y,  ///< mm
    irregularity_0,  ///< astigmatism, half wavelengths from valley to peak, with the largest sag along x
    irregularity_45,  ///< astigmatism like irregularity_0, with the largest sag along x = y
};

struct LensError {
    ErrorKind kind;
    int first;  ///< surface, from 0
    int last;  ///< last surface of an element; otherwise equal to `first`

    bool operator==(const LensError&) const = default;
};

/// Mercury e line: ISO 10110-5 counts fringes in its half wavelengths.
inline constexpr double kFringeLine_nm = 546.07;

/// Returns the lens with errors of these sizes; errors of size 0 change nothing. Moved surfaces do not move what is
/// behind them. Errors of surfaces are applied before those of the elements that contain them. Checks only that the
/// surfaces exist, so that thousands of copies take little time: see lens_checks.hpp for further checks. Throws
/// InputError if a surface does not exist, or an error cannot be applied to it.
LensSystem with_errors(const LensSystem& lens, const std::vector<LensError>& errors, const double* sizes);

/// Moves surfaces as one rigid piece, like move_element. Each surface gets its own placement, so that it can be moved
/// again, unless the axis turns at one of them (move_each_alone). Throws InputError as move_element does.
void move_pieces(LensSystem& lens, int first, int last, const Affine<double>& motion);

}  // namespace REALCAM_NAMESPACE
