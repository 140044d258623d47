#include <functional>

#include "lens_toml.hpp"

namespace realcam::io {

namespace {

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

/// The terms of a row of kFormTerms as an inline table.
template <class Terms>
std::string table_of(const Terms& terms) {
    constexpr FormWords words = Terms::words;
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
        const auto radius = before_rounding(1 / form.curvature_x, form.curvature_x, [](double r) { return 1 / r; });
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
    over_terms(form, [&](const auto& terms) { lines += key(terms.words.key, table_of(terms)); });
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
