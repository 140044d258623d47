// Form and aperture of a surface in realcam's own lens files: reader and writer.

#include "lens_toml.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "../../optics/prescription/lens_limits.hpp"

namespace realcam::io {

namespace {

/// Parses a key of the table "radial_terms": a power of r from 1 to `max_power`.
int power_of(const TomlTable& table, std::string_view key, const toml::node& node, int max_power) {
    // A leading zero would let two keys name the same power.
    const bool digits =
        !key.empty() && key.size() < 3 && key.front() != '0' && key.find_first_not_of("0123456789") == key.npos;
    const int power = digits ? std::stoi(std::string(key)) : 0;
    if (power < 1 || power > max_power)
        table.fail("radial terms have powers from 1 to " + std::to_string(max_power) + " as keys; this one is \"" +
                       std::string(key) + '"',
                   &node);
    return power;
}

/// Reads the coefficients of r, r^2, r^3, ..., in this order.
std::vector<double> read_radial(const TomlTable& surface) {
    std::vector<double> values;
    const auto terms = surface.table("radial_terms");
    if (!terms) return values;
    for (const auto& [key, node] : terms->raw()) {
        const auto power = static_cast<std::size_t>(power_of(*terms, key.str(), node, kMaxRadialTerms));
        if (values.size() < power) values.resize(power, 0.0);
        values[power - 1] = terms->as_number(node, "the coefficient of r^" + std::to_string(power));
    }
    return values;
}

/// Reads the array "xy_terms"; empty if the key is absent.
std::vector<XyTerm> read_xy(const TomlTable& surface) {
    std::vector<XyTerm> terms;
    const toml::node* node = surface.find("xy_terms");
    if (!node) return terms;
    const std::string expected = "\"xy_terms\" must be an array of [power of x, power of y, coefficient]";
    if (!node->as_array()) surface.fail(expected, node);
    for (const toml::node& item : *node->as_array()) {
        const toml::array* triple = item.as_array();
        if (!triple || triple->size() != 3 || !(*triple)[0].is_integer() || !(*triple)[1].is_integer())
            surface.fail(expected + ", the powers whole numbers", &item);
        const auto power = [&](std::size_t i) {
            // Limited to fit an int; check_surfaces rejects powers that are out of range.
            return static_cast<int>(std::clamp<std::int64_t>(*(*triple)[i].value<std::int64_t>(), -1, 1000));
        };
        const XyTerm term{power(0), power(1), surface.as_number((*triple)[2], "a coefficient of \"xy_terms\"")};
        for (const XyTerm& other : terms)
            if (other.x == term.x && other.y == term.y)
                surface.fail("\"xy_terms\" has the powers " + std::to_string(term.x) + " and " +
                                 std::to_string(term.y) + " twice",
                             &item);
        terms.push_back(term);
    }
    return terms;
}

/// Reads polynomial terms of one kind (see kFormTerms), if the surface has their key.
template <class Terms>
void read_terms(const TomlTable& surface, std::optional<Terms>& terms) {
    constexpr FormNames words = Terms::words;
    const auto table = surface.table(words.key);
    if (!table) return;
    terms.emplace();
    if constexpr (requires { Terms::variant; }) {
        table->allow({words.variant_key, "radius_mm", words.coefficients_key});
        const std::string name = table->text(words.variant_key);
        const auto [first, second] = words.variants;
        if (name != first && name != second)
            table->fail(std::string{'"'} + words.variant_key + "\" must be \"" + first + "\" or \"" + second + '"',
                        table->find(words.variant_key));
        using Variant = std::remove_reference_t<decltype((*terms).*Terms::variant)>;
        (*terms).*Terms::variant = static_cast<Variant>(name == second);
    } else {
        table->allow({"radius_mm", words.coefficients_key});
    }
    const auto radius = table->number("radius_mm");
    if (!radius) table->fail("\"radius_mm\" is missing: the normalisation radius of the polynomials");
    terms->radius = *radius;
    terms->coefficients = table->numbers(words.coefficients_key, 0);
    if (terms->coefficients.empty()) table->fail(std::string{'"'} + words.coefficients_key + "\" is missing");
}

/// Returns two numbers as a vector; (0, 0) for an absent key.
Vec2d pair_of(const std::vector<double>& values) {
    return values.empty() ? Vec2d{0, 0} : Vec2d{values[0], values[1]};
}

/// Reads the key "polygon_mm", which must exist.
std::vector<Vec2d> read_corners(const TomlTable& table) {
    std::vector<Vec2d> corners;
    const toml::node* node = table.find("polygon_mm");
    const std::string expected = "\"polygon_mm\" must be an array of corners [x, y]";
    if (!node->as_array()) table.fail(expected, node);
    for (const toml::node& item : *node->as_array()) {
        const toml::array* corner = item.as_array();
        if (!corner || corner->size() != 2) table.fail(expected, &item);
        corners.push_back(
            {table.as_number((*corner)[0], "x of a corner"), table.as_number((*corner)[1], "y of a corner")});
    }
    return corners;
}

/// Returns the only one of these keys that a table has. Throws LensFileError with the message `expected` if it has none
/// or several.
std::string one_of(const TomlTable& table, const std::vector<std::string_view>& keys, const std::string& expected) {
    std::string found;
    for (const std::string_view key : keys) {
        if (!table.find(key)) continue;
        if (!found.empty()) table.fail(expected, table.find(key));
        found = key;
    }
    if (found.empty()) table.fail(expected);
    return found;
}

/// Appends an obscuration, or the arms of a spider, whose default length is `rim`.
void read_obscuration(const TomlTable& table, double rim, std::vector<Obscuration>& to) {
    const std::string kind =
        one_of(table, {"circle_mm", "ellipse_mm", "rectangle_mm", "spider_arms"},
               "an obscuration has one of \"circle_mm\", \"ellipse_mm\", \"rectangle_mm\" and \"spider_arms\"");
    if (kind == "spider_arms") {
        table.allow({"spider_arms", "width_mm", "length_mm", "angle_deg"});
        const double count = *table.number(kind), width = table.number("width_mm").value_or(0);
        if (!(count >= 1 && count <= kMaxObscurations && count == std::floor(count)))
            table.fail("\"spider_arms\" must be a whole number from 1 to " + std::to_string(kMaxObscurations),
                       table.find(kind));
        if (!(width > 0)) table.fail("\"width_mm\" of the arms must be a positive length", table.find("width_mm"));
        const auto arms = spider_arms(static_cast<int>(count), width, table.number("length_mm").value_or(rim),
                                      table.number("angle_deg").value_or(0));
        to.insert(to.end(), arms.begin(), arms.end());
        return;
    }
    table.allow({kind, "offset_mm", "angle_deg"});
    Obscuration piece;
    piece.is_rectangle = kind == "rectangle_mm";
    if (kind == "circle_mm")
        piece.half.x = piece.half.y = *table.number(kind);
    else
        piece.half = pair_of(table.numbers(kind, 2));
    piece.offset = pair_of(table.numbers("offset_mm", 2));
    piece.angle_deg = table.number("angle_deg").value_or(0);
    to.push_back(piece);
}

}  // namespace

SurfaceForm read_form(const TomlTable& table) {
    SurfaceForm form;
    if (table.find("form")) {
        const std::string name = table.text("form");
        if (name != "biconic" && name != "toroid")
            table.fail("\"form\" must be \"biconic\" or \"toroid\"", table.find("form"));
        form.base = name == "biconic" ? BaseForm::biconic : BaseForm::toroid;
    }
    const auto radius = table.number("radius_of_curvature_x_mm"), curvature = table.number("curvature_x_per_mm");
    if (radius && *radius == 0)
        table.fail("a radius of curvature must not be 0; leave it out for a plane section",
                   table.find("radius_of_curvature_x_mm"));
    if (radius && curvature)
        table.fail("\"radius_of_curvature_x_mm\" and \"curvature_x_per_mm\" say the same; specify only one of them",
                   table.find("curvature_x_per_mm"));
    form.curvature_x = radius ? 1 / *radius : curvature.value_or(0);
    form.conic_x = table.number("conic_x").value_or(0);
    form.radial = read_radial(table);
    form.xy = read_xy(table);
    for_each_kind_of_terms(form, [&](auto& terms) { read_terms(table, terms); });
    return form;
}

ApertureShape read_aperture(const TomlTable& surface, double rim) {
    ApertureShape shape;
    if (const auto table = surface.table("aperture")) {
        const std::string kind =
            one_of(*table, {"circle_mm", "ellipse_mm", "rectangle_mm", "polygon_mm"},
                   "an aperture has one of \"circle_mm\", \"ellipse_mm\", \"rectangle_mm\" and \"polygon_mm\"");
        table->allow({kind, "offset_mm"});
        shape.kind = kind == "circle_mm"      ? ApertureOutline::circle
                     : kind == "ellipse_mm"   ? ApertureOutline::ellipse
                     : kind == "rectangle_mm" ? ApertureOutline::rectangle
                                              : ApertureOutline::polygon;
        if (shape.kind == ApertureOutline::polygon)
            shape.corners = read_corners(*table);
        else if (shape.kind == ApertureOutline::circle)
            shape.half.x = shape.half.y = *table->number(kind);
        else
            shape.half = pair_of(table->numbers(kind, 2));
        shape.offset = pair_of(table->numbers("offset_mm", 2));
    }
    if (const toml::node* list = surface.find("obscurations")) {
        const toml::array* array = list->as_array();
        // An empty array is not homogeneous for toml++.
        if (!array || !(array->empty() || array->is_homogeneous(toml::node_type::table)))
            surface.fail("\"obscurations\" must be an array of tables", list);
        for (const toml::node& item : *array)
            read_obscuration(surface.within(*item.as_table()), rim, shape.obscurations);
    }
    return shape;
}

namespace {

/// Line of a table: a key and its value.
std::string key(const std::string& name, const std::string& value) {
    return name + " = " + value + '\n';
}

template <class T>
std::string list_of(const std::vector<T>& items, const std::function<std::string(const T&)>& text) {
    std::string list;
    for (const T& item : items) list += (list.empty() ? "" : ", ") + text(item);
    return '[' + list + ']';
}

std::string list_of(const std::vector<double>& values) {
    return list_of<double>(values, toml_number);
}

std::string pair(Vec2d v) {
    return '[' + toml_number(v.x) + ", " + toml_number(v.y) + ']';
}

std::string offset(Vec2d v) {
    return v == Vec2d{0, 0} ? "" : ", offset_mm = " + pair(v);
}

/// Polynomial terms of one kind (see kFormTerms) as an inline table.
template <class Terms>
std::string table_of(const Terms& terms) {
    constexpr FormNames words = Terms::words;
    std::string text = "{ ";
    if constexpr (requires { Terms::variant; })
        text += std::string(words.variant_key) + " = \"" +
                words.variants[static_cast<std::size_t>(terms.*Terms::variant)] + "\", ";
    return text + "radius_mm = " + toml_number(terms.radius) + ", " + words.coefficients_key + " = " +
           list_of(terms.coefficients) + " }";
}

std::string obscuration(const Obscuration& piece) {
    std::string text = piece.is_rectangle ? "{ rectangle_mm = " : "{ ellipse_mm = ";
    text += pair(piece.half) + offset(piece.offset);
    if (piece.angle_deg != 0) text += ", angle_deg = " + toml_number(piece.angle_deg);
    return text + " }";
}

}  // namespace

std::string form_as_toml(const SurfaceForm& form) {
    std::string lines;
    if (form.base != BaseForm::conic)
        lines += key("form", form.base == BaseForm::toroid ? "\"toroid\"" : "\"biconic\"");
    if (form.curvature_x != 0) {
        const auto radius = exact_preimage(1 / form.curvature_x, form.curvature_x, [](double r) { return 1 / r; });
        lines += radius ? key("radius_of_curvature_x_mm", toml_number(*radius))
                        : key("curvature_x_per_mm", toml_number(form.curvature_x));
    }
    if (form.conic_x != 0) lines += key("conic_x", toml_number(form.conic_x));
    if (!form.radial.empty()) {
        std::string list;
        for (std::size_t i = 0; i < form.radial.size(); ++i)
            list += (i == 0 ? "" : ", ") + std::to_string(i + 1) + " = " + toml_number(form.radial[i]);
        lines += key("radial_terms", "{ " + list + " }");
    }
    if (!form.xy.empty())
        lines += key("xy_terms", list_of<XyTerm>(form.xy, [](const XyTerm& term) {
                         return '[' + std::to_string(term.x) + ", " + std::to_string(term.y) + ", " +
                                toml_number(term.coefficient) + ']';
                     }));
    for_each_present_terms(form, [&](const auto& terms) { lines += key(terms.words.key, table_of(terms)); });
    return lines;
}

std::string aperture_as_toml(const ApertureShape& shape) {
    std::string lines;
    const auto aperture = [&](const std::string& kind, const std::string& value) {
        lines += key("aperture", "{ " + kind + " = " + value + offset(shape.offset) + " }");
    };
    switch (shape.kind) {
        case ApertureOutline::circle:
            if (shape.half.x > 0) aperture("circle_mm", toml_number(shape.half.x));
            break;
        case ApertureOutline::ellipse: aperture("ellipse_mm", pair(shape.half)); break;
        case ApertureOutline::rectangle: aperture("rectangle_mm", pair(shape.half)); break;
        case ApertureOutline::polygon: aperture("polygon_mm", list_of<Vec2d>(shape.corners, pair)); break;
    }
    if (!shape.obscurations.empty())
        lines += key("obscurations", list_of<Obscuration>(shape.obscurations, obscuration));
    return lines;
}

}  // namespace realcam::io
