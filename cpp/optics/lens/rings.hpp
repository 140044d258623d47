#pragma once
#include <optional>
#include <string>
#include <variant>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Settings of the rings of a lens: zoom, diaphragm and focus, and the shape of the diaphragm blades. A ring without a
/// value keeps its setting.
struct Rings {
    std::variant<std::monostate, std::string, double> zoom;  ///< the name of a position, or a focal length in mm
    std::optional<int> blades;  ///< number of diaphragm blades; 0: round
    std::optional<double> blade_rounding, blade_rotation_deg;  ///< see IrisShape
    std::optional<double> f_number;
    bool opens_as_far_as_it_can = false;  ///< wide open if the lens is slower than `f_number`, instead of an error
    std::optional<double> focus_distance;  ///< object plane to film, mm; may be infinite
};

/// Returns the lens with its rings set in the order zoom, blades, diaphragm, focus. The f-number is that of the lens at
/// infinity, so that the last two commute up to the rounding of focusing. Throws InputError if a setting is impossible.
LensSystem with_rings(LensSystem lens, const Rings& rings);

/// Returns the lens with its diaphragm fully open.
LensSystem wide_open(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
