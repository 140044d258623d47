#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "../prescription/lens_checks.hpp"
#include "../prescription/lens_system.hpp"

namespace REALCAM_NAMESPACE {

// Changes of a lens that keep the number and order of its surfaces.

/// Returns the lens moved as a whole in front of a fixed film, like the front standard of a view camera or a tilt-shift
/// lens. The lens frame, and with it the camera's pose, remains that of the film. `move` is relative to the lens frame;
/// it rotates the lens about the point `pivot` mm in front of the film's centre, on the z direction through it. Throws
/// InputError if the first surface has a placement that moves only itself, and LensFileError if the lens cannot be
/// built.
LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot = 0);

/// Returns the lens without the motion of with_lens_moved, and with the film centred on the last axis.
LensSystem without_move(LensSystem lens);

/// True if the surface's placement moves only itself, or if the surface is in its place.
inline bool moves_alone(const Surface& surface) {
    return surface.placement.returns || surface.placement.is_in_place();
}

/// Moves surfaces `first` to `last`, counted from 0, as one rigid piece; all others and the film keep their positions.
/// `motion`: rigid motion in the frame of the axis in front of the first surface. Throws InputError if existing
/// placements of the surfaces cannot be combined with this one.
void move_element(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// Moves surfaces like move_element, by placements that move only the surfaces themselves. Returns false, and changes
/// nothing, if the placement of one of them also moves the surfaces behind it, as at a fold mirror.
bool move_each_alone(LensSystem& lens, int first, int last, const Affine<double>& motion);

/// Returns the lens with surfaces `first` to `last`, counted from 0, moved as one rigid piece; all others and the film
/// keep their positions. `placement` is relative to the axis in front of the first surface; it rotates the piece about
/// the point on that axis that lies `pivot` mm behind the surface's vertex. Throws InputError if there are no such
/// surfaces or move_element refuses, and LensFileError if the lens cannot be built.
LensSystem with_element_tilted(const LensSystem& lens, int first, int last, const SurfacePlacement& placement,
                               double pivot = 0);

/// Throws InputError if the lens has no surface of this index, counted from 0.
void check_surface_exists(const LensSystem& lens, int index);

namespace lens_changes_detail {

/// Adds `change` to a value of the zoom positions: of all of them if zooming does not change the value, otherwise of
/// the current one. `value(position)` returns a reference to the value.
template <class Get>
void change_zoom_value(ZoomRange& zoom, double change, const Get& value) {
    const double first = value(zoom.positions.front());
    const bool is_constant = std::all_of(zoom.positions.begin(), zoom.positions.end(),
                                         [&](ZoomPosition& position) { return value(position) == first; });
    for (std::size_t i = 0; i < zoom.positions.size(); ++i)
        if (is_constant || static_cast<int>(i) == zoom.current) value(zoom.positions[i]) += change;
}

}  // namespace lens_changes_detail

/// Returns the lens with some surfaces replaced; the keys are their indices from 0. Everything else is unchanged, also
/// the film's distance from the last vertex: focused() restores the focus. If zooming changes a replaced thickness,
/// only that of the current position is changed. A diaphragm that is wide open remains wide open. Throws InputError if
/// there is no such surface, and LensFileError if the lens cannot be built.
LensSystem with_surfaces(LensSystem lens, const std::map<int, Surface>& surfaces);

/// Returns the lens with one surface replaced (with_surfaces).
inline LensSystem with_surface(LensSystem lens, int index, const Surface& surface) {
    return with_surfaces(std::move(lens), {{index, surface}});
}

/// Returns the lens with other diaphragm blades and the same open area: its f-number is unchanged. Throws LensFileError
/// if the blades are invalid.
LensSystem with_iris(LensSystem lens, const IrisShape& iris);

/// Returns the lens with the given properties of the diaphragm blades; std::nullopt keeps a property. Throws InputError
/// if a round diaphragm gets a rounding or rotation without `blades`, and LensFileError if the blades are invalid.
LensSystem with_iris(LensSystem lens, std::optional<int> blades, std::optional<double> rounding,
                     std::optional<double> rotation_deg);

/// Returns the lens with a coating on all surfaces that it suits: a mirror coating on all mirrors, any other on all
/// faces between air and glass. The kind `unknown` replaces the coatings of both. Cemented faces are unchanged. Throws
/// InputError if the lens has no such surface.
LensSystem with_coating(LensSystem lens, const Coating& coating);

/// Returns the lens with a coating on these surfaces, counted from 0. Throws InputError if there is no such surface,
/// and LensFileError if the coating does not suit it.
LensSystem with_coating(LensSystem lens, const Coating& coating, const std::vector<int>& surfaces);

}  // namespace REALCAM_NAMESPACE
