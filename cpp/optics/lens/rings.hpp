#pragma once
#include <optional>
#include <string>
#include <variant>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Settings of a lens's rings. A ring without a value keeps its setting.
struct Rings {
    std::variant<std::monostate, std::string, double> zoom;  ///< the name of a position, or a focal length in mm
    std::optional<int> blades;
    std::optional<double> blade_rounding, blade_rotation_deg;
    std::optional<double> f_number;
    bool opens_as_far_as_it_can = false;  ///< wide open if the lens is slower than `f_number`, instead of an error
    std::optional<double> focus_distance;  ///< mm
};

/// Returns the lens with its rings set: zoom, blades, diaphragm, focus. The f-number is that of the lens at infinity,
/// so that the last two commute up to the rounding of focusing. Throws InputError if a setting is impossible.
LensSystem with_rings(LensSystem lens, const Rings& rings);

/// Returns the lens with its diaphragm fully open.
LensSystem wide_open(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
