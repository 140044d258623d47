#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "surface_changes.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

constexpr const char* kTypeNames[] = {"refracting", "mirror", "stop", "aperture"};

SurfaceType type_from(const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (name == kTypeNames[i]) return static_cast<SurfaceType>(i);
    throw InputError("unknown surface type \"" + name + "\"; refracting, mirror, stop or aperture is wanted");
}

std::vector<double> aspheric_from(const std::map<int, double>& coefficients) {
    std::vector<double> list;
    for (const auto& [power, value] : coefficients) {
        if (power < 4 || power % 2 != 0 || power > 2 * kMaxAsphericTerms + 2)
            throw InputError("aspheric coefficients have even powers from 4 to " +
                             std::to_string(2 * kMaxAsphericTerms + 2) + " as keys; one is " + std::to_string(power));
        const auto term = static_cast<std::size_t>(power / 2 - 2);
        if (list.size() <= term) list.resize(term + 1, 0.0);
        list[term] = value;
    }
    return list;
}

/// Converts (x, y, z); a decentre may omit z.
Vec3d triple_from(const std::vector<double>& values, std::size_t least, const char* what) {
    if (values.size() < least || values.size() > 3)
        throw InputError(std::string(what) + " is " + (least < 3 ? "(x, y) or (x, y, z)" : "(x, y, z)"));
    return {values[0], values[1], values.size() > 2 ? values[2] : 0};
}

std::map<int, double> aspheric_map(const Surface& surface) {
    std::map<int, double> map;
    for (std::size_t i = 0; i < surface.aspheric.size(); ++i)
        if (surface.aspheric[i] != 0) map[4 + 2 * static_cast<int>(i)] = surface.aspheric[i];
    return map;
}

std::string surface_text(const Surface& s) {
    std::string text = std::string("<realcam.Surface ") + kTypeNames[static_cast<int>(s.type)];
    if (s.curvature != 0) text += ", radius " + digits(1 / s.curvature) + " mm";
    text += ", semi-diameter " + digits(s.clear_semi_diameter) + " mm";
    if (s.is_asphere() || s.conic != 0) text += ", aspheric";
    if (const std::string why = s.form.asymmetry(); !why.empty()) text += ", " + why;
    if (s.placement.tilt_deg != Vec3d{0, 0, 0}) text += ", tilted";
    if (s.placement.decentre != Vec3d{0, 0, 0}) text += ", decentred";
    if (s.coating.kind != CoatingKind::unknown)
        text += ", " + (s.coating.name.empty() ? std::string("coated") : shortened(s.coating.name));
    return text + ", then " + digits(s.thickness) + " mm of " + glass_text(s.material) + '>';
}

/// The keys of kFormTerms.
py::tuple form_terms() {
    py::tuple keys(kFormTermsCount);
    for (std::size_t row = 0; row < kFormTermsCount; ++row) keys[row] = kFormWords[row].key;
    return keys;
}

/// Describes the dicts of all rows of kFormTerms, a line each: `zernike: {"order": "noll" or "fringe", ...}.`
std::string terms_text() {
    std::string text;
    for (const FormWords& words : kFormWords) {
        text += std::string(words.key) + ": {";
        if (*words.variant_key)
            text += '"' + std::string(words.variant_key) + "\": \"" + words.variants[0] + "\" or \"" +
                    words.variants[1] + "\", ";
        text += "\"radius_mm\", \"" + std::string(words.coefficients_key) + "\"}.\n";
    }
    return text;
}

/// Defines the constructor, with one keyword for each row of kFormTerms.
template <std::size_t... row>
void def_constructor(py::class_<Surface>& surface, std::index_sequence<row...>) {
    using C = SurfaceChanges;
    const std::string text = std::string(
                                 R"(radius_of_curvature_mm: positive where the centre lies on the film side; inf: plane.
thickness_mm: to the next surface; that of the last surface is not used.
material: behind the surface: index, (n_d, V_d), glass name, Glass, or None for air.
conic: k = -e^2. aspheric_coefficients: {even power of r: mm^(1 - power)}, powers 4 to 18.
inner_semi_diameter_mm: light closer to the axis is blocked.
type: refracting, mirror, stop or aperture (a plane that only blocks).
coating: "bare", "quarter_wave", of a mirror "aluminium" or "silver", a Coating, or "unknown": light
is then taken to meet bare glass, or a perfect mirror.
decentre_mm: (x, y) or (x, y, z) of the vertex, from its place on the axis. tilt_deg: angles by which it
is then turned about x, its new y and its new z, counterclockwise as seen from the axis's tip. returns:
this moves the surface alone; else the axis goes on from there, with all that follows and the film.
form: "biconic" or "toroid", of which radius and conic are the section in the yz plane, and
radius_of_curvature_x_mm and conic_x that in the xz plane. A toroid's even terms are of y.
radial_terms: {power of r: mm^(1 - power)}, powers 1 to 20. xy_terms: {(i, j): coefficient of x^i y^j}.
)") + terms_text() + R"(These parts are added to the conic.
aperture: {"ellipse_mm" or "rectangle_mm": (half_x, half_y)}, {"circle_mm": radius} or
{"polygon_mm": corners}, each with "offset_mm". obscurations: a list of {"circle_mm", "ellipse_mm" or
"rectangle_mm", "offset_mm", "angle_deg"} and {"spider_arms": count, "width_mm", "angle_deg"}.)";
    surface.def(py::init([](double radius_of_curvature, double thickness, const MediumLike& material,
                            double clear_semi_diameter, double conic, const std::map<int, double>& aspheric,
                            double inner_semi_diameter, const std::string& type, const CoatingLike& coating,
                            const std::vector<double>& decentre, const std::vector<double>& tilt, bool returns,
                            const C::Name& form, C::Number radius_x, C::Number conic_x, const C::RadialTerms& radial,
                            const C::XyTerms& xy, const TermsDict<row>&... terms, const C::Dict& aperture,
                            const C::Dicts& obscurations) {
                    return changed_surface(Surface(),
                                           {radius_of_curvature,
                                            thickness,
                                            glass_from(material),
                                            clear_semi_diameter,
                                            conic,
                                            aspheric,
                                            inner_semi_diameter,
                                            type,
                                            coating_from(coating),
                                            decentre,
                                            tilt,
                                            returns,
                                            {form, radius_x, conic_x, radial, xy, {terms...}, aperture, obscurations}});
                }),
                py::kw_only(), "radius_of_curvature_mm"_a = kInfinity, "thickness_mm"_a = 0.0,
                "material"_a = py::none(), "clear_semi_diameter_mm"_a, "conic"_a = 0.0,
                "aspheric_coefficients"_a = std::map<int, double>{}, "inner_semi_diameter_mm"_a = 0.0,
                "type"_a = "refracting", "coating"_a = "unknown", "decentre_mm"_a = std::vector<double>{0, 0, 0},
                "tilt_deg"_a = std::vector<double>{0, 0, 0}, "returns"_a = false, "form"_a = py::none(),
                "radius_of_curvature_x_mm"_a = py::none(), "conic_x"_a = py::none(), "radial_terms"_a = py::none(),
                "xy_terms"_a = py::none(), (py::arg(kFormWords[row].key) = py::none())..., "aperture"_a = py::none(),
                "obscurations"_a = py::none(), text.c_str());
}

}  // namespace

Surface changed_surface(Surface surface, const SurfaceChanges& to) {
    if (to.type) surface.type = type_from(*to.type);
    if (to.radius_of_curvature_mm) {
        const double radius = *to.radius_of_curvature_mm;
        if (radius == 0 || std::isnan(radius))
            throw InputError("a radius of curvature of 0 is no surface; leave it out (or give inf) for a plane");
        surface.curvature = 1 / radius;
    }
    if (to.aspheric_coefficients) surface.aspheric = aspheric_from(*to.aspheric_coefficients);
    surface.thickness = to.thickness_mm.value_or(surface.thickness);
    surface.material = to.material.value_or(surface.material);
    surface.clear_semi_diameter = to.clear_semi_diameter_mm.value_or(surface.clear_semi_diameter);
    surface.inner_semi_diameter = to.inner_semi_diameter_mm.value_or(surface.inner_semi_diameter);
    surface.conic = to.conic.value_or(surface.conic);
    surface.coating = to.coating.value_or(surface.coating);
    if (to.decentre_mm) surface.placement.decentre = triple_from(*to.decentre_mm, 2, "decentre_mm");
    if (to.tilt_deg) surface.placement.tilt_deg = triple_from(*to.tilt_deg, 3, "tilt_deg");
    surface.placement.returns = to.returns.value_or(surface.placement.returns);
    change_form(surface, to.form);
    return surface;
}

void bind_surface(py::module_& m) {
    py::class_<Surface> surface(
        m, "Surface",
        "One row of a lens table: a surface and what lies behind it. Lengths in mm, lens frame (z to the film).");
    def_hashable_value(surface);
    def_constructor(surface, kFormRows);
    for (std::size_t row = 0; row < kFormTermsCount; ++row)
        surface.def_property_readonly(kFormWords[row].key, [row](const Surface& s) { return terms_of(s, row); });
    surface
        .def_property_readonly("radius_of_curvature_mm",
                               [](const Surface& s) { return s.curvature == 0 ? kInfinity : 1 / s.curvature; })
        .def_readonly("curvature_per_mm", &Surface::curvature)
        .def_readonly("thickness_mm", &Surface::thickness)
        .def_readonly("material", &Surface::material)
        .def_readonly("clear_semi_diameter_mm", &Surface::clear_semi_diameter)
        .def_readonly("inner_semi_diameter_mm", &Surface::inner_semi_diameter)
        .def_readonly("conic", &Surface::conic)
        .def_property_readonly("aspheric_coefficients", &aspheric_map)
        .def_property_readonly("type", [](const Surface& s) { return kTypeNames[static_cast<int>(s.type)]; })
        .def_readonly("coating", &Surface::coating)
        .def_property_readonly("decentre_mm", [](const Surface& s) { return triple(s.placement.decentre); })
        .def_property_readonly("tilt_deg", [](const Surface& s) { return triple(s.placement.tilt_deg); })
        .def_property_readonly("returns", [](const Surface& s) { return s.placement.returns; })
        .def_property_readonly("form", &form_name)
        .def_property_readonly(
            "radius_of_curvature_x_mm",
            [](const Surface& s) { return s.form.curvature_x == 0 ? kInfinity : 1 / s.form.curvature_x; })
        .def_property_readonly("conic_x", [](const Surface& s) { return s.form.conic_x; })
        .def_property_readonly("radial_terms", &radial_terms_of)
        .def_property_readonly("xy_terms", &xy_terms_of)
        .def_property_readonly("aperture", &aperture_of)
        .def_property_readonly("obscurations", &obscurations_of)
        .def(
            "sag_mm", [](const Surface& s, double radius) { return s.sag(radius); }, "radius_mm"_a,
            "Height over the vertex plane at a distance from the axis, in the yz plane; nan past the edge of the "
            "conic.")
        .def(
            "sag_at_mm", [](const Surface& s, double x, double y) { return s.sag(x, y); }, "x_mm"_a, "y_mm"_a,
            "Height over the vertex plane; nan past the edge of the conic.")
        .def("__repr__", [](const Surface& s) { return surface_text(s); });
    m.def("_form_terms", &form_terms, "Keywords of Surface for terms of the sag, which are variables, too.");
    def_surface_changes(surface, "replace", &changed_surface,
                        "The surface with some of what Surface() takes changed. What is not given stays.");
}

}  // namespace realcam::bindings
