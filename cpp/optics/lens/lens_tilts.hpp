#pragma once
#include "../prescription/lens_checks.hpp"

namespace REALCAM_NAMESPACE {

/// Whether a surface alone is moved by its placement, or by one that it is about to get.
inline bool moves_alone(const Surface& surface) {
    return surface.placement.returns || surface.placement.is_in_place();
}

/// Moves surfaces `first` to `last`, counted from 0, together as one rigid piece; all others and the film stay in their
/// places. The motion is seen from the axis in front of the first surface. Throws InputError where placements that the
/// surfaces have leave no room for another.
void move_element(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// The same by a placement of each surface, which moves nothing else. False, and nothing is done, where the axis turns
/// at one of them.
bool move_each_alone(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// The lens with surfaces `first` to `last`, counted from 0, moved together as one rigid piece; all others and the film
/// stay in their places. The placement is seen from the axis in front of the first surface, and turns the piece about
/// the point that lies `pivot` mm behind that surface's vertex on it. Throws InputError where there are no such
/// surfaces, and LensFileError where the lens cannot be built.
LensSystem with_element_tilted(const LensSystem& lens, int first, int last, const SurfacePlacement& placement,
                               double pivot = 0);

}  // namespace REALCAM_NAMESPACE
