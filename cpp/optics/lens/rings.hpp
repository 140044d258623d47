#pragma once
#include <optional>
#include <string>
#include <variant>

#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// How the rings of a lens are set. A ring without a value stays as it stands.
struct Rings {
    std::variant<std::monostate, std::string, double> zoom;  ///< the name of a position, or a focal length in mm
    std::optional<int> blades;
    std::optional<double> blade_rounding, blade_rotation_deg;
    std::optional<double> f_number;
    bool opens_as_far_as_it_can = false;  ///< where the lens is not as fast as that
    std::optional<double> focus_distance;  ///< mm
};

/// The lens with its rings set: zoom, blades, diaphragm, focus. An f-number is of the lens at infinity, so that the
/// last two commute, but for what focusing rounds. Throws InputError where the lens cannot be so.
LensSystem with_rings(LensSystem lens, const Rings& rings);

/// With the diaphragm as wide as its opening.
LensSystem wide_open(LensSystem lens);

}  // namespace REALCAM_NAMESPACE
