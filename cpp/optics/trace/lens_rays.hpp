#pragma once
#include "../../math/lanes.hpp"
#include "../../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Status of a ray after a trace. Only rays with `ok` passed the whole lens.
enum class RayStatus : int {
    ok = 0,
    missed = 1,  ///< does not hit the near cap of a surface (see SurfaceHit in refraction.hpp)
    vignetted = 2,  ///< hits a surface outside its rim or aperture, inside its hole, or on an iris blade
    total_internal_reflection = 3,  ///< no refracted ray
    no_convergence = 4,  ///< the search on an asphere or freeform did not reach its tolerance
    bad_input = 5,  ///< origin or direction not finite, or direction of length zero
};

/// N rays inside or outside a lens.
template <class T, int N>
struct LensRays {
    Vec3Lanes<T, N> origin;  ///< mm, in the frame of the current surface
    Vec3Lanes<T, N> direction;  ///< optical: unit vectors times the index of the medium that the ray is in
    Lanes<int, N> status;  ///< RayStatus values as plain integers, which vectorise
};

}  // namespace REALCAM_NAMESPACE
