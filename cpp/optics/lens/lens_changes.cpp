#include "lens_changes.hpp"

#include <string>

#include "../coating/coated_faces.hpp"
#include "../prescription/lens_checks.hpp"

namespace realcam {

void check_surface_exists(const LensSystem& lens, int index) {
    const int count = static_cast<int>(lens.surfaces.size());
    if (index < 0 || index >= count)
        throw InputError("there is no surface " + std::to_string(index) + "; the lens has " + std::to_string(count) +
                         ", counted from 0");
}

namespace lens_changes_detail {

namespace {

void replace(LensSystem& lens, int index, const Surface& surface) {
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

}  // namespace

}  // namespace lens_changes_detail

LensSystem with_surfaces(LensSystem lens, const std::map<int, Surface>& surfaces) {
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

LensSystem with_iris(LensSystem lens, const IrisShape& iris) {
    lens.iris = iris;
    validate(lens);
    return lens;
}

LensSystem with_iris(LensSystem lens, std::optional<int> blades, std::optional<double> rounding,
                     std::optional<double> rotation_deg) {
    IrisShape iris = lens.iris;
    iris.blades = blades.value_or(iris.blades);
    iris.rounding = rounding.value_or(iris.rounding);
    if (rotation_deg) iris.rotation_rad = *rotation_deg * std::numbers::pi / 180;
    if (iris.blades == 0 && !blades && (rounding || rotation_deg))
        throw InputError("the diaphragm of " + lens.name + " is round; blade_rounding and blade_rotation want blades");
    return with_iris(std::move(lens), iris);
}

LensSystem with_coating(LensSystem lens, const Coating& coating) {
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

LensSystem with_coating(LensSystem lens, const Coating& coating, const std::vector<int>& surfaces) {
    for (const int index : surfaces) {
        check_surface_exists(lens, index);
        lens.surfaces[static_cast<std::size_t>(index)].coating = coating;
    }
    validate(lens);
    return lens;
}

}  // namespace realcam
