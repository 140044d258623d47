#pragma once
#include <limits>
#include <string>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// One position of the zoom ring, with the lens at rest: wide open, and not refocused. Lengths in mm.
struct ZoomPosition {
    std::string name;
    std::vector<double> thicknesses;  ///< behind the surfaces of ZoomRange, in their order
    double film_distance = 0;         ///< last vertex to film
    double focus_distance = std::numeric_limits<double>::infinity();  ///< object plane to film
    double stop_semi_diameter = 0;  ///< clear semi-diameter of the aperture stop; 0: zooming does not change it

    bool operator==(const ZoomPosition&) const = default;
};

/// What the zoom ring changes. A lens of fixed focal length has no positions.
struct ZoomRange {
    std::vector<int> surfaces;  ///< whose thicknesses change, from 0, ascending; those that focusing changes among them
    std::vector<ZoomPosition> positions;
    int current = 0;  ///< the position in which the lens is

    bool operator==(const ZoomRange&) const = default;
};

}  // namespace REALCAM_NAMESPACE
