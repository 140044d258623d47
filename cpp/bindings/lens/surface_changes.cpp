#include "surface_changes.hpp"

#include <cmath>

#include "../../optics/prescription/lens_limits.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Throws InputError for unknown keys.
void allow(const py::dict& given, const std::string& what, const std::vector<std::string>& keys) {
    for (const auto& [key, value] : given) {
        const auto name = py::str(key).cast<std::string>();
        bool known = false;
        std::string list;
        for (const std::string& allowed : keys) {
            known |= name == allowed;
            list += (list.empty() ? "" : ", ") + allowed;
        }
        if (!known) throw InputError(what + " has no key \"" + name + "\"; wanted are " + list);
    }
}

template <class T>
T value_of(const py::dict& given, const char* key, const std::string& what) {
    if (!given.contains(key)) throw InputError(what + " wants \"" + key + '"');
    try {
        return given[key].cast<T>();
    } catch (const py::cast_error&) {
        throw InputError(what + ": \"" + key + "\" has the wrong type");
    }
}

template <class T>
T value_or(const py::dict& given, const char* key, const std::string& what, T otherwise) {
    return given.contains(key) ? value_of<T>(given, key, what) : otherwise;
}

using Pair = std::pair<double, double>;

Vec2d vector_of(Pair v) {
    return {v.first, v.second};
}

Pair pair_of(Vec2d v) {
    return {v.x, v.y};
}

template <class Terms>
Terms terms_from(const py::dict& given) {
    constexpr FormWords words = Terms::words;
    const std::string what = words.key;
    Terms terms;
    if constexpr (requires { Terms::variant; }) {
        const auto [first, second] = words.variants;
        allow(given, what, {words.variant_key, "radius_mm", words.coefficients_key});
        const auto name = value_of<std::string>(given, words.variant_key, what);
        if (name != first && name != second)
            throw InputError(what + ": \"" + words.variant_key + "\" must be \"" + first + "\" or \"" + second + '"');
        terms.*Terms::variant = static_cast<std::remove_reference_t<decltype(terms.*Terms::variant)>>(name == second);
    } else {
        allow(given, what, {"radius_mm", words.coefficients_key});
    }
    terms.radius = value_of<double>(given, "radius_mm", what);
    terms.coefficients = value_of<std::vector<double>>(given, words.coefficients_key, what);
    return terms;
}

template <class Terms>
void change_terms(std::optional<Terms>& terms, const std::optional<FormDict>& to) {
    if (!to) return;
    if (to->empty())
        terms.reset();
    else
        terms = terms_from<Terms>(*to);
}

/// Returns the one of these keys that is present.
std::string one_of(const py::dict& given, const std::string& what, const std::vector<const char*>& keys) {
    std::string found, list;
    int count = 0;
    for (const char* key : keys) {
        list += (list.empty() ? "" : ", ") + std::string(key);
        if (!given.contains(key)) continue;
        found = key;
        ++count;
    }
    if (count != 1) throw InputError(what + " wants one of the keys " + list);
    return found;
}

void change_aperture(ApertureShape& shape, const py::dict& given) {
    const std::string what = "aperture";
    ApertureShape next;
    next.obscurations = shape.obscurations;
    if (!given.empty()) {
        const std::string kind = one_of(given, what, {"circle_mm", "ellipse_mm", "rectangle_mm", "polygon_mm"});
        allow(given, what, {kind, "offset_mm"});
        next.offset = vector_of(value_or<Pair>(given, "offset_mm", what, {0, 0}));
        if (kind == "polygon_mm") {
            next.kind = ApertureOutline::polygon;
            for (const Pair& corner : value_of<std::vector<Pair>>(given, "polygon_mm", what))
                next.corners.push_back(vector_of(corner));
        } else if (kind == "circle_mm") {
            next.half.x = next.half.y = value_of<double>(given, "circle_mm", what);
        } else {
            next.kind = kind == "ellipse_mm" ? ApertureOutline::ellipse : ApertureOutline::rectangle;
            next.half = vector_of(value_of<Pair>(given, kind.c_str(), what));
        }
    }
    shape = next;
}

void add_obscuration(const py::dict& given, double rim, std::vector<Obscuration>& to) {
    const std::string what = "an obscuration";
    const std::string kind = one_of(given, what, {"circle_mm", "ellipse_mm", "rectangle_mm", "spider_arms"});
    if (kind == "spider_arms") {
        allow(given, what, {"spider_arms", "width_mm", "length_mm", "angle_deg"});
        const int count = value_of<int>(given, "spider_arms", what);
        if (count < 1 || count > kMaxObscurations)
            throw InputError("a spider has 1 to " + std::to_string(kMaxObscurations) + " arms");
        const auto arms = spider_arms(count, value_of<double>(given, "width_mm", what),
                                      value_or(given, "length_mm", what, rim), value_or(given, "angle_deg", what, 0.0));
        to.insert(to.end(), arms.begin(), arms.end());
        return;
    }
    allow(given, what, {kind, "offset_mm", "angle_deg"});
    Obscuration piece;
    piece.is_rectangle = kind == "rectangle_mm";
    if (kind == "circle_mm")
        piece.half.x = piece.half.y = value_of<double>(given, "circle_mm", what);
    else
        piece.half = vector_of(value_of<Pair>(given, kind.c_str(), what));
    piece.offset = vector_of(value_or<Pair>(given, "offset_mm", what, {0, 0}));
    piece.angle_deg = value_or(given, "angle_deg", what, 0.0);
    to.push_back(piece);
}

}  // namespace

void change_form(Surface& surface, const FormChanges& to) {
    SurfaceForm& form = surface.form;
    if (to.form) {
        if (*to.form != "conic" && *to.form != "biconic" && *to.form != "toroid")
            throw InputError("unknown form \"" + *to.form + "\"; conic, biconic or toroid is wanted");
        form.base = *to.form == "toroid"    ? BaseForm::toroid
                    : *to.form == "biconic" ? BaseForm::biconic
                                            : BaseForm::conic;
    }
    if (to.radius_of_curvature_x_mm) {
        if (*to.radius_of_curvature_x_mm == 0 || std::isnan(*to.radius_of_curvature_x_mm))
            throw InputError("a radius of curvature of 0 is no surface; leave it out (or give inf) for none");
        form.curvature_x = 1 / *to.radius_of_curvature_x_mm;
    }
    form.conic_x = to.conic_x.value_or(form.conic_x);
    if (to.radial_terms) {
        form.radial.clear();
        for (const auto& [power, value] : *to.radial_terms) {
            if (power < 1 || power > kMaxRadialTerms)
                throw InputError("radial terms have powers from 1 to " + std::to_string(kMaxRadialTerms) +
                                 " as keys; one is " + std::to_string(power));
            form.radial.resize(static_cast<std::size_t>(power), 0.0);
            form.radial.back() = value;
        }
    }
    if (to.xy_terms) {
        form.xy.clear();
        for (const auto& [powers, value] : *to.xy_terms) form.xy.push_back({powers.first, powers.second, value});
    }
    std::size_t row = 0;
    over_rows(form, [&](auto& terms) { change_terms(terms, to.terms[row++]); });
    if (to.aperture) change_aperture(surface.aperture_shape, *to.aperture);
    if (to.obscurations) {
        surface.aperture_shape.obscurations.clear();
        for (const py::dict& given : *to.obscurations)
            add_obscuration(given, surface.clear_semi_diameter, surface.aperture_shape.obscurations);
    }
}

std::string form_name(const Surface& surface) {
    switch (surface.form.base) {
        case BaseForm::biconic: return "biconic";
        case BaseForm::toroid: return "toroid";
        case BaseForm::conic: break;
    }
    return "conic";
}

std::map<int, double> radial_terms_of(const Surface& surface) {
    std::map<int, double> terms;
    for (std::size_t i = 0; i < surface.form.radial.size(); ++i)
        if (surface.form.radial[i] != 0) terms[static_cast<int>(i) + 1] = surface.form.radial[i];
    return terms;
}

std::map<std::pair<int, int>, double> xy_terms_of(const Surface& surface) {
    std::map<std::pair<int, int>, double> terms;
    for (const XyTerm& term : surface.form.xy) terms[{term.x, term.y}] = term.coefficient;
    return terms;
}

FormDict terms_of(const Surface& surface, std::size_t row) {
    py::dict result;
    std::size_t i = 0;
    over_rows(surface.form, [&](const auto& terms) {
        if (i++ != row || !terms) return;
        using Terms = TermsIn<decltype(terms)>;
        constexpr FormWords words = Terms::words;
        if constexpr (requires { Terms::variant; })
            result[words.variant_key] = words.variants[static_cast<std::size_t>((*terms).*Terms::variant)];
        result["radius_mm"] = terms->radius;
        result[words.coefficients_key] = terms->coefficients;
    });
    return result;
}

FormDict aperture_of(const Surface& surface) {
    const ApertureShape& shape = surface.aperture_shape;
    py::dict result;
    switch (shape.kind) {
        case ApertureOutline::circle:
            if (shape.half.x == 0) return result;
            result["circle_mm"] = shape.half.x;
            break;
        case ApertureOutline::ellipse: result["ellipse_mm"] = pair_of(shape.half); break;
        case ApertureOutline::rectangle: result["rectangle_mm"] = pair_of(shape.half); break;
        case ApertureOutline::polygon: {
            std::vector<Pair> corners;
            for (const Vec2d& corner : shape.corners) corners.push_back(pair_of(corner));
            result["polygon_mm"] = corners;
        }
    }
    if (shape.offset != Vec2d{0, 0}) result["offset_mm"] = pair_of(shape.offset);
    return result;
}

std::vector<FormDict> obscurations_of(const Surface& surface) {
    std::vector<FormDict> list;
    for (const Obscuration& piece : surface.aperture_shape.obscurations) {
        py::dict plain;
        plain[piece.is_rectangle ? "rectangle_mm" : "ellipse_mm"] = pair_of(piece.half);
        plain["offset_mm"] = pair_of(piece.offset);
        plain["angle_deg"] = piece.angle_deg;
        list.push_back(plain);
    }
    return list;
}

}  // namespace realcam::bindings
