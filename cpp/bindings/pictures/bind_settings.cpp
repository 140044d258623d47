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

Draft draft_of(const RenderSettings& settings) {
    Draft draft{settings, settings.noise.has_value(), {}};
    if (const auto& goal = settings.noise) {
        (goal->unit == NoiseUnit::codes ? draft.noise.noise_codes : draft.noise.noise) = goal->noise;
        if (std::isfinite(goal->seconds)) draft.noise.seconds = goal->seconds;
        draft.noise.max_spp = goal->most_samples;
    }
    return draft;
}

[[noreturn]] void refuse(const std::string& why) {
    py::set_error(py::module_::import("realcam._core").attr("ArgumentError"), io::one_line(why).c_str());
    throw py::error_already_set();
}

std::string short_repr(const py::handle& value) {
    return py::module_::import("reprlib").attr("repr")(value).cast<std::string>();
}

/// Converts a name, an iterable of names, or None (no names).
std::vector<std::string> names_from(const py::object& names, const std::string& what) {
    if (names.is_none()) return {};
    if (py::isinstance<py::str>(names)) return {names.cast<std::string>()};
    const std::string why = what + "; they are " + short_repr(names);
    std::vector<std::string> list;
    try {
        for (const py::handle name : py::iter(names)) list.push_back(name.cast<std::string>());
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_TypeError)) throw;
        refuse(why);
    } catch (const py::cast_error&) {
        refuse(why);
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
        refuse(std::string(expected) + "; it is " + short_repr(value));
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
using Word = const py::object&;

/// Keyword argument of RenderSettings in Python.
struct Setting {
    const char* name;
    const char* type;  ///< Python type annotation
    void (*set)(Draft&, Word);
    py::object (*get)(S);  ///< null: there is no property, because the argument sets other settings
    void (*define)(py::class_<RenderSettings>&, const char* name);  ///< defines the property
    const char* initial = nullptr;  ///< Python text of the default; null: the repr of `get(RenderSettings())`
};

/// Returns a setting whose property is `get`; its signature shows the type of the result.
template <auto get>
Setting setting(const char* name, const char* type, void (*set)(Draft&, Word), const char* initial = nullptr) {
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

template <auto member>
void set(Draft& d, Word word) {
    auto& value = d.settings.*member;
    value = word.cast<std::remove_reference_t<decltype(value)>>();
}

template <auto member>
auto get(S s) {
    return s.*member;
}

template <auto member>
void set_noise(Draft& d, Word word) {
    auto& value = d.noise.*member;
    value = word.cast<std::remove_reference_t<decltype(value)>>();
}

/// Returns a noise setting as the user gave it. None if there is no noise goal or the goal does not specify it.
template <auto member>
auto get_noise(S s) {
    return draft_of(s).noise.*member;
}

template <auto member>
void set_threshold(Draft& d, Word word) {
    if (const auto value = word.cast<std::optional<double>>()) d.settings.thresholds.*member = *value;
}

template <auto member>
double get_threshold(S s) {
    return s.thresholds.*member;
}

/// Sets a member by name. `find` returns the value of a name, or std::nullopt for an unknown one.
template <auto member, class Find>
void set_named(Draft& d, Word word, const char* what, const Find& find, const char* wanted) {
    const auto name = word.cast<std::string>();
    const auto found = find(name);
    if (!found)
        throw InputError("unknown " + std::string(what) + " \"" + name.substr(0, 60) + "\"; expected " + wanted);
    d.settings.*member = *found;
}

void set_spp(Draft& d, Word word) {
    d.has_noise_goal = py::isinstance<py::str>(word) && word.cast<std::string>() == "auto";
    d.settings.spp = RenderSettings().spp;
    if (d.has_noise_goal) return;
    d.noise = {};  // a number of samples replaces any earlier noise goal
    try {
        d.settings.spp = word.cast<int>();
    } catch (const py::cast_error&) {
        refuse("spp must be a whole number or \"auto\"; it is " + short_repr(word));
    }
}

// Applied in this order.
const Setting kSettings[] = {
    setting<[](S s) { return CountOrAuto(s.noise ? py::cast("auto") : py::cast(s.spp)); }>("spp", "int | str", set_spp),
    setting<get_noise<&NoiseRequest::noise>>("noise", "float | None", set_noise<&NoiseRequest::noise>),
    setting<get_noise<&NoiseRequest::noise_codes>>("noise_codes", "float | None",
                                                   set_noise<&NoiseRequest::noise_codes>),
    setting<get_noise<&NoiseRequest::seconds>>("seconds", "float | None", set_noise<&NoiseRequest::seconds>),
    setting<get_noise<&NoiseRequest::max_spp>>("max_spp", "int | None", set_noise<&NoiseRequest::max_spp>),
    setting<get<&RenderSettings::seed>>(
        "seed", "int", [](Draft& d, Word word) { d.settings.seed = seed_from(word.cast<std::int64_t>()); }),
    setting<[](S s) { return CountOrAuto(s.max_bounces ? py::cast(*s.max_bounces) : py::cast("auto")); }>(
        "max_bounces", "int | str",
        [](Draft& d, Word word) {
            try {
                d.settings.max_bounces = bounces_from(word);
            } catch (const py::cast_error&) {
                refuse("max_bounces must be a whole number or \"auto\"; it is " + short_repr(word));
            }
        }),
    setting<[](S s) { return io::name_of(s.transport); }>(
        "transport", "str",
        [](Draft& d, Word word) {
            set_named<&RenderSettings::transport>(d, word, "transport", shot::transport_named, shot::kTransportNames);
        }),
    setting<get<&RenderSettings::clamp>>("clamp_cd_m2", "float", set<&RenderSettings::clamp>),
    setting<get<&RenderSettings::threads>>("threads", "int", set<&RenderSettings::threads>),
    setting<[](S s) { return Names(py::tuple(py::cast(names_of(s.layers)))); }>(
        "layers", "str | Iterable[str]",
        [](Draft& d, Word word) {
            d.settings.layers = layers_named(names_from(word, "layers must be names (docs/layers.md)"));
        }),
    setting<[](S s) { return Names(py::tuple(py::cast(names_of(s.effects)))); }>(
        "effects", "str | Iterable[str]",
        [](Draft& d, Word word) {
            d.settings.effects = effects_named(names_from(word, "effects must be names (rc.effects() lists them)"));
        }),
    {"quality", "str",
     [](Draft& d, Word word) {
         set_named<&RenderSettings::thresholds>(d, word, "quality", quality_named, kQualityNames);
     },
     nullptr, nullptr, "'photo'"},
    setting<get_threshold<&PlanThresholds::pixels>>("threshold_px", "float | None",
                                                    set_threshold<&PlanThresholds::pixels>, "None"),
    setting<get_threshold<&PlanThresholds::codes>>("threshold_codes", "float | None",
                                                   set_threshold<&PlanThresholds::codes>, "None"),
    setting<[](S s) { return s.illuminant ? std::optional(s.illuminant->text()) : std::nullopt; }>(
        "illuminant", "str | float | Sequence[tuple[float, float]] | None",
        [](Draft& d, Word word) {
            d.settings.illuminant =
                spectrum_from(word, &Illuminant::line,
                              "illuminant must be a name, a wavelength in nm or (wavelength_nm, power) pairs");
        }),
    setting<[](S s) { return s.lens_filter ? std::optional(s.lens_filter->text()) : std::nullopt; }>(
        "lens_filter", "str | float | Sequence[tuple[float, float]] | None",
        [](Draft& d, Word word) {
            d.settings.lens_filter = spectrum_from(
                word, &LensFilter::neutral,
                "lens_filter must be a text such as ND8, a transmittance or (wavelength_nm, transmittance) pairs");
        }),
    setting<[](S s) { return name_of(s.pupil_sampling); }>(
        "pupil_sampling", "str",
        [](Draft& d, Word word) {
            set_named<&RenderSettings::pupil_sampling>(d, word, "pupil_sampling", shot::pupil_sampling_named,
                                                       shot::kPupilSamplingNames);
        }),
    setting<[](S s) { return name_of(s.light_tracing); }>("light_tracing", "str",
                                                          [](Draft& d, Word word) {
                                                              set_named<&RenderSettings::light_tracing>(
                                                                  d, word, "light_tracing", shot::light_tracing_named,
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

/// Returns the settings with changes given by name. Settings that a change makes meaningless are removed: the noise
/// goal if a number of samples is set, and the illuminant and the filter's colour if no effect uses them. Throws
/// InputError.
RenderSettings changed(const RenderSettings& before, const py::dict& words) {
    Draft draft = draft_of(before);
    RenderSettings& settings = draft.settings;
    std::size_t known = 0;
    try {
        if (words.contains("noise") || words.contains("noise_codes"))
            draft.noise.noise = draft.noise.noise_codes = std::nullopt;
        for (const Setting& setting : kSettings) {
            if (!words.contains(setting.name)) continue;
            setting.set(draft, words[setting.name]);
            ++known;
        }
    } catch (const py::cast_error&) {
        known = 0;
    }
    if (known != words.size())
        refuse(py::module_::import("realcam.arguments")
                   .attr("complaint")(signature(), py::make_tuple(py::none()), words)
                   .cast<std::string>());
    if (!draft.has_noise_goal && !draft.noise.says_nothing())
        throw InputError("noise, noise_codes, seconds and max_spp belong to spp=\"auto\"");
    settings.noise = draft.has_noise_goal ? std::optional(goal_of(draft.noise)) : std::nullopt;
    if (words.contains("effects") && !settings.effects.is_automatic && !settings.effects.have_wavelengths()) {
        if (!words.contains("illuminant")) settings.illuminant.reset();
        if (!words.contains("lens_filter") && settings.lens_filter)
            settings.lens_filter = settings.lens_filter->neutral_equivalent();
    }
    validate(settings);
    return settings;
}

/// Returns the keyword arguments that reproduce the settings: those that differ from RenderSettings().
py::dict words_of(const RenderSettings& settings) {
    py::dict words;
    for (const Setting& setting : kSettings)
        if (const py::object value = setting.get ? setting.get(settings) : py::none();
            setting.get && !value.equal(setting.get({})))
            words[setting.name] = value;
    return words;
}

std::string repr_of(const RenderSettings& settings) {
    std::string text;
    for (const auto& [name, value] : words_of(settings))
        text += (text.empty() ? "" : ", ") + name.cast<std::string>() + '=' + py::repr(value).cast<std::string>();
    return "realcam.RenderSettings(" + text + ')';
}

constexpr const char* kDoc =
    R"(How a picture is taken; a value, as rc.render, rc.Session, rc.LiveView, rc.plan and rc.Shot take it.

spp: samples per pixel, or "auto": as many as the noise needs, more where it is noisier, by tiles of 16 pixels
(docs/sampling.md). noise: the noise goal then, as a share of a tile's light (of a hundredth of white where that
is more), or noise_codes: in 8-bit codes of the developed picture; 1 code unless said. seconds, max_spp (4096):
no more samples are taken after so long, and of a pixel no more than so many; warns where the noise is still
larger then.
max_bounces: 0 for direct light only, 1 for one reflection more, up to 64; "auto": as many as the shot calls for,
by threshold_codes (docs/plan.md).
transport: "paths" for all light paths, "whitted" for direct light and what mirrors and smooth glass show.
clamp_cd_m2: radiance above which what comes by a bounce is cut off, for fewer bright dots and a picture that is
too dark; 0: never. threads: 0 for all.
layers: names of what else Image.layers is to hold, or "all" (docs/layers.md), which leaves dual_pixel out.
effects: "auto": what the shot calls for, and the cheapest camera model that shows it, by thresholds: those of
quality, "draft" (2 pixels, 4 codes), "photo" (0.5, 1) or "reference" (0.1, 0.25), or threshold_px and
threshold_codes; or names of optional effects (rc.effects() lists them; docs/dispersion.md), () for none.
Warns of what the lens cannot give of them.
illuminant: of dispersion and diffraction, the spectrum of all light: "D65", "D50", "A", "FL2", a wavelength in nm,
or (wavelength_nm, power) pairs; None: D65. As an attribute it is a text.
lens_filter: absorbing filter in front of the lens (docs/filters.md): "ND8" or 1/8 passes an eighth of the light, "ND0.9"
has the optical density 0.9, and (wavelength_nm, transmittance) pairs are a coloured filter, which needs dispersion
or diffraction. None: no filter. As an attribute it is a text.
pupil_sampling: where a full lens's rays are sent: "outline", where real rays were found to pass; to compare
with it (docs/accuracy.md), "rear_element", "exit_pupil", or "pixel", where the pixel's earlier samples have
passed.
light_tracing: how a full lens's images of lights are found that are small or out of focus: "weighted", by samples
of pixels and by samples from the lights; to compare with it, "alone", from the lights, or "off", by samples of
pixels, which never meet point lights and suns.

Raises InputError.)";

}  // namespace

void bind_settings(py::module_& m) {
    py::class_<RenderSettings> type(m, "RenderSettings", kDoc);
    {
        py::options options;
        options.disable_function_signatures();  // these functions accept any keywords and look them up in kSettings
        type.def(py::init([](const py::kwargs& words) { return changed({}, words); }), signature().c_str())
            .def(
                "with_", [](const RenderSettings& self, const py::kwargs& changes) { return changed(self, changes); },
                "with_(self: RenderSettings, **changes: Unpack[_SettingWords]) -> RenderSettings\n\n"
                "The same with changes, named as those of the constructor. What a change leaves without a meaning goes "
                "too: what\nis wanted of the noise with a number of samples, an illuminant with the last effect that "
                "uses it. Raises InputError.");
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
        [](const py::object& self) { return py::tuple(words_of(self.cast<const RenderSettings&>()).attr("items")()); },
        [](const py::object& words) { return changed({}, py::dict(words)); });
}

}  // namespace realcam::bindings
