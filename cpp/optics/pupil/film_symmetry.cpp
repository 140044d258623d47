#include "film_symmetry.hpp"

#include <cmath>

namespace realcam {

bool has_radial_pupil(const LensSystem& lens) {
    return lens.is_rotational() && std::isinf(lens.film_radius_of_curvature);
}

void require_radial_pupil(const LensSystem& lens, const std::string& what) {
    if (!has_radial_pupil(lens))
        throw InputError(what + " needs a rotationally symmetric lens with a flat film; " +
                         (lens.is_rotational() ? "its film is curved" : lens.asymmetry()));
}

MirrorPlanes mirror_planes(const LensSystem& lens) {
    MirrorPlanes planes{true, true};
    const auto clear_broken_symmetries = [&](const SurfacePlacement& placement) {
        const auto& [decentre, tilt, returns] = placement;
        planes.x &= decentre.x == 0 && tilt.y == 0 && tilt.z == 0;
        planes.y &= decentre.y == 0 && tilt.x == 0 && tilt.z == 0;
    };
    for (const Surface& surface : lens.surfaces) {
        clear_broken_symmetries(surface.placement);
        for (const XyTerm& term : surface.form.xy) {
            planes.x &= term.x % 2 == 0;
            planes.y &= term.y % 2 == 0;
        }
        const ApertureShape& aperture = surface.aperture_shape;
        planes.x &= aperture.offset.x == 0;
        planes.y &= aperture.offset.y == 0;
        // Shapes of these kinds can be symmetric, but rarely are.
        bool is_asymmetric = false;
        for_each_present_terms(surface.form, [&](const auto& terms) { is_asymmetric |= *terms.words.asymmetry != 0; });
        if (is_asymmetric || aperture.kind == ApertureOutline::polygon || !aperture.obscurations.empty()) return {};
    }
    clear_broken_symmetries(lens.film_placement);
    return planes;
}

}  // namespace realcam
