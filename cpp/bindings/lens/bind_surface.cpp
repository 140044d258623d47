// The Python class Surface.

#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "surface_changes.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

constexpr const char* kTypeNames[] = {"refracting", "mirror", "stop", "aperture"};  ///< in the order of SurfaceType

SurfaceType type_from(const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (name == kTypeNames[i]) return static_cast<SurfaceType>(i);
    throw InputError("unknown surface type \"" + name + "\"; expected refracting, mirror, stop or aperture");
}

/// Converts coefficients by their powers of r to the list of the coefficients of r^4, r^6, .... Throws InputError for
/// other powers.
std::vector<double> aspheric_from(const std::map<int, double>& coefficients) {
    std::vector<double> list;
    for (const auto& [power, value] : coefficients) {
        if (power < 4 || power % 2 != 0 || power > 2 * kMaxAsphericTerms + 2)
            throw InputError("the keys of aspheric_coefficients must be even powers from 4 to " +
                             std::to_string(2 * kMaxAsphericTerms + 2) + "; found " + std::to_string(power));
        const auto term = static_cast<std::size_t>(power / 2 - 2);
        if (list.size() <= term) list.resize(term + 1, 0.0);
        list[term] = value;
    }
    return list;
}

/// Converts (x, y, z), or (x, y) if `min_size` is 2. `what`: name of the argument, for the message. Throws InputError.
Vec3d triple_from(const std::vector<double>& values, std::size_t min_size, const char* what) {
    if (values.size() < min_size || values.size() > 3)
        throw InputError(std::string(what) + " must be " + (min_size < 3 ? "(x, y) or (x, y, z)" : "(x, y, z)"));
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

/// Returns the keys of all kinds of terms in kFormTerms.
Typed<"tuple[str, ...]", py::tuple> form_terms() {
    py::tuple keys(kFormTermsCount);
    for (std::size_t kind = 0; kind < kFormTermsCount; ++kind) keys[kind] = kFormNames[kind].key;
    return keys;
}

/// Describes the dicts of all kinds of terms, in one line each: `zernike: {"order": "noll" or "fringe", ...}.`
std::string terms_text() {
    std::string text;
    for (const FormNames& words : kFormNames) {
        text += std::string(words.key) + ": {";
        if (*words.variant_key)
            text += '"' + std::string(words.variant_key) + "\": \"" + words.variants[0] + "\" or \"" +
                    words.variants[1] + "\", ";
        text += "\"radius_mm\", \"" + std::string(words.coefficients_key) + "\"}.\n";
    }
    return text;
}

/// Defines the constructor, with one keyword for each kind of terms in kFormTerms.
template <std::size_t... kind>
void def_constructor(py::class_<Surface>& surface, std::index_sequence<kind...>) {
    using C = SurfaceChanges;
    const std::string text = std::string(
                                 R"(radius_of_curvature_mm: positive if the centre lies on the film's side; inf: plane.
thickness_mm: distance along the axis to the next surface; ignored for the last surface.
material: medium behind the surface: a refractive index, (n_d, V_d), the name of a glass, a Glass, or None for air.
clear_semi_diameter_mm: radius within which the surface transmits or reflects light.
conic: conic constant k = -e^2. aspheric_coefficients: {even power of r, 4 to 18: coefficient in mm^(1 - power)}.
inner_semi_diameter_mm: radius of a hole or central obstruction; light closer to the axis is blocked.
type: "refracting", "mirror", "stop", or "aperture" (a plane that only blocks light).
coating: "bare", "quarter_wave", for a mirror "aluminium" or "silver", a Coating, or "unknown", which counts as bare
  glass or as a perfect mirror.
decentre_mm: (x, y) or (x, y, z), displacement of the vertex from its position on the axis. tilt_deg: (x, y, z),
  rotations after the displacement, about x, then the new y, then the new z, counterclockwise as seen from the tip of
  the rotation axis.
returns: True: decentre and tilt move this surface alone; False: they move all following surfaces and the film, too.
form: "conic", "biconic" or "toroid". For the latter two, radius_of_curvature_mm and conic describe the section in the
  yz plane, radius_of_curvature_x_mm and conic_x that in the xz plane. A toroid's even terms are powers of y.
radial_terms: {power of r, 1 to 20: coefficient in mm^(1 - power)}. xy_terms: {(i, j): coefficient of x^i y^j}.
)") + terms_text() + R"(All terms are added to the sag of the conic.
aperture: shape of the clear aperture within the clear semi-diameter: {"circle_mm": radius}, {"ellipse_mm" or
  "rectangle_mm": (half_x, half_y)} or {"polygon_mm": list of corners (x, y)}, each optionally with "offset_mm": (x, y).
obscurations: list of {"circle_mm", "ellipse_mm" or "rectangle_mm", "offset_mm", "angle_deg"} and of
  {"spider_arms": count, "width_mm", "length_mm", "angle_deg"}.
Raises InputError.)";
    surface.def(py::init([](double radius_of_curvature, double thickness, const MediumLike& material,
                            double clear_semi_diameter, double conic, const std::map<int, double>& aspheric,
                            double inner_semi_diameter, const std::string& type, const CoatingLike& coating,
                            const std::vector<double>& decentre, const std::vector<double>& tilt, bool returns,
                            const C::Name& form, C::Number radius_x, C::Number conic_x, const C::RadialTerms& radial,
                            const C::XyTerms& xy, const TermsDict<kind>&... terms, const C::Dict& aperture,
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
                "xy_terms"_a = py::none(), (py::arg(kFormNames[kind].key) = py::none())..., "aperture"_a = py::none(),
                "obscurations"_a = py::none(), text.c_str());
}

}  // namespace

Surface changed_surface(Surface surface, const SurfaceChanges& changes) {
    if (changes.type) surface.type = type_from(*changes.type);
    if (changes.radius_of_curvature_mm) {
        const double radius = *changes.radius_of_curvature_mm;
        if (radius == 0 || std::isnan(radius))
            throw InputError("radius_of_curvature_mm must not be 0; inf means a plane");
        surface.curvature = 1 / radius;
    }
    if (changes.aspheric_coefficients) surface.aspheric = aspheric_from(*changes.aspheric_coefficients);
    surface.thickness = changes.thickness_mm.value_or(surface.thickness);
    surface.material = changes.material.value_or(surface.material);
    surface.clear_semi_diameter = changes.clear_semi_diameter_mm.value_or(surface.clear_semi_diameter);
    surface.inner_semi_diameter = changes.inner_semi_diameter_mm.value_or(surface.inner_semi_diameter);
    surface.conic = changes.conic.value_or(surface.conic);
    surface.coating = changes.coating.value_or(surface.coating);
    if (changes.decentre_mm) surface.placement.decentre = triple_from(*changes.decentre_mm, 2, "decentre_mm");
    if (changes.tilt_deg) surface.placement.tilt_deg = triple_from(*changes.tilt_deg, 3, "tilt_deg");
    surface.placement.returns = changes.returns.value_or(surface.placement.returns);
    change_form(surface, changes.form);
    return surface;
}

void bind_surface(py::module_& m) {
    py::class_<Surface> surface(
        m, "Surface",
        "A surface of a lens, with the medium and the distance behind it. Lengths in mm, z towards the film. The "
        "constructor describes the properties.");
    def_hashable_value(surface);
    def_constructor(surface, kFormTermsIndices);
    for (std::size_t kind = 0; kind < kFormTermsCount; ++kind)
        surface.def_property_readonly(
            kFormNames[kind].key, [kind](const Surface& s) { return terms_of(s, kind); },
            "Terms of the sag, see Surface(); an empty dict if there are no such terms.");
    surface
        .def_property_readonly(
            "radius_of_curvature_mm", [](const Surface& s) { return s.curvature == 0 ? kInfinity : 1 / s.curvature; },
            "Radius of curvature at the vertex, of the conic; inf: plane.")
        .def_readonly("curvature_per_mm", &Surface::curvature, "1 / radius_of_curvature_mm.")
        .def_readonly("thickness_mm", &Surface::thickness, "Distance along the axis to the next surface.")
        .def_readonly("material", &Surface::material, "Glass behind the surface.")
        .def_readonly("clear_semi_diameter_mm", &Surface::clear_semi_diameter,
                      "Radius within which the surface transmits or reflects light.")
        .def_readonly("inner_semi_diameter_mm", &Surface::inner_semi_diameter,
                      "Radius of a hole or central obstruction; 0: there is none.")
        .def_readonly("conic", &Surface::conic, "Conic constant k = -e^2.")
        .def_property_readonly("aspheric_coefficients", &aspheric_map,
                               "{even power of r: coefficient in mm^(1 - power)}, without those that are 0.")
        .def_property_readonly(
            "type", [](const Surface& s) { return kTypeNames[static_cast<int>(s.type)]; },
            "\"refracting\", \"mirror\", \"stop\" or \"aperture\".")
        .def_readonly("coating", &Surface::coating, "Coating.")
        .def_property_readonly(
            "decentre_mm", [](const Surface& s) { return triple(s.placement.decentre); },
            "(x, y, z), displacement of the vertex.")
        .def_property_readonly(
            "tilt_deg", [](const Surface& s) { return triple(s.placement.tilt_deg); },
            "(x, y, z), rotations about x, the new y and the new z.")
        .def_property_readonly(
            "returns", [](const Surface& s) { return s.placement.returns; },
            "True if decentre_mm and tilt_deg move this surface alone.")
        .def_property_readonly("form", &form_name, "\"conic\", \"biconic\" or \"toroid\".")
        .def_property_readonly(
            "radius_of_curvature_x_mm",
            [](const Surface& s) { return s.form.curvature_x == 0 ? kInfinity : 1 / s.form.curvature_x; },
            "Radius of curvature in the xz plane, of a biconic or toroid.")
        .def_property_readonly(
            "conic_x", [](const Surface& s) { return s.form.conic_x; }, "Conic constant in the xz plane, of a biconic.")
        .def_property_readonly("radial_terms", &stored_radial_terms,
                               "{power of r: coefficient in mm^(1 - power)}, without those that are 0.")
        .def_property_readonly("xy_terms", &stored_xy_terms, "{(i, j): coefficient of x^i y^j}.")
        .def_property_readonly(
            "aperture", &aperture_of,
            "Shape of the clear aperture, see Surface(); empty: the circle of the clear semi-diameter.")
        .def_property_readonly("obscurations", &obscurations_of, "List of obscurations, see Surface().")
        .def(
            "sag_mm", [](const Surface& s, double radius) { return s.sag(radius); }, "radius_mm"_a,
            "Returns the sag, the height over the vertex plane, in the yz plane at a distance from the axis; nan "
            "beyond "
            "the edge of the conic.")
        .def(
            "sag_at_mm", [](const Surface& s, double x, double y) { return s.sag(x, y); }, "x_mm"_a, "y_mm"_a,
            "Returns the sag, the height over the vertex plane, at a point; nan beyond the edge of the conic.")
        .def("__repr__", [](const Surface& s) { return surface_text(s); });
    m.def("_form_terms", &form_terms,
          "Internal. Returns the keywords of Surface() whose values are dicts of sag terms, such as \"zernike\".");
    def_surface_changes(
        surface, "replace", &changed_surface,
        "Returns a copy with some properties changed. Arguments as for Surface(); those that are omitted "
        "stay. Raises InputError.");
}

}  // namespace realcam::bindings
