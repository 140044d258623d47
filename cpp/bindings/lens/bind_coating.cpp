#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <map>

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

constexpr const char* kKindNames[] = {"unknown", "bare", "layers", "metal", "reflectance"};

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
            "a coating's material must be an index, a complex n + ik, (n_d, V_d), [(nm, n, k), ...], a "
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
        throw InputError("thickness_waves and design_wavelength_nm are wanted together");
    if (design_wavelength_nm && !(*design_wavelength_nm >= 100 && *design_wavelength_nm <= 20000))
        throw InputError("the design wavelength must lie between 100 and 20000 nm");
    layer.thickness_nm = waves ? thickness_of_waves(layer.material, *waves, *design_wavelength_nm) : *thickness_nm;
    check_coating(layered_coating({layer}));
    return layer;
}

Coating make_coating(
    const std::vector<CoatingLayer>& layers,
    const Typed<"complex | tuple[float, float] | Sequence[tuple[float, float, float]] | str | Glass | None">& metal,
    std::optional<double> reflectance, const std::string& name) {
    if (reflectance && (!layers.empty() || !metal.is_none()))
        throw InputError("a stated reflectance leaves nothing to calculate: no layers and no metal go with it");
    Coating coating = reflectance       ? stated_reflectance(*reflectance, name)
                      : metal.is_none() ? layered_coating(layers, name)
                                        : metal_mirror(coating_material_from(metal), layers, name);
    check_coating(coating);
    return coating;
}

/// Response of a coating: arrays of the broadcast shape of angles and wavelengths.
struct CoatingResponse {
    using Shares = Typed<"NDArray[float64]">;
    using Amplitudes = Typed<"NDArray[complex128]">;
    Shares reflectance_s, reflectance_p, transmittance_s, transmittance_p, absorptance_s, absorptance_p;
    Amplitudes r_s, r_p, t_s, t_p;
};

CoatingResponse response(const Coating& coating, const ArrayLike& angle_deg, const ArrayLike& wavelength_nm,
                         const MediumLike& outside, const MediumLike& inside, bool from_inside) {
    if (coating.kind == CoatingKind::unknown) throw InputError("of an unknown coating nothing can be said");
    const bool mirror = coating.is_for_mirrors();
    if (!mirror && inside.is_none())
        throw InputError("inside, the material under the coating, is wanted; only a mirror has its own");
    if (mirror && from_inside) throw InputError("no light comes from inside a mirror");
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
        if (!(angle >= 0 && angle <= 90)) throw InputError("angles of incidence lie between 0 and 90 degrees");
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

}  // namespace

template <>
struct RestoredCheck<CoatingResponse> {
    static void check(const CoatingResponse& r) {
        require_restored(py::isinstance<py::array>(r.reflectance_s));
        const auto first = py::reinterpret_borrow<py::array>(r.reflectance_s);
        const std::vector<py::ssize_t> shape(first.shape(), first.shape() + first.ndim());
        for (const py::object* shares : {&r.reflectance_s, &r.reflectance_p, &r.transmittance_s, &r.transmittance_p,
                                         &r.absorptance_s, &r.absorptance_p})
            check_restored_array(*shares, {'f', shape});
        for (const py::object* amplitudes : {&r.r_s, &r.r_p, &r.t_s, &r.t_p})
            check_restored_array(*amplitudes, {'c', shape});
    }
};

namespace {

void bind_response(py::module_& m) {
    py::class_<CoatingResponse> type(m, "CoatingResponse",
                                     R"(What a coated surface does to light, as arrays of the shape of angles and
wavelengths together. Shares of power; reflectance, transmittance and absorptance sum to 1.)");
    def_result(type);
    type.def_readonly("reflectance_s", &CoatingResponse::reflectance_s)
        .def_readonly("reflectance_p", &CoatingResponse::reflectance_p)
        .def_readonly("transmittance_s", &CoatingResponse::transmittance_s)
        .def_readonly("transmittance_p", &CoatingResponse::transmittance_p)
        .def_readonly("absorptance_s", &CoatingResponse::absorptance_s)
        .def_readonly("absorptance_p", &CoatingResponse::absorptance_p)
        .def_readonly("r_s", &CoatingResponse::r_s,
                      "Complex amplitude of the electric field, light going as exp(i (k x - omega t)).")
        .def_readonly("r_p", &CoatingResponse::r_p, "As r_s; at normal incidence r_p = -r_s.")
        .def_readonly("t_s", &CoatingResponse::t_s)
        .def_readonly("t_p", &CoatingResponse::t_p)
        .def("__repr__", [](const CoatingResponse& r) {
            return "<realcam.CoatingResponse of shape " + py::str(r.reflectance_s.attr("shape")).cast<std::string>() +
                   '>';
        });
}

void bind_layer(py::module_& m) {
    py::class_<CoatingLayer> type(m, "CoatingLayer", "One homogeneous film.");
    def_hashable_value(type);
    type.def(py::init(&make_layer), "material"_a, py::kw_only(), "thickness_nm"_a = py::none(),
             "thickness_waves"_a = py::none(), "design_wavelength_nm"_a = py::none(),
             "material: index, complex n + ik (k > 0 absorbs), (n_d, V_d), [(wavelength_nm, n, k), ...] with straight "
             "lines\n"
             "between, \"aluminium\", \"silver\", glass name or Glass.\n"
             "thickness_nm: physical. thickness_waves: optical, in waves of design_wavelength_nm; 0.25 is a quarter "
             "wave.")
        .def_readonly("thickness_nm", &CoatingLayer::thickness_nm)
        .def(
            "index", [](const CoatingLayer& layer, double nm) { return layer.material.index(nm); }, "wavelength_nm"_a,
            "Refractive index n + ik. Raises InputError at a wavelength at which it is not known.")
        .def("__repr__", [](const CoatingLayer& layer) { return "<realcam.CoatingLayer " + text_of(layer) + '>'; });
}

}  // namespace

void bind_coating(py::module_& m) {
    bind_response(m);
    bind_layer(m);
    py::class_<Coating> type(m, "Coating", "What covers a surface of a lens. A value.");
    def_hashable_value(type);
    type.def(py::init(&make_coating), "layers"_a = std::vector<CoatingLayer>{}, py::kw_only(), "metal"_a = py::none(),
             "reflectance"_a = py::none(), "name"_a = "",
             "layers: CoatingLayers from the air inwards: the first touches the medium of the lower index at the d "
             "line, the\n"
             "last the glass or the metal. Empty: a bare surface.\n"
             "metal: of a mirror, with or without layers; materials as CoatingLayer takes them.\n"
             "reflectance: of a mirror, the share of the power that it reflects at every angle and wavelength.")
        .def_static(
            "named", [](const std::string& name) { return coating_from(py::str(name)); }, "name"_a,
            "\"bare\", \"quarter_wave\" (MgF2, 1.38, for 550 nm), \"aluminium\", \"silver\", or \"unknown\".")
        .def_static(
            "quarter_wave",
            [](const CoatingMaterialLike& material, double nm) {
                const CoatingLayer layer = make_layer(material, std::nullopt, 0.25, nm);
                return layered_coating({layer}, "quarter_wave");
            },
            "material"_a = kQuarterWaveIndex, "design_wavelength_nm"_a = kQuarterWaveDesign_nm,
            "One layer that is a quarter of a wave thick at normal incidence.")
        .def_readonly("name", &Coating::name)
        .def_property_readonly(
            "kind", [](const Coating& c) { return kKindNames[static_cast<int>(c.kind)]; },
            "unknown (not said), bare, layers, metal or reflectance.")
        .def_readonly("layers", &Coating::layers)
        .def("response", &response, "angle_deg"_a, "wavelength_nm"_a, py::kw_only(), "outside"_a = py::none(),
             "inside"_a = py::none(), "from_inside"_a = false,
             R"(Reflection and transmission by the characteristic matrix, for both polarisations.
angle_deg: of incidence, 0 to 90, in the medium that the light comes from. Arrays are broadcast.
outside, inside: materials on either side; None is air outside. from_inside: the light comes from there.
Returns a CoatingResponse. Raises InputError, also at a wavelength at which a material is not known.)")
        .def("__repr__", [](const Coating& coating) { return text_of(coating); });
}

}  // namespace realcam::bindings
