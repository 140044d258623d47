#include "lens_checks.hpp"

#include <cmath>
#include <cstdio>

#include "../../math/hypotenuse.hpp"
#include "clearance.hpp"
#include "coating_checks.hpp"
#include "form_checks.hpp"
#include "lens_limits.hpp"
#include "lens_system.hpp"

namespace realcam {

namespace lens_checks_detail {

std::string mm(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g mm", v);
    return text;
}

namespace {

/// Checks curvature, conic and aspheric coefficients. `i`, here and below: index of the surface, for messages.
void check_base_shape(const Surface& s, std::size_t i) {
    if (!std::isfinite(s.curvature) || !std::isfinite(s.conic))
        fail(i, "radius of curvature and conic must be finite numbers (leave the radius out for a plane)");
    if (std::fabs(s.conic) > kLargestConic) fail(i, "the conic must lie between -1e6 and 1e6");
    if (std::fabs(s.curvature) > 1 / kShortestRadius)
        fail(i, "the curvature is larger than that of a radius of 1e-6 mm");
    for (double a : s.aspheric)
        if (!std::isfinite(a)) fail(i, "an aspheric coefficient is not a finite number");
    if (s.aspheric.size() > static_cast<std::size_t>(kMaxAsphericTerms))
        fail(i, "aspheric coefficients are supported up to r^" + std::to_string(2 * kMaxAsphericTerms + 2));
}

/// Checks the clear semi-diameters, and the sag inside them.
void check_rim(const Surface& s, std::size_t i) {
    if (!(s.clear_semi_diameter > 0) || !std::isfinite(s.clear_semi_diameter))
        fail(i, "the clear semi-diameter is " + mm(s.clear_semi_diameter) + "; expected a positive length");
    if (s.clear_semi_diameter < kShortestRadius || s.clear_semi_diameter > kLongest)
        fail(i, "the clear semi-diameter must lie between 1e-6 and 1e9 mm");
    double power = s.clear_semi_diameter * s.clear_semi_diameter;
    for (double a : s.aspheric) {
        power *= s.clear_semi_diameter * s.clear_semi_diameter;
        if (std::fabs(a) > kLargestCoefficient || std::fabs(a) * power > kLongest)
            fail(i, "an aspheric coefficient is too large: it exceeds 1e37, or its term exceeds 1e9 mm at the rim");
    }
    if (!(s.inner_semi_diameter >= 0) || s.inner_semi_diameter >= s.clear_semi_diameter)
        fail(i, "the inner semi-diameter must be at least 0 and less than the clear semi-diameter");
    if (const std::string why = form_error(s); !why.empty()) fail(i, why);
    if (s.form.adds_nothing() && !std::isfinite(s.sag(s.clear_semi_diameter))) {
        const double limit = 1 / (std::fabs(s.curvature) * std::sqrt(1 + s.conic));
        fail(i, "the clear semi-diameter of " + mm(s.clear_semi_diameter) +
                    " is larger than the surface, which ends at " + mm(limit) + " from the axis");
    }
}

/// `direction`: direction of the light behind the surface along z, 1 or -1; 0: unknown, because surfaces are tilted.
void check_thickness(const Surface& s, std::size_t i, double direction) {
    if (!std::isfinite(s.thickness)) fail(i, "the thickness is not a finite number");
    if (std::fabs(s.thickness) > kLongest) fail(i, "the thickness is more than 1e9 mm");
    if (s.thickness * direction < 0)
        fail(i, direction > 0
                    ? "the thickness is negative; light travels to the film here, so it must be 0 or more"
                    : "the thickness is positive; light travels back behind a mirror, so it must be 0 or less");
}

/// Returns the reason why a placement is invalid; empty if it is valid.
std::string placement_error(const SurfacePlacement& placement) {
    const auto& [decentre, tilt, returns] = placement;
    if (!(std::fabs(decentre.x) <= kLongest && std::fabs(decentre.y) <= kLongest && std::fabs(decentre.z) <= kLongest))
        return "the decentre must be three lengths of at most 1e9 mm";
    if (!(std::fabs(tilt.x) <= 360 && std::fabs(tilt.y) <= 360 && std::fabs(tilt.z) <= 360))
        return "the tilt must be three angles between -360 and 360 degrees";
    return "";
}

/// Checks the refractive index at the ends of the visible spectrum and at the design wavelength.
void check_material(const Surface& s, std::size_t i, double design_wavelength_nm) {
    for (double wavelength : {380.0, design_wavelength_nm, 780.0}) {
        const double n = s.material.index(wavelength);
        if (!(n >= 1) || !(n < 10))
            fail(i, "the refractive index of its material at " + std::to_string(static_cast<int>(wavelength)) +
                        " nm is " + std::to_string(n) + "; expected 1 to 10");
    }
}

/// Checks the coating, and that it suits the type of the surface.
void check_surface_coating(const Surface& s, std::size_t i) {
    try {
        validate(s.coating);
        check_coating_fits(s);
    } catch (const InputError& error) {
        fail(i, error.what());
    }
}

/// Checks that there is exactly one aperture stop.
void check_stop(const LensSystem& lens) {
    const int first = lens.stop_index();
    if (first < 0) throw LensFileError("the lens has no surface of type \"stop\"; expected exactly one");
    for (std::size_t i = static_cast<std::size_t>(first) + 1; i < lens.surfaces.size(); ++i)
        if (lens.surfaces[i].type == SurfaceType::stop)
            fail(i, "is a second \"stop\", after surface " + std::to_string(first + 1) + "; expected exactly one");
}

}  // namespace

std::string short_mm(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g mm", v);
    return text;
}

}  // namespace lens_checks_detail

void check_surfaces(const LensSystem& lens) {
    using namespace lens_checks_detail;
    if (lens.surfaces.empty()) throw LensFileError("the lens has no surfaces; expected at least one and a stop");
    if (lens.surfaces.size() > kMaxSurfaces)
        throw LensFileError("the lens has " + std::to_string(lens.surfaces.size()) + " surfaces; at most " +
                            std::to_string(kMaxSurfaces) + " are supported");
    double direction = 1;
    const bool is_on_axis = lens.film_placement.is_in_place() && has_axis(lens);
    std::size_t last_mirror = 0;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& s = lens.surfaces[i];
        if (s.type == SurfaceType::mirror) direction = -direction, last_mirror = i;
        check_base_shape(s, i);
        check_rim(s, i);
        check_thickness(s, i, is_on_axis ? direction : 0);
        if (const std::string why = placement_error(s.placement); !why.empty()) fail(i, why);
        check_material(s, i, lens.wavelength_nm);
        check_surface_coating(s, i);
    }
    check_stop(lens);
    if (is_on_axis && direction < 0 && !(lens.film_distance < 0))
        fail(last_mirror,
             "the lens has an odd number of mirrors, so its light does not reach a film behind it; the film must lie "
             "in front of the last surface, at a film_distance_mm below 0");
    if (lens.allow_overlap) return;
    if (const auto overlap = find_overlap(lens))
        fail(static_cast<std::size_t>(overlap->first),
             "crosses surface " + std::to_string(overlap->second + 1) + ", by " + short_mm(overlap->depth) + " at " +
                 short_mm(overlap->radius) +
                 " from the axis; faces must not overlap inside their rims (unless allow_overlap is set)");
}

void check_iris(const IrisShape& iris) {
    if (iris.blades != 0 && (iris.blades < 3 || iris.blades > kMaxIrisBlades))
        throw LensFileError("the iris has " + std::to_string(iris.blades) + " blades; expected 0 (round) or 3 to " +
                            std::to_string(kMaxIrisBlades));
    if (!(iris.rounding >= 0 && iris.rounding <= 1))
        throw LensFileError("the rounding of the iris must lie between 0 (straight blades) and 1 (a circle)");
    if (!std::isfinite(iris.rotation_rad)) throw LensFileError("the rotation of the iris is not a finite number");
}

void check_film_reach(const LensSystem& lens, double corner) {
    // The film must stay short of a full hemisphere, at whose edge it is parallel to the axis.
    constexpr double kMaxSine = 0.995;
    if (!(corner <= kMaxSine * std::fabs(lens.film_radius_of_curvature)))
        throw LensFileError(
            "the film's radius of curvature, " + lens_checks_detail::short_mm(lens.film_radius_of_curvature) +
            ", is too short: the film reaches out to " + lens_checks_detail::short_mm(corner) + " from the axis");
}

void check_film_size(const LensSystem& lens) {
    if (!(lens.film_width > 0) || !(lens.film_height > 0) || !(lens.film_width + lens.film_height <= kLongest))
        throw LensFileError("the film's width and height must be positive lengths, of at most 1e9 mm");
    if (const std::string why = lens_checks_detail::placement_error(lens.film_placement); !why.empty())
        throw LensFileError("film: " + why);
    check_film_reach(lens, 0.5 * hypotenuse(lens.film_width, lens.film_height));
}

void check_focusing(const LensSystem& lens) {
    const int n = static_cast<int>(lens.surfaces.size());
    if (lens.focusing.moves_group() &&
        (lens.focusing.group_last < lens.focusing.group_first || lens.focusing.group_last >= n))
        throw LensFileError("the focusing group must be [first, last] with 1 <= first <= last <= " + std::to_string(n));
}

void check_zoom(const LensSystem& lens) {
    const ZoomRange& zoom = lens.zoom;
    if (zoom.positions.empty()) return;
    const int last = static_cast<int>(lens.surfaces.size()) - 1, count = static_cast<int>(zoom.positions.size());
    if (zoom.current < 0 || zoom.current >= count)
        throw LensFileError("the current zoom position of the lens does not exist");
    for (std::size_t i = 0; i < zoom.surfaces.size(); ++i)
        if (zoom.surfaces[i] < 0 || zoom.surfaces[i] >= last || (i > 0 && zoom.surfaces[i] <= zoom.surfaces[i - 1]))
            throw LensFileError(
                "zooming can change the thicknesses of surfaces 1 to " + std::to_string(last) +
                ", in ascending order; the distance behind the last surface is a position's film distance");
    for (std::size_t i = 0; i < zoom.positions.size(); ++i) {
        const ZoomPosition& position = zoom.positions[i];
        const std::string where = "in zoom position \"" + position.name + "\" ";
        for (std::size_t j = 0; j < i; ++j)
            if (zoom.positions[j].name == position.name)
                throw LensFileError("two zoom positions have the name \"" + position.name + '"');
        if (position.name.empty()) throw LensFileError("a zoom position has no name");
        if (position.thicknesses.size() != zoom.surfaces.size())
            throw LensFileError(where + "the number of thicknesses is not that of the surfaces that zooming moves");
        if (!(position.film_distance > 0) || !(position.film_distance <= kLongest))
            throw LensFileError(where + "the film must lie behind the last surface, at most 1e9 mm away");
        if (!(position.stop_semi_diameter >= 0) || !(position.focus_distance > 0))
            throw LensFileError(where + "the stop's semi-diameter or the focus distance is not positive");
        try {
            check_surfaces(at_zoom_position(lens, static_cast<int>(i)));
        } catch (const LensFileError& error) {
            throw LensFileError(where + error.detail, {}, 0, error.surface);
        }
    }
}

void validate(const LensSystem& lens) {
    // First, because refractive indices are evaluated at this wavelength, and messages print it as an integer.
    if (!(lens.wavelength_nm >= 100 && lens.wavelength_nm <= 20000))
        throw LensFileError("the design wavelength must lie between 100 and 20000 nm");
    if (!(lens.focusing.nearest_mm >= 0))
        throw LensFileError("the nearest focus distance must be 0 (limited only by the optics) or more");
    if (!(lens.stop_semi_diameter >= 0 && lens.stop_semi_diameter <= kLongest))
        throw LensFileError("the radius of the lens's open stop must be a length of 0 or more");
    if (std::isnan(lens.focus_distance)) throw LensFileError("the focus distance must be a number");
    check_surfaces(lens);
    check_iris(lens.iris);
    check_film_size(lens);
    check_focusing(lens);
    check_zoom(lens);
}

std::string film_distance_error(const LensSystem& lens) {
    if (!lens.is_rotational()) {
        const double away = std::fabs(lens.film_distance);
        return away > 0 && away <= kLongest ? "" : "the film must lie away from the last surface, at most 1e9 mm";
    }
    if (!(lens.film_distance > 0) || !(lens.film_distance <= kLongest))
        return "the film must lie behind the last surface of the lens, at most 1e9 mm away";
    if (!lens.allow_overlap && film_crosses_lens(lens))
        return "the film, " + lens_checks_detail::short_mm(lens.film_distance) +
               " behind the last vertex of the lens, cuts through its last face; it must lie behind that face's rim "
               "(unless allow_overlap is set)";
    return "";
}

void validate_with_film(const LensSystem& lens) {
    validate(lens);
    if (const std::string why = film_distance_error(lens); !why.empty()) throw LensFileError(why);
}

}  // namespace realcam
