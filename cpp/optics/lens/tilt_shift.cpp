#include "tilt_shift.hpp"

#include "../prescription/lens_checks.hpp"
#include "../prescription/surface_frames.hpp"

namespace realcam {

namespace {

Affine<double> shift(Vec3d by) {
    return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by};
}

/// Frame of the film's vertex on the last axis, before the film's own placement.
Affine<double> film_on_axis(const LensSystem& lens) {
    return surface_frames(lens).last_axis * along_axis(lens.film_distance);
}

}  // namespace

LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot) {
    LensSystem moved = lens;
    SurfacePlacement& front = moved.surfaces.front().placement;
    if (front.returns && !front.is_in_place())
        throw InputError("the lens cannot be tilted or shifted: its first surface is moved alone");
    const Affine<double> film = film_on_axis(lens) * lens.film_placement.frame();
    const Vec3d about = film.origin - Vec3d{0, 0, pivot};
    const Affine<double> motion = shift(about) * move.frame() * shift(-about);
    front = SurfacePlacement::of(motion * front.frame());
    // The film keeps its position: its placement compensates the motion of the last axis.
    moved.film_placement = SurfacePlacement::of(inverse_motion(film_on_axis(moved)) * film);
    validate(moved);
    return moved;
}

LensSystem without_move(LensSystem lens) {
    SurfacePlacement& front = lens.surfaces.front().placement;
    if (!front.returns) front = {};
    lens.film_placement = {};
    return lens;
}

}  // namespace realcam
