#include "surface_changes.hpp"

#include <cmath>

#include "../../optics/prescription/lens_limits.hpp"
#include "../../optics/prescription/lens_system.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

// `what` in the functions below names the dict in messages, such as "zernike".

/// Throws InputError if the dict has a key that is not in `keys`.
void allow_keys(const py::dict& dict, const std::string& what, const std::vector<std::string>& keys) {
    for (const auto& [key, value] : dict) {
        const auto name = py::str(key).cast<std::string>();
        bool known = false;
        std::string list;
        for (const std::string& allowed : keys) {
            known |= name == allowed;
            list += (list.empty() ? "" : ", ") + allowed;
        }
        if (!known) throw InputError(what + " has no key \"" + name + "\"; expected one of " + list);
    }
}

/// Returns the value of a key. Throws InputError if the key is missing or its value has the wrong type.
template <class T>
T value_of(const py::dict& dict, const char* key, const std::string& what) {
    if (!dict.contains(key)) throw InputError(what + " must have the key \"" + key + '"');
    try {
        return dict[key].cast<T>();
    } catch (const py::cast_error&) {
        throw InputError(what + ": \"" + key + "\" has the wrong type");
    }
}

/// Returns the value of a key, or `missing` if the dict does not have the key.
template <class T>
T value_or(const py::dict& dict, const char* key, const std::string& what, T missing) {
    return dict.contains(key) ? value_of<T>(dict, key, what) : missing;
}

using Pair = std::pair<double, double>;

Vec2d vec2_of(Pair v) {
    return {v.first, v.second};
}

Pair pair_of(Vec2d v) {
    return {v.x, v.y};
}

/// Converts a dict such as {"order": "noll", "radius_mm": 10, "coefficients_mm": [...]}.
template <class Terms>
Terms terms_from(const py::dict& dict) {
    constexpr FormNames words = Terms::words;
    const std::string what = words.key;
    Terms terms;
    if constexpr (requires { Terms::variant; }) {
        const auto [first, second] = words.variants;
        allow_keys(dict, what, {words.variant_key, "radius_mm", words.coefficients_key});
        const auto name = value_of<std::string>(dict, words.variant_key, what);
        if (name != first && name != second)
            throw InputError(what + ": \"" + words.variant_key + "\" must be \"" + first + "\" or \"" + second + '"');
        terms.*Terms::variant = static_cast<std::remove_reference_t<decltype(terms.*Terms::variant)>>(name == second);
    } else {
        allow_keys(dict, what, {"radius_mm", words.coefficients_key});
    }
    terms.radius = value_of<double>(dict, "radius_mm", what);
    terms.coefficients = value_of<std::vector<double>>(dict, words.coefficients_key, what);
    return terms;
}

template <class Terms>
void change_terms(std::optional<Terms>& terms, const std::optional<FormDict>& change) {
    if (!change) return;
    if (change->empty())
        terms.reset();
    else
        terms = terms_from<Terms>(*change);
}

/// Returns which of these keys the dict has. Throws InputError unless it has exactly one of them.
std::string only_key(const py::dict& dict, const std::string& what, const std::vector<const char*>& keys) {
    std::string found, list;
    int count = 0;
    for (const char* key : keys) {
        list += (list.empty() ? "" : ", ") + std::string(key);
        if (!dict.contains(key)) continue;
        found = key;
        ++count;
    }
    if (count != 1) throw InputError(what + " must have exactly one of the keys " + list);
    return found;
}

/// Replaces the outline of an aperture, but not its obscurations. An empty dict restores the circular aperture.
void change_aperture(ApertureShape& shape, const py::dict& dict) {
    const std::string what = "aperture";
    ApertureShape next;
    next.obscurations = shape.obscurations;
    if (!dict.empty()) {
        const std::string outline = only_key(dict, what, {"circle_mm", "ellipse_mm", "rectangle_mm", "polygon_mm"});
        allow_keys(dict, what, {outline, "offset_mm"});
        next.offset = vec2_of(value_or<Pair>(dict, "offset_mm", what, {0, 0}));
        if (outline == "polygon_mm") {
            next.kind = ApertureOutline::polygon;
            for (const Pair& corner : value_of<std::vector<Pair>>(dict, "polygon_mm", what))
                next.corners.push_back(vec2_of(corner));
        } else if (outline == "circle_mm") {
            next.half.x = next.half.y = value_of<double>(dict, "circle_mm", what);
        } else {
            next.kind = outline == "ellipse_mm" ? ApertureOutline::ellipse : ApertureOutline::rectangle;
            next.half = vec2_of(value_of<Pair>(dict, outline.c_str(), what));
        }
    }
    shape = next;
}

/// Appends the obscuration that a dict describes, or the arms of a spider. `clear_semi_diameter`: of the surface, in
/// mm, the default length of the arms.
void add_obscuration(const py::dict& dict, double clear_semi_diameter, std::vector<Obscuration>& obscurations) {
    const std::string what = "an obscuration";
    const std::string outline = only_key(dict, what, {"circle_mm", "ellipse_mm", "rectangle_mm", "spider_arms"});
    if (outline == "spider_arms") {
        allow_keys(dict, what, {"spider_arms", "width_mm", "length_mm", "angle_deg"});
        const int count = value_of<int>(dict, "spider_arms", what);
        if (count < 1 || count > kMaxObscurations)
            throw InputError("spider_arms must lie between 1 and " + std::to_string(kMaxObscurations));
        const auto arms =
            spider_arms(count, value_of<double>(dict, "width_mm", what),
                        value_or(dict, "length_mm", what, clear_semi_diameter), value_or(dict, "angle_deg", what, 0.0));
        obscurations.insert(obscurations.end(), arms.begin(), arms.end());
        return;
    }
    allow_keys(dict, what, {outline, "offset_mm", "angle_deg"});
    Obscuration obscuration;
    obscuration.is_rectangle = outline == "rectangle_mm";
    if (outline == "circle_mm")
        obscuration.half.x = obscuration.half.y = value_of<double>(dict, "circle_mm", what);
    else
        obscuration.half = vec2_of(value_of<Pair>(dict, outline.c_str(), what));
    obscuration.offset = vec2_of(value_or<Pair>(dict, "offset_mm", what, {0, 0}));
    obscuration.angle_deg = value_or(dict, "angle_deg", what, 0.0);
    obscurations.push_back(obscuration);
}

}  // namespace

void change_form(Surface& surface, const FormChanges& changes) {
    SurfaceForm& form = surface.form;
    if (changes.form) {
        if (*changes.form != "conic" && *changes.form != "biconic" && *changes.form != "toroid")
            throw InputError("unknown form \"" + *changes.form + "\"; expected conic, biconic or toroid");
        form.base = *changes.form == "toroid"    ? BaseForm::toroid
                    : *changes.form == "biconic" ? BaseForm::biconic
                                                 : BaseForm::conic;
    }
    if (changes.radius_of_curvature_x_mm) {
        if (*changes.radius_of_curvature_x_mm == 0 || std::isnan(*changes.radius_of_curvature_x_mm))
            throw InputError("radius_of_curvature_x_mm must not be 0; inf means no curvature");
        form.curvature_x = 1 / *changes.radius_of_curvature_x_mm;
    }
    form.conic_x = changes.conic_x.value_or(form.conic_x);
    if (changes.radial_terms) {
        form.radial.clear();
        for (const auto& [power, value] : *changes.radial_terms) {
            if (power < 1 || power > kMaxRadialTerms)
                throw InputError("the keys of radial_terms must be powers from 1 to " +
                                 std::to_string(kMaxRadialTerms) + "; found " + std::to_string(power));
            form.radial.resize(static_cast<std::size_t>(power), 0.0);
            form.radial.back() = value;
        }
    }
    if (changes.xy_terms) {
        form.xy.clear();
        for (const auto& [powers, value] : *changes.xy_terms) form.xy.push_back({powers.first, powers.second, value});
    }
    std::size_t kind = 0;
    for_each_kind_of_terms(form, [&](auto& terms) { change_terms(terms, changes.terms[kind++]); });
    if (changes.aperture) change_aperture(surface.aperture_shape, *changes.aperture);
    if (changes.obscurations) {
        surface.aperture_shape.obscurations.clear();
        for (const py::dict& dict : *changes.obscurations)
            add_obscuration(dict, surface.clear_semi_diameter, surface.aperture_shape.obscurations);
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

std::map<int, double> stored_radial_terms(const Surface& surface) {
    std::map<int, double> terms;
    for (std::size_t i = 0; i < surface.form.radial.size(); ++i)
        if (surface.form.radial[i] != 0) terms[static_cast<int>(i) + 1] = surface.form.radial[i];
    return terms;
}

std::map<std::pair<int, int>, double> stored_xy_terms(const Surface& surface) {
    std::map<std::pair<int, int>, double> terms;
    for (const XyTerm& term : surface.form.xy) terms[{term.x, term.y}] = term.coefficient;
    return terms;
}

FormDict terms_of(const Surface& surface, std::size_t kind) {
    py::dict result;
    std::size_t i = 0;
    for_each_kind_of_terms(surface.form, [&](const auto& terms) {
        if (i++ != kind || !terms) return;
        using Terms = TermsIn<decltype(terms)>;
        constexpr FormNames words = Terms::words;
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
    for (const Obscuration& obscuration : surface.aperture_shape.obscurations) {
        py::dict dict;
        dict[obscuration.is_rectangle ? "rectangle_mm" : "ellipse_mm"] = pair_of(obscuration.half);
        dict["offset_mm"] = pair_of(obscuration.offset);
        dict["angle_deg"] = obscuration.angle_deg;
        list.push_back(dict);
    }
    return list;
}

}  // namespace realcam::bindings
