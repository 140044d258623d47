// The Python classes Coating, CoatingLayer and CoatingResponse.

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "../../optics/coating/coated_surface.hpp"
#include "../../optics/prescription/coating.hpp"
#include "../../optics/prescription/coating_checks.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/restored.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "surface_changes.hpp"

namespace realcam::bindings {

using namespace py::literals;

Coating coating_from(const py::object& coating) {
    if (py::isinstance<Coating>(coating)) return coating.cast<Coating>();
    if (py::isinstance<py::str>(coating))
        if (auto known = named_coating(coating.cast<std::string>())) return *known;
    std::string names;
    for (const std::string& name : named_coatings()) names += (names.empty() ? "\"" : ", \"") + name + '"';
    throw InputError("a coating must be one of " + names + ", or a Coating");
}

namespace {

using Array = py::array_t<double>;

/// Names in the order of CoatingKind.
constexpr const char* kKindNames[] = {"unknown", "bare", "layers", "metal", "reflectance"};

/// Converts a sequence of (wavelength_nm, n, k); returns std::nullopt for other or empty sequences.
std::optional<CoatingMaterial> points_from(const py::object& material) {
    try {
        CoatingMaterial result;
        for (const auto& [nm, n, k] : material.cast<std::vector<std::tuple<double, double, double>>>())
            result.points.push_back({nm, n, k});
        if (!result.points.empty()) return result;
    } catch (const py::cast_error&) {
        // The value is not a list of (nm, n, k) points; the caller tries the other forms of a medium.
    }
    return std::nullopt;
}

/// Converts the material of a layer or a metal, see CoatingMaterialLike. Throws InputError.
CoatingMaterial coating_material_from(const py::object& material) {
    if (PyComplex_Check(material.ptr())) {
        CoatingMaterial result = CoatingMaterial::constant(material.cast<std::complex<double>>());
        result.label = py::str(material).cast<std::string>();
        return result;
    }
    if (py::isinstance<py::str>(material)) {
        if (auto metal = named_metal(material.cast<std::string>())) return *metal;
    } else if (py::isinstance<py::sequence>(material)) {
        if (auto table = points_from(material)) return *table;
    } else if (material.is_none()) {
        throw InputError(
            "a coating's material must be an index, a complex n + ik, (n_d, V_d), [(wavelength_nm, n, k), ...], a "
            "name or a Glass");
    }
    return CoatingMaterial::transparent(glass_from(material));
}

CoatingLayer make_layer(const CoatingMaterialLike& material, std::optional<double> thickness_nm,
                        std::optional<double> waves, std::optional<double> design_wavelength_nm) {
    CoatingLayer layer{coating_material_from(material), 0};
    if (thickness_nm.has_value() == waves.has_value())
        throw InputError("a layer needs exactly one of thickness_nm and thickness_waves");
    if (waves.has_value() != design_wavelength_nm.has_value())
        throw InputError("thickness_waves and design_wavelength_nm must be given together");
    if (design_wavelength_nm && !(*design_wavelength_nm >= 100 && *design_wavelength_nm <= 20000))
        throw InputError("the design wavelength must lie between 100 and 20000 nm");
    layer.thickness_nm = waves ? thickness_of_waves(layer.material, *waves, *design_wavelength_nm) : *thickness_nm;
    validate(layer);
    return layer;
}

Coating make_coating(
    const std::vector<CoatingLayer>& layers,
    const Typed<"complex | tuple[float, float] | Sequence[tuple[float, float, float]] | str | Glass | None">& metal,
    std::optional<double> reflectance, const std::string& name) {
    if (reflectance && (!layers.empty() || !metal.is_none()))
        throw InputError("reflectance cannot be combined with layers or metal");
    Coating coating = reflectance       ? stated_reflectance(*reflectance, name)
                      : metal.is_none() ? layered_coating(layers, name)
                                        : metal_mirror(coating_material_from(metal), layers, name);
    validate(coating);
    return coating;
}

/// Response of a coating: arrays of the broadcast shape of angles and wavelengths.
struct CoatingResponse {
    using Fractions = Typed<"NDArray[float64]">;
    using Amplitudes = Typed<"NDArray[complex128]">;
    Fractions reflectance_s, reflectance_p, transmittance_s, transmittance_p, absorptance_s, absorptance_p;
    Amplitudes r_s, r_p, t_s, t_p;
};

CoatingResponse response(const Coating& coating, const ArrayLike& angle_deg, const ArrayLike& wavelength_nm,
                         const MediumLike& outside, const MediumLike& inside, bool from_inside) {
    if (coating.kind == CoatingKind::unknown) throw InputError("an unknown coating has no response");
    const bool mirror = coating.is_for_mirrors();
    if (!mirror && inside.is_none())
        throw InputError("inside, the material under the coating, is required unless the coating is a mirror's");
    if (mirror && from_inside) throw InputError("from_inside must be False for a mirror");
    const Glass out = glass_from(outside), in = mirror ? out : glass_from(inside);
    const py::tuple both = py::module_::import("numpy").attr("broadcast_arrays")(angle_deg, wavelength_nm);
    const InputArray<double> angles(both[0]), wavelengths(both[1]);
    const std::vector<py::ssize_t> shape(angles.shape(), angles.shape() + angles.ndim());
    Array real[6];
    py::array_t<std::complex<double>> amplitude[4];
    for (Array& array : real) array = Array(shape);
    for (auto& array : amplitude) array = py::array_t<std::complex<double>>(shape);
    const auto count = static_cast<std::size_t>(angles.size());
    std::optional<CoatedSurface> surface;
    double wavelength = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0) heed_signals();
        const double angle = angles.data()[i], nm = wavelengths.data()[i];
        if (!(angle >= 0 && angle <= 90)) throw InputError("angle_deg must lie between 0 and 90");
        if (!(nm >= 100 && nm <= 20000)) throw InputError("the wavelength must lie between 100 and 20000 nm");
        if (!surface || nm != wavelength) {
            const double n_out = CoatingMaterial::transparent(out).index(nm).real();
            const double n_in = CoatingMaterial::transparent(in).index(nm).real();
            surface.emplace(coating, mirror, nm, from_inside ? n_in : n_out, from_inside ? n_out : n_in, !from_inside);
            wavelength = nm;
        }
        // cos(angle) as sin(90 - angle): the difference is exact, whereas the cosine of a rounded angle in radians
        // loses all digits near 90 degrees.
        const PolarisedResponse at = surface->at(std::sin((90 - angle) * std::numbers::pi / 180));
        const double numbers[] = {at.s.reflectance,   at.p.reflectance, at.s.transmittance,
                                  at.p.transmittance, at.s.absorptance, at.p.absorptance};
        const std::complex<double> amplitudes[] = {at.s.r, at.p.r, at.s.t, at.p.t};
        for (std::size_t k = 0; k < 6; ++k) real[k].mutable_data()[i] = numbers[k];
        for (std::size_t k = 0; k < 4; ++k) amplitude[k].mutable_data()[i] = amplitudes[k];
    }
    return {real[0], real[1],      real[2],      real[3],      real[4],
            real[5], amplitude[0], amplitude[1], amplitude[2], amplitude[3]};
}

std::string text_of(const CoatingLayer& layer) {
    const std::string& name = layer.material.name();
    return digits(layer.thickness_nm) + " nm" + (name.empty() ? "" : " of " + shortened(name));
}

std::string text_of(const Coating& coating) {
    std::string text = "<realcam.Coating " + std::string(kKindNames[static_cast<int>(coating.kind)]);
    if (!coating.name.empty() && coating.name != kKindNames[static_cast<int>(coating.kind)])
        text += " \"" + shortened(coating.name) + '"';
    if (coating.kind == CoatingKind::reflectance) text += ' ' + digits(coating.reflectance);
    if (coating.kind == CoatingKind::metal && !coating.metal.name().empty() && coating.metal.name() != coating.name)
        text += ' ' + shortened(coating.metal.name());
    if (coating.layers.size() == 1) return text + ", " + text_of(coating.layers.front()) + '>';
    return text + (coating.layers.empty() ? "" : ", " + counted(coating.layers.size(), "layer")) + '>';
}

void bind_response(py::module_& m) {
    py::class_<CoatingResponse> type(m, "CoatingResponse",
                                     R"(Reflection and transmission of a coated surface: arrays with the common
(broadcast) shape of the angles and wavelengths. Fractions of the power; reflectance, transmittance and
absorptance add up to 1. See Coating.response.)");
    def_result(type, [](const CoatingResponse& r) {
        const std::vector<py::ssize_t> shape = shape_of(r.reflectance_s);
        check_arrays(
            'f', shape,
            {r.reflectance_s, r.reflectance_p, r.transmittance_s, r.transmittance_p, r.absorptance_s, r.absorptance_p});
        check_arrays('c', shape, {r.r_s, r.r_p, r.t_s, r.t_p});
    });
    type.def_readonly("reflectance_s", &CoatingResponse::reflectance_s, "Reflected fraction of s-polarised power.")
        .def_readonly("reflectance_p", &CoatingResponse::reflectance_p, "Reflected fraction of p-polarised power.")
        .def_readonly("transmittance_s", &CoatingResponse::transmittance_s,
                      "Transmitted fraction of s-polarised power.")
        .def_readonly("transmittance_p", &CoatingResponse::transmittance_p,
                      "Transmitted fraction of p-polarised power.")
        .def_readonly("absorptance_s", &CoatingResponse::absorptance_s, "Absorbed fraction of s-polarised power.")
        .def_readonly("absorptance_p", &CoatingResponse::absorptance_p, "Absorbed fraction of p-polarised power.")
        .def_readonly("r_s", &CoatingResponse::r_s,
                      R"(Complex reflection coefficient of the electric field for s-polarised light, with waves
exp(i (k x - omega t)).)")
        .def_readonly("r_p", &CoatingResponse::r_p,
                      "Reflection coefficient for p-polarised light; at normal incidence r_p = -r_s.")
        .def_readonly("t_s", &CoatingResponse::t_s, "Transmission coefficient for s-polarised light.")
        .def_readonly("t_p", &CoatingResponse::t_p, "Transmission coefficient for p-polarised light.")
        .def("__repr__", [](const CoatingResponse& r) {
            return "<realcam.CoatingResponse of shape " + py::str(r.reflectance_s.attr("shape")).cast<std::string>() +
                   '>';
        });
}

void bind_layer(py::module_& m) {
    py::class_<CoatingLayer> type(m, "CoatingLayer", "One homogeneous thin film of a coating.");
    def_hashable_value(type);
    type.def(py::init(&make_layer), "material"_a, py::kw_only(), "thickness_nm"_a = py::none(),
             "thickness_waves"_a = py::none(), "design_wavelength_nm"_a = py::none(),
             R"(material: a refractive index; a complex index n + ik (k > 0 absorbs); (n_d, V_d); a list of
(wavelength_nm, n, k), interpolated linearly; "aluminium"; "silver"; the name of a glass; or a Glass.
Exactly one thickness must be specified. thickness_nm: physical thickness. thickness_waves: optical thickness in
waves of design_wavelength_nm; 0.25 is a quarter wave. Raises InputError.)")
        .def_readonly("thickness_nm", &CoatingLayer::thickness_nm, "Physical thickness.")
        .def(
            "index", [](const CoatingLayer& layer, double nm) { return layer.material.index(nm); }, "wavelength_nm"_a,
            "Returns the complex refractive index n + ik. Raises InputError if it is unknown at that wavelength.")
        .def("__repr__", [](const CoatingLayer& layer) { return "<realcam.CoatingLayer " + text_of(layer) + '>'; });
}

}  // namespace

void bind_coating(py::module_& m) {
    bind_response(m);
    bind_layer(m);
    py::class_<Coating> type(m, "Coating", "Coating of a lens surface: thin films, a metal, or a fixed reflectance.");
    def_hashable_value(type);
    type.def(py::init(&make_coating), "layers"_a = std::vector<CoatingLayer>{}, py::kw_only(), "metal"_a = py::none(),
             "reflectance"_a = py::none(), "name"_a = "",
             R"(layers: CoatingLayers from the air inwards. The first touches the medium with the lower index at the d
line, the last touches the glass or the metal. Empty: a bare surface.
metal: material of a mirror, with or without layers, as for CoatingLayer.
reflectance: for a mirror without layers and metal: fraction of the power, 0 to 1, that is reflected at every angle
and wavelength.
name: name of the coating. Raises InputError.)")
        .def_static(
            "named", [](const std::string& name) { return coating_from(py::str(name)); }, "name"_a,
            R"(Returns the coating "bare", "quarter_wave" (a quarter wave of MgF2, index 1.38, at 550 nm), "aluminium",
"silver" or "unknown". Raises InputError for other names.)")
        .def_static(
            "quarter_wave",
            [](const CoatingMaterialLike& material, double nm) {
                const CoatingLayer layer = make_layer(material, std::nullopt, 0.25, nm);
                return layered_coating({layer}, "quarter_wave");
            },
            "material"_a = kQuarterWaveIndex, "design_wavelength_nm"_a = kQuarterWaveDesign_nm,
            "Returns a coating of one layer that is a quarter of a wave thick at normal incidence.")
        .def_readonly("name", &Coating::name, "Name; may be empty.")
        .def_property_readonly(
            "kind", [](const Coating& c) { return kKindNames[static_cast<int>(c.kind)]; },
            "\"unknown\" (not specified), \"bare\", \"layers\", \"metal\" or \"reflectance\".")
        .def_readonly("layers", &Coating::layers, "List of CoatingLayers, from the air inwards.")
        .def("response", &response, "angle_deg"_a, "wavelength_nm"_a, py::kw_only(), "outside"_a = py::none(),
             "inside"_a = py::none(), "from_inside"_a = false,
             R"(Computes reflection and transmission for both polarisations by the characteristic matrix.
angle_deg: angles of incidence, 0 to 90, in the medium from which the light comes. wavelength_nm: wavelengths, 100 to
  20000. The two are broadcast together.
outside: medium in front of the first layer; None: air. inside: medium behind the last layer, required unless the
  coating is a mirror's. Both as for Surface(material=...).
from_inside: True if the light comes from the medium inside.
Returns a CoatingResponse. Raises InputError, also if a material is unknown at a wavelength.)")
        .def("__repr__", [](const Coating& coating) { return text_of(coating); });
}

}  // namespace realcam::bindings
