#pragma once
#include <algorithm>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// True if all surfaces are surfaces of revolution about one common axis. The film's placement is ignored.
inline bool has_axis(const LensSystem& lens) {
    return std::ranges::all_of(lens.surfaces, [](const Surface& s) { return s.asymmetry().empty(); });
}

}  // namespace REALCAM_NAMESPACE
