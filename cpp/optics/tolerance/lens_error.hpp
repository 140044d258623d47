#pragma once
#include <vector>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// One number of a lens that comes out of the factory other than it was drawn.
enum class ErrorKind {
    radius,           ///< of curvature, mm
    radius_percent,   ///< of the radius of curvature
    radius_fringes,   ///< of the sag at the rim, half wavelengths
    thickness,        ///< to the next surface, mm; what is behind it moves with it
    index,            ///< at the d line, of the glass behind the surface
    abbe_percent,     ///< of its Abbe number
    surface_tilt_x,
    surface_tilt_y,          ///< about its vertex, degrees; all else stays
    surface_decentre_x,
    surface_decentre_y,  ///< mm
    element_tilt_x,
    element_tilt_y,          ///< of several surfaces about their middle, degrees
    element_decentre_x,
    element_decentre_y,  ///< mm
    irregularity_0,   ///< astigmatic, half wavelengths from valley to peak, with the largest sag along x
    irregularity_45,  ///< the same, with the largest sag along x = y
};

struct LensError {
    ErrorKind kind;
    int first;  ///< surface, from 0
    int last;   ///< of an element; otherwise the same

    bool operator==(const LensError&) const = default;
};

/// The mercury line e, in whose half wavelengths ISO 10110-5 counts fringes.
inline constexpr double kFringeLine_nm = 546.07;

/// The lens with errors of these sizes; those of 0 change nothing. Surfaces that are moved do not move what is behind
/// them. First come the surfaces' own errors, then those of the elements that they belong to. Nothing is checked but
/// that there are such surfaces, so that thousands of copies take little time: see lens_checks.hpp. Throws InputError.
LensSystem with_errors(const LensSystem& lens, const std::vector<LensError>& errors, const double* sizes);

/// Moves surfaces as one rigid piece, as move_element, each by a placement of its own, so that it can be moved again;
/// where the axis turns at one of them, together. Throws InputError.
void move_pieces(LensSystem& lens, int first, int last, const Affine<double>& motion);

}  // namespace REALCAM_NAMESPACE
