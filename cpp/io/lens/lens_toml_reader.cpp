#include <cmath>

#include "../../optics/lens/focus.hpp"
#include "../../optics/prescription/lens_checks.hpp"
#include "../../optics/prescription/lens_limits.hpp"
#include "../text/toml_document.hpp"
#include "lens_coating.hpp"
#include "lens_file.hpp"
#include "lens_material.hpp"
#include "lens_toml.hpp"
#include "lens_zoom.hpp"

namespace realcam::io {
namespace {

constexpr int kFormat = 1;

SurfaceType read_type(const TomlTable& table) {
    const std::string type = table.text("type");
    if (type.empty() || type == "refracting") return SurfaceType::refracting;
    if (type == "mirror") return SurfaceType::mirror;
    if (type == "stop") return SurfaceType::stop;
    if (type == "aperture") return SurfaceType::aperture;
    table.fail("unknown type \"" + type + "\"; expected refracting, mirror, stop or aperture", table.find("type"));
}

/// Reads the coefficients of r^4, r^6, ..., in this order.
std::vector<double> read_aspheric_coefficients(const TomlTable& table) {
    const auto coefficients = table.table("aspheric_coefficients");
    std::vector<double> values;
    if (!coefficients) return values;
    for (const auto& [key, node] : coefficients->raw()) {
        const std::string power_text(key.str());
        const bool digits = power_text.find_first_not_of("0123456789") == std::string::npos && !power_text.empty() &&
                            power_text.size() < 3;
        const int power = digits ? std::stoi(power_text) : 0;
        const int largest = 2 * kMaxAsphericTerms + 2;
        if (power < 4 || power > largest || power % 2)
            coefficients->fail("aspheric coefficients have even powers from 4 to " + std::to_string(largest) +
                                   " as keys (\"radial_terms\" go up to r^" + std::to_string(kMaxRadialTerms) +
                                   "); this one is \"" + power_text + '"',
                               &node);
        const auto term = static_cast<std::size_t>(power / 2 - 2);
        if (values.size() <= term) values.resize(term + 1, 0.0);
        values[term] = coefficients->as_number(node, "the coefficient of r^" + power_text);
    }
    return values;
}

/// Reads decentre and tilt. `prefix`: of the keys, empty for a surface, "film_" for the film.
SurfacePlacement read_placement(const TomlTable& table, const std::string& prefix = "") {
    SurfacePlacement placement;
    const std::vector<double> decentre = table.numbers(prefix + "decentre_mm", 3),
                              tilt = table.numbers(prefix + "tilt_deg", 3);
    if (!decentre.empty()) placement.decentre = {decentre[0], decentre[1], decentre[2]};
    if (!tilt.empty()) placement.tilt_deg = {tilt[0], tilt[1], tilt[2]};
    return placement;
}

/// Reads a surface from its table. `glasses`: the file's table "glass". `is_zoomed`: its thickness is specified by the
/// zoom positions.
Surface read_surface(const TomlTable& table, const std::optional<TomlTable>& glasses, const LensCoatings& coatings,
                     bool is_last, bool is_zoomed) {
    Surface surface;
    surface.type = read_type(table);
    if (surface.bends_light()) {
        std::vector<std::string_view> keys{"type",
                                           "radius_of_curvature_mm",
                                           "thickness_mm",
                                           "material",
                                           "clear_semi_diameter_mm",
                                           "inner_semi_diameter_mm",
                                           "conic",
                                           "aspheric_coefficients",
                                           "coating",
                                           "curvature_per_mm",
                                           "form",
                                           "radius_of_curvature_x_mm",
                                           "curvature_x_per_mm",
                                           "conic_x",
                                           "radial_terms",
                                           "xy_terms",
                                           "aperture",
                                           "obscurations",
                                           "decentre_mm",
                                           "tilt_deg",
                                           "returns"};
        for (const FormNames& words : kFormNames) keys.push_back(words.key);
        table.allow(keys);
    } else {
        table.allow({"type", "thickness_mm", "clear_semi_diameter_mm", "inner_semi_diameter_mm", "decentre_mm",
                     "tilt_deg", "returns", "aperture", "obscurations"});
    }
    if (const auto radius = table.number("radius_of_curvature_mm")) {
        if (*radius == 0)
            table.fail(
                "a radius of curvature must not be 0; leave it out for a plane, and specify the aperture "
                "stop as type = \"stop\"",
                table.find("radius_of_curvature_mm"));
        surface.curvature = 1 / *radius;
    }
    if (const auto curvature = table.number("curvature_per_mm")) {
        if (table.find("radius_of_curvature_mm"))
            table.fail("\"radius_of_curvature_mm\" and \"curvature_per_mm\" say the same; specify only one of them",
                       table.find("curvature_per_mm"));
        surface.curvature = *curvature;
    }
    surface.conic = table.number("conic").value_or(0);
    surface.aspheric = read_aspheric_coefficients(table);
    if (surface.type == SurfaceType::mirror && table.find("material"))
        table.fail("a mirror has no material of its own: the medium behind it is that before it",
                   table.find("material"));
    if (table.find("material")) surface.material = read_material(table, glasses);
    surface.coating = coatings.coating_of(table);
    const auto thickness = table.number("thickness_mm");
    if (!thickness && !is_last && !is_zoomed)
        table.fail("\"thickness_mm\" is missing: the axial distance to the next surface");
    if (thickness && is_last)
        table.fail("the last surface has no \"thickness_mm\"; the film follows it (film_distance_mm, or focus)",
                   table.find("thickness_mm"));
    surface.thickness = thickness.value_or(0);
    const auto rim = table.number("clear_semi_diameter_mm");
    if (!rim) table.fail("\"clear_semi_diameter_mm\" is missing");
    surface.clear_semi_diameter = *rim;
    surface.inner_semi_diameter = table.number("inner_semi_diameter_mm").value_or(0);
    surface.placement = read_placement(table);
    surface.placement.returns = table.flag("returns");
    surface.form = read_form(table);
    surface.aperture_shape = read_aperture(table, surface.clear_semi_diameter);
    return surface;
}

void read_iris(const TomlTable& file, LensSystem& lens) {
    const auto iris = file.table("iris");
    if (!iris) return;
    iris->allow({"blades", "rounding", "rotation_deg", "rotation_rad"});
    const double blades = iris->number("blades").value_or(0);
    if (blades != std::floor(blades) || std::fabs(blades) > 1000)
        iris->fail("\"blades\" must be a whole number", iris->find("blades"));
    lens.iris.blades = static_cast<int>(blades);
    lens.iris.rounding = iris->number("rounding").value_or(0);
    lens.iris.rotation_rad = iris->number("rotation_deg").value_or(0) * std::numbers::pi / 180;
    if (const auto radians = iris->number("rotation_rad")) {
        if (iris->find("rotation_deg"))
            iris->fail("\"rotation_deg\" and \"rotation_rad\" say the same; specify only one of them",
                       iris->find("rotation_rad"));
        lens.iris.rotation_rad = *radians;
    }
}

void read_focusing(const TomlTable& file, LensSystem& lens) {
    const auto focus = file.table("focus");
    if (!focus) return;
    focus->allow({"nearest_m", "nearest_mm", "group"});
    const auto nearest = focus->number("nearest_m"), nearest_mm = focus->number("nearest_mm");
    if (nearest && nearest_mm)
        focus->fail("\"nearest_m\" and \"nearest_mm\" say the same; specify only one of them",
                    focus->find("nearest_mm"));
    if (nearest && !(*nearest > 0)) focus->fail("\"nearest_m\" must be a positive distance", focus->find("nearest_m"));
    if (nearest_mm && !(*nearest_mm > 0))
        focus->fail("\"nearest_mm\" must be a positive distance", focus->find("nearest_mm"));
    lens.focusing.nearest_mm = nearest_mm ? *nearest_mm : 1000 * nearest.value_or(0);
    const std::vector<double> group = focus->numbers("group", 2);
    if (group.empty()) return;
    const auto is_number = [](double n) { return n == std::floor(n) && n >= 1 && n < 1e6; };
    if (!is_number(group[0]) || !is_number(group[1]))
        focus->fail("\"group\" must be the numbers of its first and last surface, from 1", focus->find("group"));
    lens.focusing.group_first = static_cast<int>(group[0]) - 1;
    lens.focusing.group_last = static_cast<int>(group[1]) - 1;
}

/// Runs a check of the finished lens that throws LensFileError without file and line. The error is thrown again with
/// the line of the surface that it names, or else of `part`, the part of the file that it concerns.
template <class Check>
void check_part(const TomlTable& file, const toml::node& part, const toml::array& surfaces, Check&& check) {
    try {
        check();
    } catch (const LensFileError& error) {
        const toml::node& place = error.surface > 0 ? surfaces[static_cast<std::size_t>(error.surface) - 1] : part;
        throw LensFileError(error.detail, file.file(), static_cast<int>(place.source().begin.line), error.surface);
    }
}

/// Checks the lens; errors name the line of the part of the file that is wrong.
void check_lens(const TomlTable& file, const toml::array& surfaces, const LensSystem& lens) {
    const auto part = [&](std::string_view table, std::string_view key = {}) -> const toml::node& {
        const toml::node* node = file.find(table);
        if (node && !key.empty()) node = node->as_table()->get(key);
        return node ? *node : file.raw();
    };
    check_part(file, surfaces[0], surfaces, [&] { check_surfaces(lens); });
    check_part(file, part("iris"), surfaces, [&] { check_iris(lens.iris); });
    check_part(file, part("film_mm"), surfaces, [&] { check_film_size(lens); });
    check_part(file, part("focus", "group"), surfaces, [&] { check_focusing(lens); });
}

/// Radius of curvature of the film, mm; infinity without the key.
double film_radius(const TomlTable& file) {
    const char* const key = "film_radius_of_curvature_mm";
    const double radius = file.number(key).value_or(kInfinity);
    if (!(std::fabs(radius) >= kShortestRadius))
        file.fail(
            '"' + std::string(key) + "\" must be a radius; it is negative if the film is concave towards the lens",
            file.find(key));
    return radius;
}

/// Sets the film distance: as specified, or that of the zoom position, or that of best focus at infinity.
void set_film_distance(const TomlTable& file, LensSystem& lens) {
    const auto distance = file.number("film_distance_mm");
    if (distance == 0.0) lens.film_distance = kFilmContact;
    const bool zooms = !lens.zoom.positions.empty();
    if (!distance && zooms)
        lens.film_distance = lens.zoom.positions[static_cast<std::size_t>(lens.zoom.current)].film_distance;
    if (distance && !(*distance >= 0) && lens.is_rotational())
        file.fail("\"film_distance_mm\" must be 0 or more: the film lies behind the last surface",
                  file.find("film_distance_mm"));
    if (!distance && !zooms) {
        const std::optional<double> found = film_distance_at_infinity(lens);
        if (!found)
            file.fail(
                "the lens makes no real image of infinity behind its last surface; \"film_distance_mm\" is required");
        lens.film_distance = *found;
    }
    if (const std::string why = film_distance_error(lens); !why.empty()) file.fail(why, file.find("film_distance_mm"));
}

/// Sets focus distance and aperture as specified in the file; without the keys, infinity and wide open.
void set_rings(const TomlTable& file, LensSystem& lens) {
    if (!lens.zoom.positions.empty())
        lens.focus_distance = lens.zoom.positions[static_cast<std::size_t>(lens.zoom.current)].focus_distance;
    if (const toml::node* node = file.find("focus_distance_mm")) {
        // Infinity is the default without the key, but a zoom position may be focused at a finite distance at rest.
        const bool infinite = node->is_floating_point() && node->value_or(0.0) == kInfinity;
        lens.focus_distance = infinite ? kInfinity : *file.number("focus_distance_mm");
    }
    if (!(lens.focus_distance > 0))
        file.fail("\"focus_distance_mm\" must be positive: the object plane to the film",
                  file.find("focus_distance_mm"));
    const double rim = lens.stop().clear_semi_diameter;
    lens.stop_semi_diameter = file.number("stop_semi_diameter_mm").value_or(rim);
    if (!(lens.stop_semi_diameter > 0) || lens.stop_semi_diameter > rim)
        file.fail("\"stop_semi_diameter_mm\" must lie between 0 and the stop's clear semi-diameter",
                  file.find("stop_semi_diameter_mm"));
}

}  // namespace

LensSystem lens_from_table(const toml::table& root, const std::string& file, const KeepGoing& keep_going) {
    const TomlTable top(root, file);
    top.allow({"format",
               "name",
               "title",
               "source",
               "wavelength_nm",
               "film_mm",
               "film_distance_mm",
               "film_radius_of_curvature_mm",
               "film_decentre_mm",
               "film_tilt_deg",
               "glass",
               "coating",
               "default_coating",
               "surface",
               "iris",
               "focus",
               "allow_overlap",
               "zoom",
               "zoom_position",
               "focus_distance_mm",
               "stop_semi_diameter_mm"});
    const auto format = top.number("format");
    if (!format) top.fail("\"format = 1\" is missing");
    if (*format != kFormat)
        top.fail("format " + number_label(*format) + " is not known; this program reads format 1", top.find("format"));
    LensSystem lens;
    lens.name = top.line("name");
    if (!top.find("name")) top.fail("\"name\" is missing");
    lens.title = top.line("title");
    lens.source = top.line("source");
    lens.allow_overlap = top.flag("allow_overlap");
    lens.wavelength_nm = top.number("wavelength_nm").value_or(kLineD_nm);
    if (!(lens.wavelength_nm >= 100 && lens.wavelength_nm <= 20000))
        top.fail("\"wavelength_nm\" must lie between 100 and 20000", top.find("wavelength_nm"));
    if (const std::vector<double> film = top.numbers("film_mm", 2); !film.empty()) {
        lens.film_width = film[0];
        lens.film_height = film[1];
    }
    lens.film_radius_of_curvature = film_radius(top);
    lens.film_placement = read_placement(top, "film_");
    const auto glasses = top.table("glass");
    const LensCoatings coatings(top, glasses);
    const toml::array* surfaces = root["surface"].as_array();
    if (!surfaces || !surfaces->is_array_of_tables()) top.fail("the lens has no surfaces; expected tables [[surface]]");
    // Limited before reading, because each surface may contain a long table of a glass, which is copied.
    if (surfaces->size() > static_cast<std::size_t>(kMaxSurfaces))
        top.fail("the lens has " + std::to_string(surfaces->size()) + " surfaces; at most " +
                     std::to_string(kMaxSurfaces) + " are supported",
                 surfaces);
    const LensZoom zoom(top);
    std::vector<bool> has_thickness;
    for (std::size_t i = 0; i < surfaces->size(); ++i) {
        const int number = static_cast<int>(i) + 1;
        const TomlTable table(*(*surfaces)[i].as_table(), file, number);
        lens.surfaces.push_back(
            read_surface(table, glasses, coatings, i + 1 == surfaces->size(), zoom.changes(number)));
        has_thickness.push_back(table.find("thickness_mm") != nullptr);
    }
    coatings.apply_default(lens, *surfaces);
    read_iris(top, lens);
    read_focusing(top, lens);
    if (lens.stop_index() >= 0) zoom.apply(lens, has_thickness, keep_going);
    lens.film_distance = top.number("film_distance_mm").value_or(0);
    check_lens(top, *surfaces, lens);
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    set_film_distance(top, lens);
    set_rings(top, lens);
    check_part(top, top.find("zoom") ? *top.find("zoom") : top.raw(), *surfaces, [&] { check_zoom(lens); });
    return lens;
}

LensSystem parse_lens(std::string_view text, const std::string& file, const KeepGoing& keep_going) {
    return lens_from_table(parse_toml(text, file, raise_lens_file_error, keep_going), file, keep_going);
}

}  // namespace realcam::io
