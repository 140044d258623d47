#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "best_focus.hpp"
#include "coated_faces.hpp"
#include "lens_changes.hpp"

namespace REALCAM_NAMESPACE {

namespace lens_edits_detail {

/// What zooming changes in a lens, from the lens in each of its positions.
inline ZoomRange zoom_of(const LensSystem& edited, const ZoomRange& before, const std::vector<LensSystem>& states) {
    ZoomRange zoom{{}, {}, before.current};
    const FocusingRule& focusing = edited.focusing;
    for (int i = 0; i + 1 < static_cast<int>(edited.surfaces.size()); ++i) {
        const auto thickness = [i](const LensSystem& state) {
            return state.surfaces[static_cast<std::size_t>(i)].thickness;
        };
        bool changes = focusing.moves_group() && (i == focusing.group_first - 1 || i == focusing.group_last);
        for (const LensSystem& state : states) changes |= thickness(state) != thickness(states.front());
        if (changes) zoom.surfaces.push_back(i);
    }
    for (std::size_t p = 0; p < states.size(); ++p) {
        ZoomPosition position{before.positions[p].name, {}, states[p].film_distance, states[p].focus_distance, 0};
        for (const int i : zoom.surfaces)
            position.thicknesses.push_back(states[p].surfaces[static_cast<std::size_t>(i)].thickness);
        if (before.positions[p].stop_semi_diameter > 0)
            position.stop_semi_diameter = states[p].stop().clear_semi_diameter;
        zoom.positions.push_back(std::move(position));
    }
    return zoom;
}

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
inline LensSystem with_film(LensSystem lens, double width, double height) {
    lens.film_width = width;
    lens.film_height = height;
    validate(lens);
    return lens;
}

/// All lengths times `factor`, film and focus distances among them; coatings keep their thickness. Throws InputError
/// for a factor that is not positive, LensFileError where the lens cannot be built.
inline LensSystem scaled(const LensSystem& lens, double factor) {
    if (!(factor > 0) || !std::isfinite(factor)) throw InputError("a lens is scaled by a positive, finite factor");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        for (Surface& s : l.surfaces) {
            s.curvature /= factor;
            s.thickness *= factor;
            s.clear_semi_diameter *= factor;
            s.inner_semi_diameter *= factor;
            double power = factor * factor * factor;
            for (double& a : s.aspheric) {
                a /= power;
                power *= factor * factor;
            }
        }
        for (double* length : {&l.film_width, &l.film_height, &l.film_distance, &l.focus_distance,
                               &l.stop_semi_diameter, &l.focusing.nearest_mm})
            *length *= factor;
        return l;
    });
}

/// The lens turned round, its last surface towards the scene, and focused at infinity: the film is where infinity is
/// sharpest, or `film_distance` behind the last vertex. Throws LensFileError where infinity has no real image there and
/// no distance is given, and where the medium at the film is not air.
inline LensSystem reversed(const LensSystem& lens, std::optional<double> film_distance = {}) {
    const std::size_t n = lens.surfaces.size();
    if (!medium_before(lens, n).is_air())
        throw LensFileError("the lens cannot be turned round: what lies behind its last surface is not air");
    return lens_edits_detail::edited_in_all_states(lens, [&](const LensSystem& l) {
        LensSystem turned = l;
        for (std::size_t i = 0; i < n; ++i) {
            Surface& s = turned.surfaces[i] = l.surfaces[n - 1 - i];
            s.curvature = -s.curvature;
            for (double& a : s.aspheric) a = -a;
            if (s.type == SurfaceType::refracting) s.material = medium_before(l, n - 1 - i);
            s.thickness = i + 1 < n ? l.surfaces[n - 2 - i].thickness : 0;
        }
        if (l.focusing.moves_group()) {
            turned.focusing.group_first = static_cast<int>(n) - 1 - l.focusing.group_last;
            turned.focusing.group_last = static_cast<int>(n) - 1 - l.focusing.group_first;
        }
        turned.focusing.nearest_mm = 0;
        turned.focus_distance = kInfinity;
        turned.film_distance = film_distance.value_or(best_focus_distance(turned, turned.wavelength_nm, kInfinity));
        if (!film_distance && !(turned.film_distance > 0))
            throw LensFileError(
                "turned round, the lens makes no real image of infinity behind its last surface; a film distance is "
                "wanted");
        return turned;
    });
}

/// The lens with surfaces put in front of surface `index`, counted from 0, or behind the last one. `gap`: from the
/// surface in front of them to the first, if it is to change; behind the last surface it has to be given. The film
/// keeps its distance from the last surface, but stays in its place where surfaces are put behind that. Throws
/// InputError for places that are none, and LensFileError where the lens cannot be built.
inline LensSystem inserted(const LensSystem& lens, int index, const std::vector<Surface>& surfaces,
                           std::optional<double> gap = {}) {
    const int n = static_cast<int>(lens.surfaces.size()), count = static_cast<int>(surfaces.size());
    if (index < 0 || index > n)
        throw InputError("surfaces are put in front of surface 0 to " + std::to_string(n - 1) +
                         ", or behind the last (" + std::to_string(n) + "); " + std::to_string(index) + " is neither");
    if (surfaces.empty()) throw InputError("there are no surfaces to insert");
    if (index == n && !gap) throw InputError("behind the last surface the distance from it is wanted, too");
    if (index == 0 && gap) throw InputError("in front of the first surface there is nothing to have a distance from");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        const auto place = static_cast<std::size_t>(index);
        if (gap) l.surfaces[place - 1].thickness = *gap;
        l.surfaces.insert(l.surfaces.begin() + index, surfaces.begin(), surfaces.end());
        l.surfaces.back().thickness = 0;
        if (index == n) {
            l.film_distance -= *gap;
            for (std::size_t i = place; i + 1 < l.surfaces.size(); ++i) l.film_distance -= l.surfaces[i].thickness;
        }
        if (l.focusing.moves_group()) {
            FocusingRule& focusing = l.focusing;
            focusing.group_first += focusing.group_first >= index ? count : 0;
            focusing.group_last += focusing.group_last >= index ? count : 0;
        }
        return l;
    });
}

/// The lens without surfaces `first` to `last`, counted from 0; those that stay do so in their places, and the film
/// too. Throws InputError where there are no such surfaces, and LensFileError where the lens cannot be built.
inline LensSystem removed(const LensSystem& lens, int first, int last) {
    check_surface_exists(lens, first);
    check_surface_exists(lens, last);
    const int n = static_cast<int>(lens.surfaces.size()), count = last - first + 1;
    if (count < 1) throw InputError("surfaces are removed from a first to a last one, which does not come before it");
    if (count == n) throw InputError("all surfaces would be removed");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        double length = 0;
        for (int i = first; i <= last && i + 1 < n; ++i) length += l.surfaces[static_cast<std::size_t>(i)].thickness;
        if (first > 0) l.surfaces[static_cast<std::size_t>(first) - 1].thickness += length;
        if (last + 1 == n) l.film_distance += l.surfaces[static_cast<std::size_t>(first) - 1].thickness;
        l.surfaces.erase(l.surfaces.begin() + first, l.surfaces.begin() + last + 1);
        l.surfaces.back().thickness = 0;
        if (l.focusing.moves_group()) {
            const auto kept_before = [&](int surface) { return surface - std::clamp(surface - first, 0, count); };
            FocusingRule& focusing = l.focusing;
            focusing.group_first = kept_before(focusing.group_first);
            focusing.group_last = kept_before(focusing.group_last + 1) - 1;
            if (focusing.group_last < focusing.group_first) focusing.group_first = focusing.group_last = -1;
        }
        return l;
    });
}

}  // namespace REALCAM_NAMESPACE
