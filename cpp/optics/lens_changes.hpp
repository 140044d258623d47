#pragma once
#include <algorithm>
#include <string>
#include <utility>

#include "lens_checks.hpp"

namespace REALCAM_NAMESPACE {

/// The lens with another surface in place of one, counted from 0. All else stays, the film's place too: focused()
/// brings the picture into focus again. A diaphragm that is wide open stays so. Throws InputError where there is no
/// such surface, and LensFileError where the lens cannot be built.
inline LensSystem with_surface(LensSystem lens, int index, Surface surface) {
    const int count = static_cast<int>(lens.surfaces.size());
    if (index < 0 || index >= count)
        throw InputError("there is no surface " + std::to_string(index) + "; the lens has " + std::to_string(count) +
                         ", counted from 0");
    const bool was_open = lens.is_wide_open();
    lens.surfaces[static_cast<std::size_t>(index)] = std::move(surface);
    lens.surfaces.back().thickness = 0;
    validate(lens);
    const double rim = lens.stop().clear_semi_diameter;
    lens.stop_semi_diameter = was_open ? rim : std::min(lens.stop_semi_diameter, rim);
    return lens;
}

/// The lens with other blades, which leave the same area open: its f-number stays. Throws LensFileError.
inline LensSystem with_iris(LensSystem lens, const IrisShape& iris) {
    lens.iris = iris;
    validate(lens);
    return lens;
}

}  // namespace REALCAM_NAMESPACE
