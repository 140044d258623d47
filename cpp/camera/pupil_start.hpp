#pragma once
#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// How the pupil is found of a lens that is not the last one.
enum class PupilStart {
    anew,  ///< it is the same after any other lens
    near_last,  ///< in less time, near the last one's edges (see Pupil); anew where the lens stays as it is
};

}  // namespace REALCAM_NAMESPACE
