#pragma once
#include "../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// How unsharp the film shows a point, as a paraxial lens has it: two rays from the film that both grow evenly with the
/// distance t before the front vertex, mm. One goes from the axis through the pupil's rim, with height rim + t *
/// rim_slope. The other goes through the pupil's middle from a film height of 1 mm, with height middle + t *
/// middle_slope. What lies at t is as many times smaller on the film as the second ray is high there, so that the disc
/// is 2 |rim| / |middle| wide.
struct CircleOfConfusion {
    float rim, rim_slope;
    float middle, middle_slope;
    float least_middle;  ///< nearer to the pupil than its own radius, the disc of that distance is taken
};

/// Diameter on the film, mm. `distance_mm`: from the front vertex along the axis towards the scene; infinite is
/// allowed.
REALCAM_INLINE float circle_diameter(const CircleOfConfusion& circle, float distance_mm) {
    if (!(distance_mm < 1e30f)) return 2.0f * std::fabs(circle.rim_slope / circle.middle_slope);
    const float rim = circle.rim + distance_mm * circle.rim_slope;
    const float height = std::fabs(circle.middle + distance_mm * circle.middle_slope);
    return 2.0f * std::fabs(rim) / (height > circle.least_middle ? height : circle.least_middle);
}

}  // namespace REALCAM_NAMESPACE
