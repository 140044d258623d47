#pragma once
#include <optional>
#include <string>
#include <vector>

#include "../prescription/lens_checks.hpp"

namespace REALCAM_NAMESPACE {

namespace lens_edits_detail {

/// What zooming changes in a lens, from the lens in each of its positions.
ZoomRange zoom_of(const LensSystem& edited, const ZoomRange& before, const std::vector<LensSystem>& states);

/// The lens with `edit` applied to it as it stands and in each of its zoom positions. Throws LensFileError where it
/// cannot be built then.
template <class Edit>
LensSystem edited_in_all_states(const LensSystem& lens, Edit&& edit) {
    LensSystem edited = edit(lens);
    std::vector<LensSystem> states;
    for (int p = 0; p < static_cast<int>(lens.zoom.positions.size()); ++p)
        states.push_back(edit(at_zoom_position(lens, p)));
    if (!states.empty()) edited.zoom = zoom_of(edited, lens.zoom, states);
    validate(edited);
    if (const std::string why = film_distance_error(edited); !why.empty()) throw LensFileError(why);
    return edited;
}

}  // namespace lens_edits_detail

/// The lens for another film. Throws LensFileError for sizes that are none.
LensSystem with_film(LensSystem lens, double width, double height);

/// The lens for a film of this radius of curvature, mm: below 0 hollow towards the lens, infinite flat. Throws
/// LensFileError where the film does not reach its corners.
LensSystem with_film_radius(LensSystem lens, double radius_of_curvature);

/// All lengths times `factor`, film and focus distances among them; coatings keep their thickness. Throws InputError
/// for a factor that is not positive, LensFileError where the lens cannot be built.
LensSystem scaled(const LensSystem& lens, double factor);

/// The lens turned round, its last surface towards the scene, and focused at infinity: the film is where infinity is
/// sharpest, or `film_distance` behind the last vertex. Throws InputError for lenses that are not centred ones of
/// revolution, and LensFileError where infinity has no real image there and
/// no distance is given, and where the medium at the film is not air.
LensSystem reversed(const LensSystem& lens, std::optional<double> film_distance = {});

/// The lens with surfaces put in front of surface `index`, counted from 0, or behind the last one. `gap`: from the
/// surface in front of them to the first, if it is to change; behind the last surface it has to be given. The film
/// keeps its distance from the last surface, but stays in its place where surfaces are put behind that. Throws
/// InputError for places that are none, and LensFileError where the lens cannot be built.
LensSystem inserted(const LensSystem& lens, int index, const std::vector<Surface>& surfaces,
                    std::optional<double> gap = {});

/// The lens without surfaces `first` to `last`, counted from 0; those that stay do so in their places, and the film
/// too. Throws InputError where there are no such surfaces, or where one of them moves those behind it, and
/// LensFileError where the lens cannot be built.
LensSystem removed(const LensSystem& lens, int first, int last);

}  // namespace REALCAM_NAMESPACE
