#include "lens_report.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>

#include "../camera/models/pinhole_camera.hpp"
#include "../io/text/json_writer.hpp"
#include "../math/hypotenuse.hpp"
#include "../optics/analysis/transmission.hpp"
#include "../optics/coating/coated_surface.hpp"
#include "../optics/lens/focus.hpp"
#include "../optics/lens/parabasal.hpp"
#include "../optics/lens/paraxial.hpp"
#include "../optics/prescription/lens_checks.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

/// Cells of the surface table: number, type, radius, thickness, material, clear semi-diameter, remarks.
using TableRow = std::array<std::string, 7>;

/// Formats with fixed decimals; "none" for NaN, "inf" or "-inf" for infinity.
std::string fixed_point(double value, int decimals = 4) {
    if (!std::isfinite(value)) return std::isnan(value) ? "none" : value > 0 ? "inf" : "-inf";
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

std::string type_name(SurfaceType type) {
    switch (type) {
        case SurfaceType::mirror: return "mirror";
        case SurfaceType::stop: return "stop";
        case SurfaceType::aperture: return "aperture";
        case SurfaceType::refracting: break;
    }
    return "refracting";
}

/// Material behind a refracting surface; empty for other surfaces.
std::string material_name(const Surface& surface) {
    if (surface.type != SurfaceType::refracting) return "";
    return surface.material.is_air() ? "air" : surface.material.label;
}

/// Name from the lens file, or else a description of the coating.
std::string coating_name(const Coating& coating) {
    if (!coating.name.empty()) return coating.name;
    switch (coating.kind) {
        case CoatingKind::unknown: return "unknown";
        case CoatingKind::bare: return "bare";
        case CoatingKind::layers: break;
        case CoatingKind::metal: return "metal";
        case CoatingKind::reflectance: return "reflectance " + number_text(coating.reflectance);
    }
    return std::to_string(coating.layers.size()) + " layers";
}

/// "(1, 2, 3)"
std::string vector_text(Vec3d v) {
    return '(' + number_text(v.x, 6) + ", " + number_text(v.y, 6) + ", " + number_text(v.z, 6) + ')';
}

/// Describes the decentre and tilt of a surface or the film; empty if it is not displaced.
std::string placement_text(const SurfacePlacement& placement) {
    if (placement.is_in_place()) return "";
    std::string text = placement.returns ? "moved alone" : "moved";
    if (placement.decentre != Vec3d{0, 0, 0}) text += " by " + vector_text(placement.decentre) + " mm";
    if (placement.tilt_deg != Vec3d{0, 0, 0}) text += " tilted by " + vector_text(placement.tilt_deg) + " degrees";
    return text;
}

/// Radius and displacement of the film; empty for a plane film in place.
std::string film_remarks(const LensSystem& lens) {
    const std::string placement = placement_text(lens.film_placement);
    if (std::isinf(lens.film_radius_of_curvature)) return placement;
    return "radius " + number_text(lens.film_radius_of_curvature, 6) + " mm" +
           (placement.empty() ? "" : ", " + placement);
}

/// Properties of a surface that have no column of their own.
std::string surface_remarks(const Surface& surface) {
    std::string text;
    const auto add = [&](const std::string& mark) { text += (text.empty() ? "" : ", ") + mark; };
    const SurfaceForm& form = surface.form;
    if (form.base != BaseForm::conic)
        add((form.base == BaseForm::toroid ? "toroid, " : "biconic, ") +
            (form.curvature_x == 0 ? "plane" : "radius " + number_text(1 / form.curvature_x, 6) + " mm") + " in xz");
    if (form.conic_x != 0) add("conic " + number_text(form.conic_x, 6) + " in xz");
    if (form.has_terms()) add("polynomial terms");
    if (const std::string placement = placement_text(surface.placement); !placement.empty()) add(placement);
    if (surface.conic != 0) add("conic " + number_text(surface.conic, 6));
    if (surface.is_asphere()) add("asphere to r^" + std::to_string(2 * surface.aspheric.size() + 2));
    if (surface.coating.kind != CoatingKind::unknown && surface.coating.kind != CoatingKind::bare)
        add(coating_name(surface.coating));
    if (surface.inner_semi_diameter > 0) add("blocked inside " + number_text(surface.inner_semi_diameter, 6) + " mm");
    return text;
}

/// Table of the surfaces and the film, followed by a line of coefficients for each asphere.
std::string table(const LensSystem& lens) {
    std::vector<TableRow> rows{{"#", "type", "radius", "thickness", "material", "clear semi-d.", ""},
                               {"", "", "mm", "mm", "", "mm", ""}};
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& s = lens.surfaces[i];
        const std::string radius = s.curvature != 0 ? fixed_point(1 / s.curvature) : s.bends_light() ? "plane" : "";
        const bool is_last = i + 1 == lens.surfaces.size();
        const bool is_stopped_down = s.type == SurfaceType::stop && !lens.is_wide_open();
        rows.push_back({std::to_string(i + 1), type_name(s.type), radius,
                        fixed_point(is_last ? lens.film_distance : s.thickness), material_name(s),
                        fixed_point(is_stopped_down ? lens.stop_semi_diameter : s.clear_semi_diameter),
                        surface_remarks(s)});
    }
    rows.push_back({"", "film", "", "", "", "", film_remarks(lens)});
    std::array<std::size_t, 7> widths{};
    for (const TableRow& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const TableRow& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string gap(widths[c] - row[c].size(), ' ');
            const bool left_aligned = c == 1 || c == 4 || c == 6;  // type, material, remarks
            line += "  " + (left_aligned ? row[c] + gap : gap + row[c]);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& s = lens.surfaces[i];
        if (!s.is_asphere()) continue;
        text += "  asphere " + std::to_string(i + 1) + ':';
        for (std::size_t k = 0; k < s.aspheric.size(); ++k)
            if (s.aspheric[k] != 0) text += ' ' + number_text(s.aspheric[k], 8) + " r^" + std::to_string(2 * k + 4);
        text += '\n';
    }
    return text;
}

/// Full field angles across width, height and diagonal, in degrees; NaN if no light reaches the ends of that dimension.
std::array<double, 3> field_of_view(const LensSystem& lens) {
    const auto full_angle = [&](double size) { return 2 * field_angle(lens, size / 2) * 180 / std::numbers::pi; };
    return {full_angle(lens.film_width), full_angle(lens.film_height),
            full_angle(hypotenuse(lens.film_width, lens.film_height))};
}

/// Describes the result of field_of_view.
std::string field_text(const std::array<double, 3>& degrees) {
    if (std::ranges::none_of(degrees, [](double d) { return std::isnan(d); }))
        return fixed_point(degrees[0], 1) + " x " + fixed_point(degrees[1], 1) + " degrees, " +
               fixed_point(degrees[2], 1) + " across the diagonal";
    const char* dimensions[] = {"width", "height", "diagonal"};
    std::string angles, missing;
    for (std::size_t i = 0; i < degrees.size(); ++i)
        if (std::isnan(degrees[i]))
            missing +=
                std::string(missing.empty() ? "no light reaches the ends of the film's " : " and ") + dimensions[i];
        else
            angles += fixed_point(degrees[i], 1) + " degrees across the film's " + dimensions[i] + "; ";
    return angles + missing;
}

/// Assumptions about coatings that the lens file does not specify; empty if it specifies all.
std::string coating_assumptions(const LensSystem& lens) {
    const std::vector<int> unknown = surfaces_with_unknown_coating(lens);
    const auto mirrors = std::count_if(unknown.begin(), unknown.end(), [&](int i) {
        return lens.surfaces[static_cast<std::size_t>(i)].type == SurfaceType::mirror;
    });
    const auto refracting = static_cast<std::ptrdiff_t>(unknown.size()) - mirrors;
    const auto assumed = [](std::ptrdiff_t count, const std::string& part, const std::string& assumption) {
        if (count == 0) return std::string();
        return std::to_string(count) + ' ' + part + (count == 1 ? " is" : "s are") + " assumed to be " + assumption;
    };
    const std::string glass = assumed(refracting, "face", "bare glass"), metal = assumed(mirrors, "mirror", "perfect");
    if (unknown.empty()) return "";
    return "not specified: " + glass + (glass.empty() || metal.empty() ? "" : ", ") + metal;
}

/// T-stop at the design wavelength. Returns std::nullopt if the index of a material is unknown at it; `reason` then
/// names the material.
std::optional<double> t_stop_if_known(const LensSystem& lens, std::string& reason) {
    try {
        return t_stop(lens, lens.wavelength_nm);
    } catch (const InputError& error) {
        reason = error.what();
        return std::nullopt;
    }
}

/// T-stop, or the reason why it is unknown.
std::string t_stop_text(const LensSystem& lens) {
    std::string reason;
    const std::optional<double> value = t_stop_if_known(lens, reason);
    return value ? "T/" + number_text(*value) : "unknown: " + reason;
}

/// One line per zoom position: its focal length and f-number at the focus distance for which the lens file specifies
/// it.
std::vector<std::string> zoom_lines(const LensSystem& lens) {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < lens.zoom.positions.size(); ++i) {
        const LensSystem zoomed = at_zoom_position(lens, static_cast<int>(i));
        const FirstOrder data = first_order(zoomed, lens.wavelength_nm);
        lines.push_back(lens.zoom.positions[i].name + ": " + fixed_point(data.effective_focal_length) + " mm f/" +
                        number_text(data.f_number) + (static_cast<int>(i) == lens.zoom.current ? " (current)" : ""));
    }
    return lines;
}

/// Shape of the diaphragm's opening.
std::string iris_text(const IrisShape& iris) {
    if (iris.blades == 0) return "round";
    return std::to_string(iris.blades) + " blades, rounding " + number_text(iris.rounding) + ", rotation " +
           number_text(iris.rotation_rad * 180 / std::numbers::pi) + " degrees";
}

}  // namespace

std::string lens_as_text(const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    std::string text = lens.name + (lens.title.empty() ? "" : ": " + lens.title) + '\n';
    if (!lens.source.empty()) text += "source: " + lens.source + '\n';
    text += '\n' + table(lens) + '\n';
    const auto line = [&](std::string what, const std::string& value) {
        what.resize(28, ' ');
        text += "  " + what + value + '\n';
    };
    const auto mm = [](double value) {
        const std::string number = fixed_point(value);
        return std::string(number.size() < 12 ? 12 - number.size() : 0, ' ') + number + " mm";
    };
    text += "At " + number_text(lens.wavelength_nm, 7) + " nm; positions are measured from the front vertex.\n";
    line("effective focal length", mm(data.effective_focal_length));
    if (!lens.is_rotational())
        for (const Meridian& meridian : parabasal_data(lens, lens.wavelength_nm).meridians)
            line("  at " + number_text(meridian.azimuth_deg, 4) + " degrees from x", mm(meridian.focal_length));
    line("back focal distance", mm(data.back_focal_distance));
    line("front focal distance", mm(data.front_focal_distance));
    // The f-number at infinity, as on the ring, and that of the focused lens if a focusing group has moved.
    const std::string f_number = number_text(f_number_at_infinity(lens)), focused = number_text(data.f_number);
    line("f-number", std::string(7, ' ') + "f/" + f_number + (f_number == focused ? "" : ", as focused f/" + focused));
    line("T-stop", std::string(7, ' ') + t_stop_text(lens));
    const std::string assumptions = coating_assumptions(lens);
    line("coatings", "     " + (assumptions.empty() ? std::string("as specified") : assumptions));
    line("entrance pupil position", mm(data.entrance_pupil_position));
    line("entrance pupil diameter", mm(data.entrance_pupil_diameter));
    line("exit pupil position", mm(data.exit_pupil_position));
    line("exit pupil diameter", mm(data.exit_pupil_diameter));
    line("length to last vertex", mm(lens.last_vertex()));
    line("last vertex to film", mm(lens.film_distance));
    line("focus (object to film)", "     " + distance_text(lens.focus_distance / 1000));
    const FocusingRule& rule = lens.focusing;
    if (rule.nearest_mm > 0) line("nearest focus", "     " + distance_text(rule.nearest_mm / 1000));
    line("focusing moves", "     " + (rule.moves_group() ? "surfaces " + std::to_string(rule.group_first + 1) + " to " +
                                                               std::to_string(rule.group_last + 1)
                                                         : std::string("the whole lens")));
    bool is_first = true;
    for (const std::string& position : zoom_lines(lens)) {
        line(is_first ? "zoom positions" : "", "     " + position);
        is_first = false;
    }
    line("diaphragm", "     " + iris_text(lens.iris));
    line("film", "     " + number_text(lens.film_width) + " x " + number_text(lens.film_height) + " mm");
    line("field of view", "     " + field_text(field_of_view(lens)));
    return text;
}

std::string lens_as_json(const LensSystem& lens) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const auto view = field_of_view(lens);
    io::JsonWriter json;
    json.begin_object().key("name").text(lens.name).key("title").text(lens.title).key("source").text(lens.source);
    json.key("surfaces").begin_array();
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i) {
        const Surface& s = lens.surfaces[i];
        json.begin_object().key("number").number(static_cast<double>(i + 1)).key("type").text(type_name(s.type));
        json.key("radius_of_curvature_mm").number(1 / s.curvature).key("thickness_mm").number(s.thickness);
        if (s.bends_light()) json.key("coating").text(coating_name(s.coating));
        json.key("material").text(material_name(s)).key("clear_semi_diameter_mm").number(s.clear_semi_diameter);
        if (s.inner_semi_diameter > 0) json.key("inner_semi_diameter_mm").number(s.inner_semi_diameter);
        if (s.conic != 0) json.key("conic").number(s.conic);
        if (s.is_asphere()) {
            json.key("aspheric_coefficients").begin_object();
            for (std::size_t k = 0; k < s.aspheric.size(); ++k)
                if (s.aspheric[k] != 0) json.key(std::to_string(2 * k + 4)).number(s.aspheric[k]);
            json.end();
        }
        json.end();
    }
    json.end();
    if (!lens.zoom.positions.empty()) {
        json.key("zoom_position").text(lens.zoom.positions[static_cast<std::size_t>(lens.zoom.current)].name);
        json.key("zoom_positions").begin_array();
        for (std::size_t i = 0; i < lens.zoom.positions.size(); ++i) {
            const LensSystem zoomed = at_zoom_position(lens, static_cast<int>(i));
            const FirstOrder first_order_data = first_order(zoomed, lens.wavelength_nm);
            json.begin_object().key("name").text(lens.zoom.positions[i].name);
            json.key("effective_focal_length_mm").number(first_order_data.effective_focal_length);
            json.key("f_number").number(first_order_data.f_number);
            json.key("film_distance_mm").number(zoomed.film_distance);
            json.key("thickness_mm").begin_object();
            for (std::size_t k = 0; k < lens.zoom.surfaces.size(); ++k)
                json.key(std::to_string(lens.zoom.surfaces[k] + 1)).number(lens.zoom.positions[i].thicknesses[k]);
            json.end().end();
        }
        json.end();
    }
    const auto add = [&](const char* name, double value) { json.key(name).number(value); };
    add("wavelength_nm", lens.wavelength_nm);
    add("effective_focal_length_mm", data.effective_focal_length);
    add("back_focal_distance_mm", data.back_focal_distance);
    add("front_focal_distance_mm", data.front_focal_distance);
    add("f_number", data.f_number);
    add("f_number_at_infinity", f_number_at_infinity(lens));
    std::string reason;
    add("t_stop", t_stop_if_known(lens, reason).value_or(std::numeric_limits<double>::quiet_NaN()));
    if (!reason.empty()) json.key("t_stop_unknown").text(reason);
    json.key("coating_assumptions").text(coating_assumptions(lens));
    add("entrance_pupil_position_mm", data.entrance_pupil_position);
    add("entrance_pupil_diameter_mm", data.entrance_pupil_diameter);
    add("exit_pupil_position_mm", data.exit_pupil_position);
    add("exit_pupil_diameter_mm", data.exit_pupil_diameter);
    add("film_distance_mm", lens.film_distance);
    add("focus_distance_m", lens.focus_distance / 1000);
    add("stop_semi_diameter_mm", lens.stop_semi_diameter);
    add("film_width_mm", lens.film_width);
    add("film_height_mm", lens.film_height);
    add("field_of_view_width_deg", view[0]);
    add("field_of_view_height_deg", view[1]);
    add("field_of_view_diagonal_deg", view[2]);
    return json.end().finish() + '\n';
}

}  // namespace realcam::app
