#pragma once
#include <limits>
#include <string>
#include <vector>

#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// One position of the zoom ring, with the lens at rest: wide open, and not refocused. Lengths in mm.
struct ZoomPosition {
    std::string name;
    std::vector<double> thicknesses;  ///< thicknesses behind ZoomRange::surfaces, in their order
    double film_distance = 0;  ///< last vertex to film
    double focus_distance = std::numeric_limits<double>::infinity();  ///< object plane to film
    double stop_semi_diameter = 0;  ///< clear semi-diameter of the aperture stop; 0: zooming does not change it

    bool operator==(const ZoomPosition&) const = default;
};

/// Thicknesses that the zoom ring changes. `positions` is empty for a lens of fixed focal length.
struct ZoomRange {
    std::vector<int> surfaces;  ///< surfaces whose thicknesses change, also by focusing; from 0, ascending
    std::vector<ZoomPosition> positions;
    int current = 0;  ///< index of the lens's current position

    bool operator==(const ZoomRange&) const = default;
};

}  // namespace REALCAM_NAMESPACE
