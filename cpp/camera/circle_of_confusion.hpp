#pragma once
#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Circle of confusion of a paraxial lens, from two rays whose heights are linear in the distance t in front of the
/// front vertex, mm. The marginal ray from the axial film point through the pupil's rim has the height rim + t *
/// rim_slope. The chief ray from a film height of 1 mm has the height middle + t * middle_slope, the inverse of the
/// magnification at t. So the diameter of the disc on the film is 2 |rim| / |middle|.
struct CircleOfConfusion {
    float rim, rim_slope;
    float middle, middle_slope;
    float least_middle;  ///< least height of the chief ray: that at one pupil radius from the pupil
};

/// Diameter on the film, mm. `distance_mm`: from the front vertex along the axis towards the scene; may be infinite.
REALCAM_INLINE float circle_diameter(const CircleOfConfusion& circle, float distance_mm) {
    if (!(distance_mm < 1e30f)) return 2.0f * std::fabs(circle.rim_slope / circle.middle_slope);
    const float rim = circle.rim + distance_mm * circle.rim_slope;
    const float height = std::fabs(circle.middle + distance_mm * circle.middle_slope);
    return 2.0f * std::fabs(rim) / (height > circle.least_middle ? height : circle.least_middle);
}

}  // namespace REALCAM_NAMESPACE
