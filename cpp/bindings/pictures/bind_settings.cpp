// The Python class RenderSettings. All its keyword arguments and properties are described by one table, kSettings.

#include <pybind11/stl.h>

#include "../../io/files/image_metadata.hpp"
#include "../../io/text/printable.hpp"
#include "../../render/settings/effect_names.hpp"
#include "../../shot/shot_keys.hpp"
#include "../bindings.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Settings while keyword arguments are applied: the noise arguments are collected and converted to a goal at the end.
struct Draft {
    RenderSettings settings;
    bool has_noise_goal;
    NoiseRequest noise;
};

/// Returns a draft that has the noise goal of `settings` as noise arguments.
Draft draft_of(const RenderSettings& settings) {
    Draft draft{settings, settings.noise.has_value(), {}};
    if (const auto& goal = settings.noise) {
        (goal->unit == NoiseUnit::codes ? draft.noise.noise_codes : draft.noise.noise) = goal->noise;
        if (std::isfinite(goal->seconds)) draft.noise.seconds = goal->seconds;
        draft.noise.max_spp = goal->max_samples;
    }
    return draft;
}

/// Raises Python's ArgumentError.
[[noreturn]] void raise_argument_error(const std::string& why) {
    py::set_error(py::module_::import("realcam._core").attr("ArgumentError"), io::one_line(why).c_str());
    throw py::error_already_set();
}

std::string short_repr(const py::handle& value) {
    return py::module_::import("reprlib").attr("repr")(value).cast<std::string>();
}

/// Converts a name, an iterable of names, or None (no names). `expected`: beginning of the message for other values.
std::vector<std::string> names_from(const py::object& names, const std::string& expected) {
    if (names.is_none()) return {};
    if (py::isinstance<py::str>(names)) return {names.cast<std::string>()};
    const std::string why = expected + "; they are " + short_repr(names);
    std::vector<std::string> list;
    try {
        for (const py::handle name : py::iter(names)) list.push_back(name.cast<std::string>());
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_TypeError)) throw;
        raise_argument_error(why);
    } catch (const py::cast_error&) {
        raise_argument_error(why);
    }
    return list;
}

/// Converts text, a number, (wavelength_nm, value) pairs, or None to an Illuminant or a LensFilter. `from_number`: the
/// type's constructor from a number; `expected`: the accepted values, for the message of the error.
template <class Spectrum>
std::optional<Spectrum> spectrum_from(const py::object& value, Spectrum (*from_number)(double), const char* expected) {
    if (value.is_none()) return std::nullopt;
    if (py::isinstance<py::str>(value)) return Spectrum::parse(value.cast<std::string>());
    try {
        if (!py::hasattr(value, "__len__")) return from_number(value.cast<double>());
        std::vector<SpectrumPoint> points;
        for (const auto& [wavelength_nm, at] : value.cast<std::vector<std::pair<double, double>>>())
            points.push_back({wavelength_nm, at});
        return Spectrum::table(std::move(points));
    } catch (const py::cast_error&) {
        raise_argument_error(std::string(expected) + "; it is " + short_repr(value));
    }
}

std::string name_of(PupilSampling sampling) {
    for (const char* name : {"rear_element", "exit_pupil", "pixel"})
        if (shot::pupil_sampling_named(name) == sampling) return name;
    return "outline";
}

std::string name_of(LightTracing tracing) {
    switch (tracing) {
        case LightTracing::weighted: return "weighted";
        case LightTracing::off: return "off";
        case LightTracing::alone: break;
    }
    return "alone";
}

using S = const RenderSettings&;
using Value = const py::object&;

/// Keyword argument of RenderSettings in Python.
struct Setting {
    const char* name;
    const char* type;  ///< Python type annotation of the argument
    void (*set)(Draft&, Value);  ///< applies an argument; throws InputError or py::cast_error
    py::object (*get)(S);  ///< value of the property; null: there is none, because the argument sets other settings
    void (*define)(py::class_<RenderSettings>&, const char* name);  ///< defines the property; null like `get`
    const char* initial = nullptr;  ///< Python text of the default; null: the repr of `get(RenderSettings())`
};

/// Returns a setting whose property has the value get(settings); the property's signature shows the type of the result.
template <auto get>
Setting setting(const char* name, const char* type, void (*set)(Draft&, Value), const char* initial = nullptr) {
    return {name,
            type,
            set,
            [](S s) -> py::object {
                if constexpr (std::derived_from<decltype(get(s)), py::object>)
                    return get(s);
                else
                    return py::cast(get(s));
            },
            [](py::class_<RenderSettings>& settings, const char* property) {
                settings.def_property_readonly(property, get);
            },
            initial};
}

using Names = Typed<"tuple[str, ...]", py::tuple>;
using CountOrAuto = Typed<"int | Literal['auto']">;

// Functions that set and get members of RenderSettings, of its noise goal and of its thresholds.

template <auto member>
void set(Draft& d, Value value) {
    auto& target = d.settings.*member;
    target = value.cast<std::remove_reference_t<decltype(target)>>();
}

template <auto member>
auto get(S s) {
    return s.*member;
}

template <auto member>
void set_noise(Draft& d, Value value) {
    auto& target = d.noise.*member;
    target = value.cast<std::remove_reference_t<decltype(target)>>();
}

/// Returns a noise setting as the user specified it; std::nullopt if there is no noise goal or the goal does not have
/// it.
template <auto member>
auto get_noise(S s) {
    return draft_of(s).noise.*member;
}

template <auto member>
void set_threshold(Draft& d, Value value) {
    if (const auto threshold = value.cast<std::optional<double>>()) d.settings.thresholds.*member = *threshold;
}

template <auto member>
double get_threshold(S s) {
    return s.thresholds.*member;
}

/// Sets a member by name. `find(name)` returns the member's value, or std::nullopt for an unknown name. `what`: name of
/// the setting; `expected`: all names; both for the message of the InputError.
template <auto member, class Find>
void set_named(Draft& d, Value value, const char* what, const Find& find, const char* expected) {
    const auto name = value.cast<std::string>();
    const auto found = find(name);
    if (!found)
        throw InputError("unknown " + std::string(what) + " \"" + name.substr(0, 60) + "\"; expected " + expected);
    d.settings.*member = *found;
}

void set_spp(Draft& d, Value value) {
    d.has_noise_goal = py::isinstance<py::str>(value) && value.cast<std::string>() == "auto";
    d.settings.spp = RenderSettings().spp;
    if (d.has_noise_goal) return;
    d.noise = {};  // a number of samples replaces any earlier noise goal
    try {
        d.settings.spp = value.cast<int>();
    } catch (const py::cast_error&) {
        raise_argument_error("spp must be a whole number or \"auto\"; it is " + short_repr(value));
    }
}

/// All keyword arguments, in the order in which they are applied.
const Setting kSettings[] = {
    setting<[](S s) { return CountOrAuto(s.noise ? py::cast("auto") : py::cast(s.spp)); }>("spp", "int | str", set_spp),
    setting<get_noise<&NoiseRequest::noise>>("noise", "float | None", set_noise<&NoiseRequest::noise>),
    setting<get_noise<&NoiseRequest::noise_codes>>("noise_codes", "float | None",
                                                   set_noise<&NoiseRequest::noise_codes>),
    setting<get_noise<&NoiseRequest::seconds>>("seconds", "float | None", set_noise<&NoiseRequest::seconds>),
    setting<get_noise<&NoiseRequest::max_spp>>("max_spp", "int | None", set_noise<&NoiseRequest::max_spp>),
    setting<get<&RenderSettings::seed>>(
        "seed", "int", [](Draft& d, Value value) { d.settings.seed = seed_from(value.cast<std::int64_t>()); }),
    setting<[](S s) { return CountOrAuto(s.max_bounces ? py::cast(*s.max_bounces) : py::cast("auto")); }>(
        "max_bounces", "int | str",
        [](Draft& d, Value value) {
            try {
                d.settings.max_bounces = bounces_from(value);
            } catch (const py::cast_error&) {
                raise_argument_error("max_bounces must be a whole number or \"auto\"; it is " + short_repr(value));
            }
        }),
    setting<[](S s) { return io::name_of(s.transport); }>(
        "transport", "str",
        [](Draft& d, Value value) {
            set_named<&RenderSettings::transport>(d, value, "transport", shot::transport_named, shot::kTransportNames);
        }),
    setting<get<&RenderSettings::clamp>>("clamp_cd_m2", "float", set<&RenderSettings::clamp>),
    setting<get<&RenderSettings::threads>>("threads", "int", set<&RenderSettings::threads>),
    setting<[](S s) { return Names(py::tuple(py::cast(names_of(s.layers)))); }>(
        "layers", "str | Iterable[str]",
        [](Draft& d, Value value) {
            d.settings.layers = layers_named(names_from(value, "layers must be names (docs/layers.md)"));
        }),
    setting<[](S s) { return Names(py::tuple(py::cast(names_of(s.effects)))); }>(
        "effects", "str | Iterable[str]",
        [](Draft& d, Value value) {
            d.settings.effects = effects_named(names_from(value, "effects must be names (rc.effects() lists them)"));
        }),
    {"quality", "str",
     [](Draft& d, Value value) {
         set_named<&RenderSettings::thresholds>(d, value, "quality", quality_named, kQualityNames);
     },
     nullptr, nullptr, "'photo'"},
    setting<get_threshold<&PlanThresholds::pixels>>("threshold_px", "float | None",
                                                    set_threshold<&PlanThresholds::pixels>, "None"),
    setting<get_threshold<&PlanThresholds::codes>>("threshold_codes", "float | None",
                                                   set_threshold<&PlanThresholds::codes>, "None"),
    setting<[](S s) { return s.illuminant ? std::optional(s.illuminant->text()) : std::nullopt; }>(
        "illuminant", "str | float | Sequence[tuple[float, float]] | None",
        [](Draft& d, Value value) {
            d.settings.illuminant =
                spectrum_from(value, &Illuminant::line,
                              "illuminant must be a name, a wavelength in nm or (wavelength_nm, power) pairs");
        }),
    setting<[](S s) { return s.lens_filter ? std::optional(s.lens_filter->text()) : std::nullopt; }>(
        "lens_filter", "str | float | Sequence[tuple[float, float]] | None",
        [](Draft& d, Value value) {
            d.settings.lens_filter = spectrum_from(
                value, &LensFilter::neutral,
                "lens_filter must be a text such as ND8, a transmittance or (wavelength_nm, transmittance) pairs");
        }),
    setting<[](S s) { return name_of(s.pupil_sampling); }>(
        "pupil_sampling", "str",
        [](Draft& d, Value value) {
            set_named<&RenderSettings::pupil_sampling>(d, value, "pupil_sampling", shot::pupil_sampling_named,
                                                       shot::kPupilSamplingNames);
        }),
    setting<[](S s) { return name_of(s.light_tracing); }>("light_tracing", "str",
                                                          [](Draft& d, Value value) {
                                                              set_named<&RenderSettings::light_tracing>(
                                                                  d, value, "light_tracing", shot::light_tracing_named,
                                                                  shot::kLightTracingNames);
                                                          }),
};

/// Returns the constructor's signature in pybind11's format.
std::string signature() {
    std::string text = "__init__(self: RenderSettings, *";
    for (const Setting& setting : kSettings)
        text += std::string(", ") + setting.name + ": " + setting.type + " = " +
                (setting.initial ? setting.initial : py::repr(setting.get({})).cast<std::string>());
    return text + ") -> None";
}

/// Returns the settings with changes by keyword. Settings that a change makes meaningless are removed: the noise goal
/// if a number of samples is set, and the illuminant and the filter's colour if no effect uses them. Throws InputError,
/// and raises ArgumentError for an unknown keyword or a value of the wrong type.
RenderSettings changed(const RenderSettings& before, const py::dict& keywords) {
    Draft draft = draft_of(before);
    RenderSettings& settings = draft.settings;
    std::size_t applied = 0;
    try {
        if (keywords.contains("noise") || keywords.contains("noise_codes"))
            draft.noise.noise = draft.noise.noise_codes = std::nullopt;
        for (const Setting& setting : kSettings) {
            if (!keywords.contains(setting.name)) continue;
            setting.set(draft, keywords[setting.name]);
            ++applied;
        }
    } catch (const py::cast_error&) {
        applied = 0;
    }
    if (applied != keywords.size())
        raise_argument_error(py::module_::import("realcam.arguments")
                                 .attr("complaint")(signature(), py::make_tuple(py::none()), keywords)
                                 .cast<std::string>());
    if (!draft.has_noise_goal && !draft.noise.says_nothing())
        throw InputError("noise, noise_codes, seconds and max_spp belong to spp=\"auto\"");
    settings.noise = draft.has_noise_goal ? std::optional(goal_of(draft.noise)) : std::nullopt;
    if (keywords.contains("effects") && !settings.effects.is_automatic && !settings.effects.have_wavelengths()) {
        if (!keywords.contains("illuminant")) settings.illuminant.reset();
        if (!keywords.contains("lens_filter") && settings.lens_filter)
            settings.lens_filter = settings.lens_filter->neutral_equivalent();
    }
    validate(settings);
    return settings;
}

/// Returns the keyword arguments that reproduce the settings: those that differ from RenderSettings().
py::dict keywords_of(const RenderSettings& settings) {
    py::dict keywords;
    for (const Setting& setting : kSettings)
        if (const py::object value = setting.get ? setting.get(settings) : py::none();
            setting.get && !value.equal(setting.get({})))
            keywords[setting.name] = value;
    return keywords;
}

std::string repr_of(const RenderSettings& settings) {
    std::string text;
    for (const auto& [name, value] : keywords_of(settings))
        text += (text.empty() ? "" : ", ") + name.cast<std::string>() + '=' + py::repr(value).cast<std::string>();
    return "realcam.RenderSettings(" + text + ')';
}

constexpr const char* kDoc =
    R"(Settings of a picture, for rc.render, rc.Session, rc.LiveView, rc.plan and rc.Shot. Immutable.

spp: samples per pixel, or "auto": adaptive sampling up to a noise goal, by tiles of 16 x 16 pixels (docs/sampling.md).
noise, noise_codes: noise goal with spp="auto": RMS error of the pixels of a tile, as a fraction of the tile's mean (or
  of a hundredth of white if that is larger), or in codes (steps) of the developed 8-bit picture. Default: 1 code.
seconds, max_spp: limits with spp="auto": time for sampling, and samples of a pixel (default 4096). A warning is
  issued if the goal is not reached.
seed: of the random numbers, 0 to 2^32 - 1.
max_bounces: maximum number of bounces of a path, 0 (direct light only) to 64; "auto": as many as the shot requires,
  by threshold_codes (docs/plan.md).
transport: "paths": all light paths; "whitted": direct light, and specular reflection and refraction.
clamp_cd_m2: upper limit of the radiance of indirect light, which reduces bright dots and darkens the picture; 0: none.
threads: number of CPU threads; 0: all.
layers: names of additional layers of Image.layers (docs/layers.md), or "all", which does not include dual_pixel.
effects: names of optional effects (rc.effects() lists them), or () for none; or "auto": the planner selects the
  effects that the shot requires, and the cheapest camera model that shows them (docs/plan.md). Warns of effects that
  the lens cannot show.
quality: thresholds of the planner: "draft" (2 pixels, 4 codes), "photo" (0.5, 1) or "reference" (0.1, 0.25).
threshold_px, threshold_codes: thresholds of the planner instead of those of quality: an effect is simulated if the
  picture without it would differ by more pixels or codes.
illuminant: spectrum of all light, for dispersion and diffraction: "D65", "D50", "A", "FL2", a wavelength in nm, or
  (wavelength_nm, power) pairs; None: D65. The attribute is a text.
lens_filter: absorbing filter in front of the lens (docs/filters.md): "ND8" or 1/8 passes an eighth of the light, "ND0.9"
  has the optical density 0.9, and (wavelength_nm, transmittance) pairs are a coloured filter, which needs dispersion
  or diffraction. None: no filter. The attribute is a text.
pupil_sampling: part of the pupil to which the full lens's rays are sent: "outline": the region through which real
  rays pass. The others are for comparison (docs/accuracy.md): "rear_element", "exit_pupil", and "pixel", the region in
  which the pixel's earlier samples passed.
light_tracing: method for the full lens's images of lights that are small or out of focus: "weighted": samples of
  pixels and samples from the lights, combined by multiple importance sampling. The others are for comparison: "alone":
  samples from the lights; "off": samples of pixels, which never hit point lights and suns.

Raises InputError.)";

}  // namespace

void bind_settings(py::module_& m) {
    py::class_<RenderSettings> type(m, "RenderSettings", kDoc);
    {
        py::options options;
        options.disable_function_signatures();  // these functions accept any keywords and look them up in kSettings
        type.def(py::init([](const py::kwargs& keywords) { return changed({}, keywords); }), signature().c_str())
            .def(
                "with_", [](const RenderSettings& self, const py::kwargs& changes) { return changed(self, changes); },
                "with_(self: RenderSettings, **changes: Unpack[_SettingsKwargs]) -> RenderSettings\n\n"
                "Returns a copy with changes, by the keywords of the constructor. Settings that a change makes "
                "meaningless are removed:\nthe noise goal if spp is a number, and the illuminant if no effect uses it. "
                "Raises InputError.");
    }
    for (const Setting& setting : kSettings)
        if (setting.define) setting.define(type, setting.name);
    type.def(
            "__eq__",
            [](const RenderSettings& self, const py::object& other) -> py::object {
                if (!py::isinstance<RenderSettings>(other))
                    return py::reinterpret_borrow<py::object>(Py_NotImplemented);
                return py::bool_(self == other.cast<const RenderSettings&>());
            },
            "other"_a)
        .def("__hash__", [](const RenderSettings& self) { return py::hash(py::str(repr_of(self))); })
        .def("__repr__", &repr_of);
    def_copy(type);
    def_pickle(
        type,
        [](const py::object& self) {
            return py::tuple(keywords_of(self.cast<const RenderSettings&>()).attr("items")());
        },
        [](const py::object& items) { return changed({}, py::dict(items)); });
}

}  // namespace realcam::bindings
