#pragma once
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Start of the pupil search for a lens that differs from the last one.
enum class PupilStart {
    from_scratch,  ///< the result does not depend on the last lens
    near_last,  ///< faster, near the edges of the last pupil (see Pupil); from scratch if the lens is unchanged
};

}  // namespace REALCAM_NAMESPACE
