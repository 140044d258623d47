#include "lens_edits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../coating/coated_surface.hpp"
#include "best_focus.hpp"
#include "lens_changes.hpp"

namespace realcam {

namespace lens_edits_detail {

ZoomRange zoom_of(const LensSystem& edited, const ZoomRange& before, const std::vector<LensSystem>& states) {
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

}  // namespace lens_edits_detail

LensSystem with_film(LensSystem lens, double width, double height) {
    lens.film_width = width;
    lens.film_height = height;
    validate(lens);
    return lens;
}

LensSystem with_film_radius(LensSystem lens, double radius_of_curvature) {
    lens.film_radius_of_curvature = radius_of_curvature;
    validate(lens);
    return lens;
}

LensSystem scaled(const LensSystem& lens, double factor) {
    if (!(factor > 0) || !std::isfinite(factor))
        throw InputError("the factor by which a lens is scaled must be positive and finite");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        for (Surface& s : l.surfaces) {
            s.curvature /= factor;
            s.thickness *= factor;
            s.clear_semi_diameter *= factor;
            s.inner_semi_diameter *= factor;
            s.form = s.form.scaled(factor);
            s.aperture_shape = s.aperture_shape.scaled(factor);
            s.placement.decentre = factor * s.placement.decentre;
            double power = factor * factor * factor;
            for (double& a : s.aspheric) {
                a /= power;
                power *= factor * factor;
            }
        }
        for (double* length : {&l.film_width, &l.film_height, &l.film_distance, &l.film_radius_of_curvature,
                               &l.focus_distance, &l.stop_semi_diameter, &l.focusing.nearest_mm})
            *length *= factor;
        return l;
    });
}

LensSystem reversed(const LensSystem& lens, std::optional<double> film_distance) {
    lens.require_rotational("turning a lens round");
    const std::size_t n = lens.surfaces.size();
    if (!medium_before(lens, n).is_air())
        throw LensFileError("the lens cannot be reversed: the medium behind its last surface is not air");
    return lens_edits_detail::edited_in_all_states(lens, [&](const LensSystem& l) {
        LensSystem result = l;
        for (std::size_t i = 0; i < n; ++i) {
            Surface& s = result.surfaces[i] = l.surfaces[n - 1 - i];
            s.curvature = -s.curvature;
            s.form = s.form.negated();
            for (double& a : s.aspheric) a = -a;
            if (s.type == SurfaceType::refracting) s.material = medium_before(l, n - 1 - i);
            s.thickness = i + 1 < n ? l.surfaces[n - 2 - i].thickness : 0;
        }
        if (l.focusing.moves_group()) {
            result.focusing.group_first = static_cast<int>(n) - 1 - l.focusing.group_last;
            result.focusing.group_last = static_cast<int>(n) - 1 - l.focusing.group_first;
        }
        result.focusing.nearest_mm = 0;
        result.focus_distance = kInfinity;
        result.film_distance = film_distance.value_or(best_focus_distance(result, result.wavelength_nm, kInfinity));
        if (!film_distance && !(result.film_distance > 0))
            throw LensFileError(
                "the reversed lens makes no real image of infinity behind its last surface; a film distance is "
                "required");
        return result;
    });
}

LensSystem inserted(const LensSystem& lens, int index, const std::vector<Surface>& surfaces,
                    std::optional<double> gap) {
    const int n = static_cast<int>(lens.surfaces.size()), count = static_cast<int>(surfaces.size());
    if (index < 0 || index > n)
        throw InputError("surfaces can be inserted in front of surface 0 to " + std::to_string(n - 1) + ", or at " +
                         std::to_string(n) + " behind the last one; found " + std::to_string(index));
    if (surfaces.empty()) throw InputError("there are no surfaces to insert");
    if (index == n && !gap) throw InputError("behind the last surface, the distance from it is required");
    if (index == 0 && gap)
        throw InputError("in front of the first surface, a distance from the preceding surface is not possible");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        const auto position = static_cast<std::size_t>(index);
        if (gap) l.surfaces[position - 1].thickness = *gap;
        l.surfaces.insert(l.surfaces.begin() + index, surfaces.begin(), surfaces.end());
        l.surfaces.back().thickness = 0;
        if (index == n) {
            l.film_distance -= *gap;
            for (std::size_t i = position; i + 1 < l.surfaces.size(); ++i) l.film_distance -= l.surfaces[i].thickness;
        }
        if (l.focusing.moves_group()) {
            FocusingRule& focusing = l.focusing;
            focusing.group_first += focusing.group_first >= index ? count : 0;
            focusing.group_last += focusing.group_last >= index ? count : 0;
        }
        return l;
    });
}

LensSystem removed(const LensSystem& lens, int first, int last) {
    check_surface_exists(lens, first);
    check_surface_exists(lens, last);
    const int n = static_cast<int>(lens.surfaces.size()), count = last - first + 1;
    if (count < 1) throw InputError("the last surface to remove must not come before the first one");
    if (count == n) throw InputError("all surfaces would be removed");
    for (int i = first; i <= last; ++i)
        if (const SurfacePlacement& placement = lens.surfaces[static_cast<std::size_t>(i)].placement;
            !placement.returns && !placement.is_in_place())
            throw InputError("surface " + std::to_string(i + 1) +
                             " cannot be removed: its placement also moves the surfaces behind it");
    return lens_edits_detail::edited_in_all_states(lens, [&](LensSystem l) {
        double length = 0;
        for (int i = first; i <= last && i + 1 < n; ++i) length += l.surfaces[static_cast<std::size_t>(i)].thickness;
        if (first > 0) l.surfaces[static_cast<std::size_t>(first) - 1].thickness += length;
        if (last + 1 == n) l.film_distance += l.surfaces[static_cast<std::size_t>(first) - 1].thickness;
        l.surfaces.erase(l.surfaces.begin() + first, l.surfaces.begin() + last + 1);
        l.surfaces.back().thickness = 0;
        if (l.focusing.moves_group()) {
            // New index of a surface, or of the one behind the removed surfaces.
            const auto new_index = [&](int surface) { return surface - std::clamp(surface - first, 0, count); };
            FocusingRule& focusing = l.focusing;
            focusing.group_first = new_index(focusing.group_first);
            focusing.group_last = new_index(focusing.group_last + 1) - 1;
            if (focusing.group_last < focusing.group_first) focusing.group_first = focusing.group_last = -1;
        }
        return l;
    });
}

}  // namespace realcam
