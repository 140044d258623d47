#pragma once
#include <optional>
#include <string>
#include <vector>

#include "../prescription/lens_checks.hpp"

namespace REALCAM_NAMESPACE {

// Edits of a whole lens, also in all its zoom positions: size, film, direction, number of surfaces.

namespace lens_edits_detail {

/// Returns the zoom range of an edited lens. `before`: the zoom range of the lens before the edit; `states`: the edited
/// lens in each of its zoom positions.
ZoomRange zoom_of(const LensSystem& edited, const ZoomRange& before, const std::vector<LensSystem>& states);

/// Returns the lens with `edit`, a function from a lens to the edited lens, applied to its current state and to each of
/// its zoom positions. Throws LensFileError if the result cannot be built.
template <class Edit>
LensSystem edited_in_all_states(const LensSystem& lens, Edit&& edit) {
    LensSystem edited = edit(lens);
    std::vector<LensSystem> states;
    for (int p = 0; p < static_cast<int>(lens.zoom.positions.size()); ++p)
        states.push_back(edit(at_zoom_position(lens, p)));
    if (!states.empty()) edited.zoom = zoom_of(edited, lens.zoom, states);
    validate_with_film(edited);
    return edited;
}

}  // namespace lens_edits_detail

/// Returns the lens with another film size, mm. Throws LensFileError if a size is invalid.
LensSystem with_film(LensSystem lens, double width, double height);

/// Returns the lens with a film of this radius of curvature, mm; negative: concave towards the lens, infinite: flat.
/// Throws LensFileError if the radius is too short for the film's corners.
LensSystem with_film_radius(LensSystem lens, double radius_of_curvature);

/// Returns the lens with all lengths multiplied by `factor`, also film and focus distances, but not the thicknesses of
/// coatings. Throws InputError if the factor is not positive, LensFileError if the lens cannot be built.
LensSystem scaled(const LensSystem& lens, double factor);

/// Returns the reversed lens, its last surface towards the scene, focused at infinity: the film lies where light from
/// infinity is sharpest, or `film_distance` mm behind the last vertex. Throws InputError unless the lens is
/// rotationally symmetric. Throws LensFileError if the medium at the film is not air, or if light from infinity has no
/// real image behind the reversed lens and no distance is given.
LensSystem reversed(const LensSystem& lens, std::optional<double> film_distance = {});

/// Returns the lens with surfaces inserted in front of surface `index`, counted from 0, or behind the last one. `gap`:
/// new distance from the preceding surface to the first inserted one, mm; std::nullopt keeps the distance. It is
/// required behind the last surface. The film keeps its distance from the last surface; if surfaces are inserted behind
/// that, it keeps its position. Throws InputError if the index or gap is invalid, and LensFileError if the lens cannot
/// be built.
LensSystem inserted(const LensSystem& lens, int index, const std::vector<Surface>& surfaces,
                    std::optional<double> gap = {});

/// Returns the lens without surfaces `first` to `last`, counted from 0; the other surfaces and the film keep their
/// positions. Throws InputError if there are no such surfaces, or one of them moves those behind it, and LensFileError
/// if the lens cannot be built.
LensSystem removed(const LensSystem& lens, int first, int last);

}  // namespace REALCAM_NAMESPACE
