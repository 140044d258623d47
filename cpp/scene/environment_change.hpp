#pragma once
#include "scene.hpp"

namespace REALCAM_NAMESPACE {

/// How an environment is to be changed before it lights a scene.
struct EnvironmentChange {
    double scale = 1;         ///< of its light
    double rotation_deg = 0;  ///< about +y, the vertical: counterclockwise as seen from above, so that what lay towards
                              ///< -z lies towards -x after 90 degrees

    bool says_nothing() const { return scale == 1 && rotation_deg == 0; }
};

/// Throws InputError where it is none.
void check_environment_change(const EnvironmentChange& change);

/// By a part of a column, each column takes its share of two, so that the light in all of them is the same as before.
Environment changed(Environment environment, const EnvironmentChange& change);

}  // namespace REALCAM_NAMESPACE
