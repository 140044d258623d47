#pragma once
#include "../../math/lanes.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Status of a ray after a trace. Only `ok` rays left the lens on the far side.
enum class RayStatus : int {
    ok = 0,
    missed = 1,                     ///< does not hit the surface's near cap
    vignetted = 2,                  ///< hits it outside the rim, inside a hole, or behind an iris blade
    total_internal_reflection = 3,  ///< no refracted ray
    no_convergence = 4,             ///< the search on an asphere or freeform did not reach its tolerance
    bad_input = 5,                  ///< origin or direction not finite, or direction of length zero
};

/// N rays. Origins in mm; optical directions (unit vectors times the index of the medium that the ray is in); status
/// holds RayStatus values as plain integers.
template <class T, int N>
struct LensRays {
    Vec3Lanes<T, N> origin;
    Vec3Lanes<T, N> direction;
    Lanes<int, N> status;
};

}  // namespace REALCAM_NAMESPACE
