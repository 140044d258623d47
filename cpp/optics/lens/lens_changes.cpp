#include "lens_changes.hpp"

#include <string>

#include "../coating/coated_surface.hpp"
#include "../prescription/lens_checks.hpp"
#include "../prescription/lens_system.hpp"

namespace realcam {

void check_surface_exists(const LensSystem& lens, int index) {
    const int count = static_cast<int>(lens.surfaces.size());
    if (index < 0 || index >= count)
        throw InputError("there is no surface " + std::to_string(index) + "; the lens has " + std::to_string(count) +
                         ", counted from 0");
}

namespace lens_changes_detail {

namespace {

/// Replaces one surface, and applies the changes of its thickness and stop size to the zoom positions.
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
        throw InputError("the diaphragm of " + lens.name + " is round; blade_rounding and blade_rotation need blades");
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

namespace {

/// Applies a motion, in the frame of the axis in front of the surface, before the surface's own placement.
/// `moves_following`: the surfaces behind move with it.
void prepend_motion(Surface& surface, const Affine<double>& motion, bool moves_following) {
    SurfacePlacement& own = surface.placement;
    own = SurfacePlacement::from_frame(own.is_in_place() ? motion : motion * own.frame());
    own.returns = !moves_following;
}

/// True if a placement of the surface that also moves the surfaces behind it can be set or extended.
bool can_move_following(const Surface& surface) {
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
        prepend_motion(surface(i), inverse_motion(to_here) * motion * to_here, false);
        to_here = to_here * along_axis(surface(i).thickness);
    }
    return true;
}

void move_element(LensSystem& lens, int first, int last, const Affine<double>& motion) {
    const auto surface = [&](int i) -> Surface& { return lens.surfaces[static_cast<std::size_t>(i)]; };
    const bool is_at_end = last + 1 == static_cast<int>(lens.surfaces.size());
    // The surfaces' own placements suffice if no surface has to move back behind the last of them.
    const bool may_move_alone = first == last || is_at_end || !can_move_following(surface(last + 1));
    if (may_move_alone && move_each_alone(lens, first, last, motion)) return;
    if (is_at_end || !can_move_following(surface(first)) || !can_move_following(surface(last + 1)))
        throw InputError("surfaces " + std::to_string(first + 1) + " to " + std::to_string(last + 1) +
                         " cannot be moved together: their own placements, or that of the surface behind, cannot be "
                         "combined with another motion");
    // Frame of the axis behind the last of them, relative to that in front of the first.
    Affine<double> to_here;
    for (int i = first; i <= last; ++i) {
        if (!surface(i).placement.returns) to_here = to_here * surface(i).placement.frame();
        to_here = to_here * along_axis(surface(i).thickness);
    }
    prepend_motion(surface(first), motion, true);
    prepend_motion(surface(last + 1), inverse_motion(to_here) * inverse_motion(motion) * to_here, true);
}

LensSystem with_element_tilted(const LensSystem& lens, int first, int last, const SurfacePlacement& placement,
                               double pivot) {
    check_surface_exists(lens, first);
    check_surface_exists(lens, last);
    if (last < first) throw InputError("the last surface of an element must not come before the first one");
    LensSystem result = lens;
    move_element(result, first, last,
                 pivot == 0 ? placement.frame() : along_axis(pivot) * placement.frame() * along_axis(-pivot));
    validate(result);
    return result;
}

namespace {

/// Frame of the film's vertex on the last axis, before the film's own placement.
Affine<double> film_on_axis(const LensSystem& lens) {
    return surface_frames(lens).last_axis * along_axis(lens.film_distance);
}

}  // namespace

LensSystem with_lens_moved(const LensSystem& lens, const SurfacePlacement& move, double pivot) {
    LensSystem moved = lens;
    SurfacePlacement& front = moved.surfaces.front().placement;
    if (front.returns && !front.is_in_place())
        throw InputError("the lens cannot be tilted or shifted: its first surface has a tilt or decentre of its own");
    const Affine<double> film = film_on_axis(lens) * lens.film_placement.frame();
    const Vec3d centre = film.origin - Vec3d{0, 0, pivot};
    const Affine<double> motion = Affine<double>{.origin = centre} * move.frame() * Affine<double>{.origin = -centre};
    front = SurfacePlacement::from_frame(motion * front.frame());
    // The film keeps its position: its placement compensates the motion of the last axis.
    moved.film_placement = SurfacePlacement::from_frame(inverse_motion(film_on_axis(moved)) * film);
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
