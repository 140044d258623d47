#include "lens_file.hpp"

#include "../optics/focus.hpp"
#include "bundled_lenses.hpp"
#include "lens_coating.hpp"
#include "lens_material.hpp"
#include "regular_file.hpp"

#include <algorithm>

namespace realcam::io {
namespace {

constexpr int kFormat = 1;

SurfaceType read_type(const TomlTable& table) {
    const std::string type = table.text("type");
    if (type.empty() || type == "refracting") return SurfaceType::refracting;
    if (type == "mirror") return SurfaceType::mirror;
    if (type == "stop") return SurfaceType::stop;
    if (type == "aperture") return SurfaceType::aperture;
    table.fail("unknown type \"" + type + "\"; refracting, mirror, stop or aperture is wanted", table.find("type"));
}

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
                                   " as keys; this one is \"" + power_text + '"',
                               &node);
        const auto term = static_cast<std::size_t>(power / 2 - 2);
        if (values.size() <= term) values.resize(term + 1, 0.0);
        values[term] = coefficients->as_number(node, "the coefficient of r^" + power_text);
    }
    return values;
}

Surface read_surface(const TomlTable& table, const std::optional<TomlTable>& glasses, const LensCoatings& coatings,
                     bool is_last) {
    Surface surface;
    surface.type = read_type(table);
    if (surface.bends_light()) {
        table.allow({"type", "radius_of_curvature_mm", "thickness_mm", "material", "clear_semi_diameter_mm",
                     "inner_semi_diameter_mm", "conic", "aspheric_coefficients", "coating"});
    } else {
        table.allow({"type", "thickness_mm", "clear_semi_diameter_mm", "inner_semi_diameter_mm"});
    }
    if (const auto radius = table.number("radius_of_curvature_mm")) {
        if (*radius == 0)
            table.fail(
                "a radius of curvature of 0 is no surface; leave it out for a plane, and give the aperture "
                "stop as type = \"stop\"",
                table.find("radius_of_curvature_mm"));
        surface.curvature = 1 / *radius;
    }
    surface.conic = table.number("conic").value_or(0);
    surface.aspheric = read_aspheric_coefficients(table);
    if (surface.type == SurfaceType::mirror && table.find("material"))
        table.fail("a mirror has no material of its own; what lies before it lies behind it too",
                   table.find("material"));
    if (table.find("material")) surface.material = read_material(table, glasses);
    surface.coating = coatings.of(table);
    const auto thickness = table.number("thickness_mm");
    if (!thickness && !is_last) table.fail("\"thickness_mm\" is missing: the axial distance to the next surface");
    if (thickness && is_last)
        table.fail("the last surface has no \"thickness_mm\"; the film follows it (film_distance_mm, or focus)",
                   table.find("thickness_mm"));
    surface.thickness = thickness.value_or(0);
    const auto rim = table.number("clear_semi_diameter_mm");
    if (!rim) table.fail("\"clear_semi_diameter_mm\" is missing");
    surface.clear_semi_diameter = *rim;
    surface.inner_semi_diameter = table.number("inner_semi_diameter_mm").value_or(0);
    return surface;
}

void read_iris(const TomlTable& file, LensSystem& lens) {
    const auto iris = file.table("iris");
    if (!iris) return;
    iris->allow({"blades", "rounding", "rotation_deg"});
    const double blades = iris->number("blades").value_or(0);
    if (blades != std::floor(blades) || std::fabs(blades) > 1000)
        iris->fail("\"blades\" must be a whole number", iris->find("blades"));
    lens.iris.blades = static_cast<int>(blades);
    lens.iris.rounding = iris->number("rounding").value_or(0);
    lens.iris.rotation_rad = iris->number("rotation_deg").value_or(0) * std::numbers::pi / 180;
}

void read_focusing(const TomlTable& file, LensSystem& lens) {
    const auto focus = file.table("focus");
    if (!focus) return;
    focus->allow({"nearest_m", "group"});
    const auto nearest = focus->number("nearest_m");
    if (nearest && !(*nearest > 0)) focus->fail("\"nearest_m\" must be a positive distance", focus->find("nearest_m"));
    lens.focusing.nearest_mm = 1000 * nearest.value_or(0);
    const std::vector<double> group = focus->numbers("group", 2);
    if (group.empty()) return;
    const auto is_number = [](double n) { return n == std::floor(n) && n >= 1 && n < 1e6; };
    if (!is_number(group[0]) || !is_number(group[1]))
        focus->fail("\"group\" must be the numbers of its first and last surface, from 1", focus->find("group"));
    lens.focusing.group_first = static_cast<int>(group[0]) - 1;
    lens.focusing.group_last = static_cast<int>(group[1]) - 1;
}

/// A check of the finished lens, which knows nothing of the file: the error gets the line of the surface that it names,
/// or else of the part of the file that it is about.
template <class Check>
void check_part(const TomlTable& file, const toml::node& part, const toml::array& surfaces, Check&& check) {
    try {
        check();
    } catch (const LensFileError& error) {
        const toml::node& place = error.surface > 0 ? surfaces[static_cast<std::size_t>(error.surface) - 1] : part;
        throw LensFileError(error.detail, file.file(), static_cast<int>(place.source().begin.line), error.surface);
    }
}

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

/// A text of one line, fit for a terminal and a drawing.
std::string read_line(const TomlTable& file, std::string_view key) {
    const std::string text = file.text(key);
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]),
                   next = static_cast<unsigned char>(text[std::min(i + 1, text.size() - 1)]);
        // In UTF-8 the second block of control characters, U+0080 to U+009F, begins with C2.
        if (c < 0x20 || c == 0x7f || (c == 0xc2 && next < 0xa0))
            file.fail('"' + std::string(key) + "\" must be one line of text, without control characters",
                      file.find(key));
    }
    return text;
}

void set_film_distance(const TomlTable& file, LensSystem& lens) {
    const auto distance = file.number("film_distance_mm");
    if (distance && !(*distance > 0))
        file.fail("\"film_distance_mm\" must be positive: the film lies behind the last surface",
                  file.find("film_distance_mm"));
    const double at_infinity = best_focus_distance(lens, lens.wavelength_nm, kInfinity);
    if (!distance && !(at_infinity > 0))
        file.fail("the lens makes no real image of infinity behind its last surface; \"film_distance_mm\" is wanted");
    lens.film_distance = distance.value_or(at_infinity);
    if (const std::string why = film_distance_error(lens); !why.empty()) file.fail(why, file.find("film_distance_mm"));
}

LensSystem lens_from_table(const toml::table& root, const std::string& file) {
    const TomlTable top(root, file);
    top.allow({"format", "name", "title", "source", "wavelength_nm", "film_mm", "film_distance_mm", "glass", "coating",
               "default_coating", "surface", "iris", "focus", "allow_crossing"});
    const auto format = top.number("format");
    if (!format) top.fail("\"format = 1\" is missing");
    if (*format != kFormat)
        top.fail("format " + number_label(*format) + " is not known; this program reads format 1", top.find("format"));
    LensSystem lens;
    lens.name = read_line(top, "name");
    if (lens.name.empty()) top.fail("\"name\" is missing");
    lens.title = read_line(top, "title");
    lens.source = read_line(top, "source");
    lens.allow_crossing = top.flag("allow_crossing");
    lens.wavelength_nm = top.number("wavelength_nm").value_or(kLineD_nm);
    if (!(lens.wavelength_nm >= 100 && lens.wavelength_nm <= 20000))
        top.fail("\"wavelength_nm\" must lie between 100 and 20000", top.find("wavelength_nm"));
    if (const std::vector<double> film = top.numbers("film_mm", 2); !film.empty()) {
        lens.film_width = film[0];
        lens.film_height = film[1];
    }
    const auto glasses = top.table("glass");
    const LensCoatings coatings(top, glasses);
    const toml::array* surfaces = root["surface"].as_array();
    if (!surfaces || !surfaces->is_array_of_tables())
        top.fail("the lens has no surfaces; tables [[surface]] are wanted");
    for (std::size_t i = 0; i < surfaces->size(); ++i) {
        const TomlTable table(*(*surfaces)[i].as_table(), file, static_cast<int>(i) + 1);
        lens.surfaces.push_back(read_surface(table, glasses, coatings, i + 1 == surfaces->size()));
    }
    coatings.apply_default(lens, *surfaces);
    read_iris(top, lens);
    read_focusing(top, lens);
    check_lens(top, *surfaces, lens);
    lens.stop_semi_diameter = lens.stop().clear_semi_diameter;
    set_film_distance(top, lens);
    return lens;
}

/// Throws LensFileError for what is no ordinary file, and for one that is too long to be a lens.
std::string text_of_file(const std::string& path) {
    constexpr std::size_t kLargest = 16 << 20;  // bytes; the bundled lenses have some thousand
    try {
        RegularFile file(path);
        if (file.size() > kLargest) throw LensFileError("is larger than 16 MiB; a lens file (.toml) is wanted", path);
        std::string text(file.size(), '\0');
        text.resize(file.read(text.data(), text.size()));
        return text;
    } catch (const FileError& error) {
        throw LensFileError(error.reason, path);
    }
}

}  // namespace

std::vector<std::string> lens_names() {
    std::vector<std::string> names;
    for (const BundledFile& file : bundled_lens_files()) names.emplace_back(file.name);
    std::sort(names.begin(), names.end());  // with their ".toml" they are in another order: '-' comes before '.'
    return names;
}

std::string_view bundled_lens_text(const std::string& name) {
    for (const BundledFile& file : bundled_lens_files())
        if (file.name == name) return file.text;
    throw LensFileError("unknown lens " + in_quotes(name) + did_you_mean(name, lens_names()) +
                        "; a bundled lens (`realcam lens list` names them) or the path of a .toml file is wanted");
}

LensSystem parse_lens(std::string_view text, const std::string& file) {
    try {
        return lens_from_table(toml::parse(text, file), file);
    } catch (const toml::parse_error& error) {
        throw LensFileError("not valid TOML: " + printable(error.description()), file,
                            static_cast<int>(error.source().begin.line));
    }
}

LensSystem read_lens(const std::string& name_or_path) {
    if (name_or_path.find_first_of("/.") == std::string::npos)
        return parse_lens(bundled_lens_text(name_or_path), name_or_path);
    return parse_lens(text_of_file(name_or_path), name_or_path);
}

}  // namespace realcam::io
