#pragma once
#include <algorithm>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Whether all surfaces are of revolution about one axis. What the film does makes no difference.
inline bool has_axis(const LensSystem& lens) {
    return std::ranges::all_of(lens.surfaces, [](const Surface& s) { return s.asymmetry().empty(); });
}

}  // namespace REALCAM_NAMESPACE
