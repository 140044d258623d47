#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "../prescription/lens_checks.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the lens moved as a whole in front of a fixed film, like the front standard of a view camera or a tilt-shift
/// lens. The lens frame, and with it the camera's pose, remains that of the film. `move` is relative to the lens frame;
/// it rotates the lens about the point `pivot` mm in front of the film's centre, on the axis through it. Throws
/// InputError if the first surface is moved alone, and LensFileError if the lens cannot be built.
LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot = 0);

/// Returns the lens without the motion of the whole lens, and with the film centred on the last axis.
LensSystem without_move(LensSystem lens);

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

/// Throws InputError if the lens has no surface of this index, counted from 0.
void check_surface_exists(const LensSystem& lens, int index);

namespace lens_changes_detail {

/// Applies a change of a value to the zoom positions: to all of them if zooming does not change the value, otherwise to
/// the current one.
template <class Get>
void change_zoom_value(ZoomRange& zoom, double change, const Get& value) {
    const double first = value(zoom.positions.front());
    const bool same = std::all_of(zoom.positions.begin(), zoom.positions.end(),
                                  [&](ZoomPosition& position) { return value(position) == first; });
    for (std::size_t i = 0; i < zoom.positions.size(); ++i)
        if (same || static_cast<int>(i) == zoom.current) value(zoom.positions[i]) += change;
}

}  // namespace lens_changes_detail

/// Returns the lens with some surfaces replaced, by their indices from 0. Everything else is unchanged, also the film's
/// position: focused() restores the focus. If zooming changes a replaced thickness, only that of the current position
/// is changed. A diaphragm that is wide open stays so. Throws InputError if there is no such surface, and LensFileError
/// if the lens cannot be built.
LensSystem with_surfaces(LensSystem lens, const std::map<int, Surface>& surfaces);

/// Returns the lens with one surface replaced (with_surfaces).
inline LensSystem with_surface(LensSystem lens, int index, const Surface& surface) {
    return with_surfaces(std::move(lens), {{index, surface}});
}

/// Returns the lens with other diaphragm blades and the same open area: its f-number is unchanged. Throws LensFileError
/// if the blades are invalid.
LensSystem with_iris(LensSystem lens, const IrisShape& iris);

/// Changes the given properties of the diaphragm blades and keeps the others. Throws InputError if a round diaphragm
/// gets a rounding or rotation without `blades`, and LensFileError if the blades are invalid.
LensSystem with_iris(LensSystem lens, std::optional<int> blades, std::optional<double> rounding,
                     std::optional<double> rotation_deg);

/// Returns the lens with a coating on all faces that it suits: a mirror coating on all mirrors, any other on all faces
/// between air and glass; `unknown` removes the coatings of both. Cemented faces are unchanged. Throws InputError if
/// the lens has no such face.
LensSystem with_coating(LensSystem lens, const Coating& coating);

/// Returns the lens with a coating on these surfaces, counted from 0. Throws InputError if there is no such surface,
/// and LensFileError if the coating does not suit it.
LensSystem with_coating(LensSystem lens, const Coating& coating, const std::vector<int>& surfaces);

}  // namespace REALCAM_NAMESPACE
