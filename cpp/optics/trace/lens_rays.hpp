#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// N rays. Origins in mm; optical directions (unit vectors times the index of the medium that the ray is in); status
/// holds RayStatus values as plain integers.
template <class T, int N>
struct LensRays {
    Vec3Lanes<T, N> origin;
    Vec3Lanes<T, N> direction;
    Lanes<int, N> status;
};

}  // namespace REALCAM_NAMESPACE
