#pragma once
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// Edit of an environment before rendering.
struct EnvironmentChange {
    double scale = 1;  ///< factor of its radiance
    double rotation_deg = 0;  ///< About +y, the vertical, counterclockwise seen from above: 90 degrees take -z to -x.

    bool says_nothing() const { return scale == 1 && rotation_deg == 0; }
};

/// Throws InputError if the scale is not a positive number or the rotation not finite.
void check_environment_change(const EnvironmentChange& change);

/// Returns the scaled and rotated environment. A rotation by a fraction of a column interpolates linearly between
/// neighbours, which preserves the total light.
Environment changed(Environment environment, const EnvironmentChange& change);

}  // namespace REALCAM_NAMESPACE
