#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "coated_faces.hpp"
#include "lens_checks.hpp"

namespace REALCAM_NAMESPACE {

/// Throws InputError where the lens has no surface of that number, counted from 0.
inline void check_surface_exists(const LensSystem& lens, int index) {
    const int count = static_cast<int>(lens.surfaces.size());
    if (index < 0 || index >= count)
        throw InputError("there is no surface " + std::to_string(index) + "; the lens has " + std::to_string(count) +
                         ", counted from 0");
}

namespace lens_changes_detail {

/// Brings a changed value into the zoom positions: into all of them where zooming does not change it.
template <class Get>
void change_zoom_value(ZoomRange& zoom, double change, const Get& value) {
    const double first = value(zoom.positions.front());
    const bool same = std::all_of(zoom.positions.begin(), zoom.positions.end(),
                                  [&](ZoomPosition& position) { return value(position) == first; });
    for (std::size_t i = 0; i < zoom.positions.size(); ++i)
        if (same || static_cast<int>(i) == zoom.current) value(zoom.positions[i]) += change;
}

inline void replace(LensSystem& lens, int index, const Surface& surface) {
    Surface& before = lens.surfaces[static_cast<std::size_t>(index)];
    for (std::size_t i = 0; i < lens.zoom.surfaces.size(); ++i)
        if (lens.zoom.surfaces[i] == index)
            change_zoom_value(lens.zoom, surface.thickness - before.thickness,
                              [i](ZoomPosition& position) -> double& { return position.thicknesses[i]; });
    if (!lens.zoom.positions.empty() && lens.zoom.positions.front().stop_semi_diameter > 0 &&
        before.type == SurfaceType::stop && surface.type == SurfaceType::stop)
        change_zoom_value(lens.zoom, surface.clear_semi_diameter - before.clear_semi_diameter,
                          [](ZoomPosition& position) -> double& { return position.stop_semi_diameter; });
    before = surface;
}

}  // namespace lens_changes_detail

/// The lens with other surfaces in place of some, by their numbers from 0. All else stays, the film's place too:
/// focused() brings the picture into focus again. A thickness that zooming changes, changes in the current position. A
/// diaphragm that is wide open stays so. Throws InputError where there is no such surface, and LensFileError where the
/// lens cannot be built.
inline LensSystem with_surfaces(LensSystem lens, const std::map<int, Surface>& surfaces) {
    const bool was_open = lens.is_wide_open();
    for (const auto& [index, surface] : surfaces) {
        check_surface_exists(lens, index);
        lens_changes_detail::replace(lens, index, surface);
    }
    lens.surfaces.back().thickness = 0;
    validate(lens);
    const double rim = lens.stop().clear_semi_diameter;
    lens.stop_semi_diameter = was_open ? rim : std::min(lens.stop_semi_diameter, rim);
    return lens;
}

/// The same for one surface.
inline LensSystem with_surface(LensSystem lens, int index, const Surface& surface) {
    return with_surfaces(std::move(lens), {{index, surface}});
}

/// The lens with other blades, which leave the same area open: its f-number stays. Throws LensFileError.
inline LensSystem with_iris(LensSystem lens, const IrisShape& iris) {
    lens.iris = iris;
    validate(lens);
    return lens;
}

/// The lens with a coating on all faces that it is for: a mirror's on all mirrors, any other on all faces between air
/// and glass; `unknown` takes what is known of both away. Cemented faces stay as they are. Throws InputError where the
/// lens has no such face.
inline LensSystem with_coating(LensSystem lens, const Coating& coating) {
    bool any = false;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const bool mirror = lens.surfaces[i].type == SurfaceType::mirror;
        const bool fits = coating.kind == CoatingKind::unknown || mirror == coating.is_for_mirrors();
        if (!fits || !(mirror || is_face_in_air(lens, i))) continue;
        lens.surfaces[i].coating = coating;
        any = true;
    }
    if (!any)
        throw InputError("lens \"" + lens.name + "\" has no " +
                         (coating.is_for_mirrors() ? "mirror" : "face between air and glass") + " to coat");
    validate(lens);
    return lens;
}

/// The same on given surfaces, counted from 0. Throws InputError where there is no such surface, and LensFileError
/// where the coating does not fit it.
inline LensSystem with_coating(LensSystem lens, const Coating& coating, const std::vector<int>& surfaces) {
    for (const int index : surfaces) {
        check_surface_exists(lens, index);
        lens.surfaces[static_cast<std::size_t>(index)].coating = coating;
    }
    validate(lens);
    return lens;
}

}  // namespace REALCAM_NAMESPACE
