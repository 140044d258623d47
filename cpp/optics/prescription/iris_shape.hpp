#pragma once
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Blades of an iris diaphragm, independent of its opening. blades = 0: a round diaphragm.
struct IrisShape {
    int blades = 0;
    double rounding = 0;      ///< 0: straight edges; 1: the opening is a circle
    double rotation_rad = 0;  ///< angle of the first blade, from the x axis towards y

    bool operator==(const IrisShape&) const = default;
};

}  // namespace REALCAM_NAMESPACE
