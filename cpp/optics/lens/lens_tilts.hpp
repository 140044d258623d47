#pragma once
#include "../prescription/lens_checks.hpp"

namespace REALCAM_NAMESPACE {

/// True if the surface's placement moves only itself, or if it has no placement yet.
inline bool moves_alone(const Surface& surface) {
    return surface.placement.returns || surface.placement.is_in_place();
}

/// Moves surfaces `first` to `last`, counted from 0, as one rigid piece; all others and the film keep their positions.
/// `motion` is relative to the axis in front of the first surface. Throws InputError if existing placements of the
/// surfaces leave no room for another.
void move_element(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// Moves surfaces like move_element, by placements that move only the surfaces themselves. Returns false, and changes
/// nothing, if the axis turns at one of them.
bool move_each_alone(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// Returns the lens with surfaces `first` to `last`, counted from 0, moved as one rigid piece; all others and the film
/// keep their positions. `placement` is relative to the axis in front of the first surface; it rotates the piece about
/// the point on that axis that lies `pivot` mm behind the surface's vertex. Throws InputError if there are no such
/// surfaces, and LensFileError if the lens cannot be built.
LensSystem with_element_tilted(const LensSystem& lens, int first, int last, const SurfacePlacement& placement,
                               double pivot = 0);

}  // namespace REALCAM_NAMESPACE
