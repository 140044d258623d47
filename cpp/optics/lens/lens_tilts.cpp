#include "lens_tilts.hpp"

#include <string>

#include "../prescription/surface_frames.hpp"
#include "lens_changes.hpp"

namespace realcam {

namespace {

/// Prepends a motion to a surface's own placement. `goes_on`: the surfaces behind follow it.
void put_before(Surface& surface, const Affine<double>& motion, bool goes_on) {
    SurfacePlacement& own = surface.placement;
    own = SurfacePlacement::of(own.is_in_place() ? motion : motion * own.frame());
    own.returns = !goes_on;
}

bool goes_on(const Surface& surface) {
    return !surface.placement.returns || surface.placement.is_in_place();
}

}  // namespace

bool move_each_alone(LensSystem& lens, int first, int last, const Affine<double>& motion) {
    const auto surface = [&](int i) -> Surface& { return lens.surfaces[static_cast<std::size_t>(i)]; };
    for (int i = first; i <= last; ++i)
        if (!moves_alone(surface(i))) return false;
    // Frame of the axis in front of surface i, relative to that in front of the first surface.
    Affine<double> to_here;
    for (int i = first; i <= last; ++i) {
        put_before(surface(i), inverse_motion(to_here) * motion * to_here, false);
        to_here = to_here * along_axis(surface(i).thickness);
    }
    return true;
}

void move_element(LensSystem& lens, int first, int last, const Affine<double>& motion) {
    const auto surface = [&](int i) -> Surface& { return lens.surfaces[static_cast<std::size_t>(i)]; };
    const bool is_at_end = last + 1 == static_cast<int>(lens.surfaces.size());
    const bool may_end = first == last || is_at_end || !goes_on(surface(last + 1));
    if (may_end && move_each_alone(lens, first, last, motion)) return;
    if (is_at_end || !goes_on(surface(first)) || !goes_on(surface(last + 1)))
        throw InputError("surfaces " + std::to_string(first + 1) + " to " + std::to_string(last + 1) +
                         " cannot be moved together: their own placements, or that of the surface behind, leave no "
                         "room for another");
    Affine<double> to_here;
    for (int i = first; i <= last; ++i) {
        if (!surface(i).placement.returns) to_here = to_here * surface(i).placement.frame();
        to_here = to_here * along_axis(surface(i).thickness);
    }
    put_before(surface(first), motion, true);
    put_before(surface(last + 1), inverse_motion(to_here) * inverse_motion(motion) * to_here, true);
}

LensSystem with_element_tilted(const LensSystem& lens, int first, int last, const SurfacePlacement& placement,
                               double pivot) {
    check_surface_exists(lens, first);
    check_surface_exists(lens, last);
    if (last < first) throw InputError("an element goes from a first to a last surface, which does not come before it");
    LensSystem result = lens;
    move_element(result, first, last,
                 pivot == 0 ? placement.frame() : along_axis(pivot) * placement.frame() * along_axis(-pivot));
    validate(result);
    return result;
}

}  // namespace realcam
