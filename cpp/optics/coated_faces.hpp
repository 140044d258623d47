#pragma once
#include <cstddef>

#include "lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// The medium in front of a surface, on the light's way to the film.
inline const Glass& medium_before(const LensSystem& lens, std::size_t index) {
    static const Glass air = Glass::air();
    for (std::size_t i = index; i-- > 0;)
        if (lens.surfaces[i].type == SurfaceType::refracting) return lens.surfaces[i].material;
    return air;
}

/// Whether a refracting surface has air on one side and something else on the other: the faces that are coated.
/// Two glasses that touch are cemented, and so bare unless the lens says otherwise.
inline bool is_face_in_air(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.type == SurfaceType::refracting && medium_before(lens, index).is_air() != surface.material.is_air();
}

/// Whether light meets a face there of which the lens does not say how it is coated.
inline bool has_unknown_coating(const LensSystem& lens, std::size_t index) {
    const Surface& surface = lens.surfaces[index];
    return surface.coating.kind == CoatingKind::unknown &&
           (surface.type == SurfaceType::mirror || is_face_in_air(lens, index));
}

}  // namespace REALCAM_NAMESPACE
