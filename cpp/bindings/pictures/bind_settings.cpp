// The Python class RenderSettings. Its keyword arguments, its attributes and its docstring come from the table of shot
// keys (ShotKey::set).

#include <pybind11/stl.h>

#include <ranges>

#include "../../io/text/printable.hpp"
#include "../../shot/shot_keys.hpp"
#include "../bindings.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using shot::PictureRequest;
using shot::SettingValue;
using shot::ShotKey;
using shot::Syntax;

/// Returns the settings of a picture.
auto settings_in_table() {
    return std::views::filter(shot::shot_keys(), [](const ShotKey& key) { return key.set != nullptr; });
}

/// Raises Python's ArgumentError.
[[noreturn]] void raise_argument_error(const std::string& why) {
    py::set_error(py::module_::import("realcam._core").attr("ArgumentError"), io::one_line(why).c_str());
    throw py::error_already_set();
}

std::string short_repr(const py::handle& value) {
    return py::module_::import("reprlib").attr("repr")(value).cast<std::string>();
}

/// Converts a name, an iterable of names, or None (no names).
std::vector<std::string> names_from(const ShotKey& key, const py::object& names) {
    if (names.is_none()) return {};
    if (py::isinstance<py::str>(names)) return {names.cast<std::string>()};
    const std::string why = std::string(key.name) + " must be " + key.wanted + "; they are " + short_repr(names);
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

/// Converts text, a number, (wavelength_nm, value) pairs, or None.
SettingValue spectrum_from(const py::object& value) {
    if (value.is_none()) return {};
    if (py::isinstance<py::str>(value)) return value.cast<std::string>();
    if (!py::hasattr(value, "__len__")) return value.cast<double>();
    std::vector<SpectrumPoint> points;
    for (const auto& [wavelength_nm, at] : value.cast<std::vector<std::pair<double, double>>>())
        points.push_back({wavelength_nm, at});
    return points;
}

/// Value of a setting in RenderSettings().
SettingValue initial_value(const ShotKey& key) {
    return key.get ? key.get({}) : SettingValue();
}

/// True if the setting may be None: it has no value by default, or only replaces a part of another setting.
bool may_be_none(const ShotKey& key) {
    return key.syntax != Syntax::whole_or_auto && key.get &&
           (!*key.initial || std::holds_alternative<std::monostate>(initial_value(key)));
}

/// Converts an argument. Throws py::cast_error, or raises ArgumentError, for a value of the wrong type.
SettingValue value_from(const ShotKey& key, const py::object& value) {
    const auto explained = [&](const std::string& wanted, auto convert) -> SettingValue {
        try {
            return convert();
        } catch (const py::cast_error&) {
            raise_argument_error(std::string(key.name) + " must be " + wanted + "; it is " + short_repr(value));
        }
    };
    switch (key.syntax) {
        case Syntax::names: return names_from(key, value);
        case Syntax::spectrum: return explained(key.wanted, [&] { return spectrum_from(value); });
        case Syntax::whole_or_auto:
            if (py::isinstance<py::str>(value) && value.cast<std::string>() == "auto") return {};
            return explained("a whole number or \"auto\"", [&] { return value.cast<std::int64_t>(); });
        default: break;
    }
    if (value.is_none() && may_be_none(key)) return {};
    switch (key.syntax) {
        case Syntax::number: return value.cast<double>();
        case Syntax::whole: return value.cast<std::int64_t>();
        default: return value.cast<std::string>();
    }
}

/// Converts the value of an attribute.
py::object object_of(const ShotKey& key, const SettingValue& value) {
    if (std::holds_alternative<std::monostate>(value))
        return key.syntax == Syntax::whole_or_auto ? py::object(py::str("auto")) : py::none();
    if (const auto* const names = std::get_if<std::vector<std::string>>(&value)) return py::tuple(py::cast(*names));
    if (const auto* const whole = std::get_if<std::int64_t>(&value)) return py::int_(*whole);
    if (const auto* const number = std::get_if<double>(&value)) return py::float_(*number);
    return py::str(std::get<std::string>(value));
}

/// Type annotation of the argument.
std::string argument_type(const ShotKey& key) {
    const std::string or_none = may_be_none(key) ? " | None" : "";
    switch (key.syntax) {
        case Syntax::number: return "float" + or_none;
        case Syntax::whole: return "int" + or_none;
        case Syntax::whole_or_auto: return "int | str";
        case Syntax::names: return "str | Iterable[str]";
        case Syntax::spectrum: return "str | float | Sequence[tuple[float, float]] | None";
        default: return "str" + or_none;
    }
}

/// Type annotation of the attribute.
std::string attribute_type(const ShotKey& key) {
    const std::string or_none = std::holds_alternative<std::monostate>(initial_value(key)) ? " | None" : "";
    switch (key.syntax) {
        case Syntax::number: return "float" + or_none;
        case Syntax::whole: return "int" + or_none;
        case Syntax::whole_or_auto: return "int | Literal['auto']";
        case Syntax::names: return "tuple[str, ...]";
        default: return "str" + or_none;
    }
}

/// Python text of the argument's default.
std::string initial_text(const ShotKey& key) {
    if (!*key.initial) return "None";
    return py::repr(key.get ? object_of(key, initial_value(key)) : py::str(key.initial)).cast<std::string>();
}

/// Returns the constructor's signature in pybind11's format.
std::string signature() {
    std::string text = "__init__(self: RenderSettings, *";
    for (const ShotKey& key : settings_in_table())
        text += std::string(", ") + key.name + ": " + argument_type(key) + " = " + initial_text(key);
    return text + ") -> None";
}

/// Returns the settings with changes by keyword. Settings that a change makes meaningless are removed: the noise goal
/// if a number of samples is set, and the illuminant and the filter's colour if no effect uses them. Throws InputError,
/// and raises ArgumentError for an unknown keyword or a value of the wrong type.
RenderSettings changed(const RenderSettings& before, const py::dict& keywords) {
    PictureRequest request = shot::request_of(before);
    RenderSettings& settings = request.settings;
    std::size_t applied = 0;
    try {
        if (keywords.contains("noise") || keywords.contains("noise_codes"))
            request.noise.noise = request.noise.noise_codes = std::nullopt;
        for (const ShotKey& key : settings_in_table()) {
            if (!keywords.contains(key.name)) continue;
            key.set(key, key.name, request, value_from(key, keywords[key.name]));
            ++applied;
        }
    } catch (const py::cast_error&) {
        applied = 0;
    }
    if (applied != keywords.size())
        raise_argument_error(py::module_::import("realcam.arguments")
                                 .attr("complaint")(signature(), py::make_tuple(py::none()), keywords)
                                 .cast<std::string>());
    resolve_noise_goal(request);
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
    const PictureRequest request = shot::request_of(settings);
    for (const ShotKey& key : settings_in_table())
        if (const SettingValue value = key.get ? key.get(request) : SettingValue(); value != initial_value(key))
            keywords[key.name] = object_of(key, value);
    return keywords;
}

std::string repr_of(const RenderSettings& settings) {
    std::string text;
    for (const auto& [name, value] : keywords_of(settings))
        text += (text.empty() ? "" : ", ") + name.cast<std::string>() + '=' + py::repr(value).cast<std::string>();
    return "realcam.RenderSettings(" + text + ')';
}

/// Description of an argument, with a capital first letter as in the table and a full stop. A number that replaces
/// "auto", the default of a shot, is named as the default.
std::string description(const ShotKey& key) {
    ShotKey own = key;
    const std::string number = key.syntax == Syntax::whole_or_auto ? initial_text(key) : "";
    if (!number.empty() && number != "'auto'") own.initial = number.c_str();
    return own.help() + '.' + (*key.details ? ' ' + std::string(key.details) : "");
}

/// Returns the docstring of the class.
std::string class_text() {
    std::string text =
        "Settings of a picture, for rc.render, rc.Session, rc.LiveView, rc.plan and rc.Shot. Immutable.\n\n";
    const py::object fill = py::module_::import("textwrap").attr("fill");
    for (const ShotKey& key : settings_in_table())
        text += fill(std::string(key.name) + ": " + description(key), "width"_a = 120, "subsequent_indent"_a = "  ")
                    .cast<std::string>() +
                '\n';
    return text +
           "\nSpectra are texts as attributes, and may be (wavelength_nm, value) pairs as arguments. In a shot, the "
           "default of spp\nis auto, and seconds has one (docs/shot-files.md). Raises InputError.";
}

}  // namespace

void bind_settings(py::module_& m) {
    py::class_<RenderSettings> type(m, "RenderSettings", class_text().c_str());
    {
        py::options options;
        options.disable_function_signatures();  // these functions accept any keywords and look them up in the table
        type.def(py::init([](const py::kwargs& keywords) { return changed({}, keywords); }), signature().c_str())
            .def(
                "with_", [](const RenderSettings& self, const py::kwargs& changes) { return changed(self, changes); },
                "with_(self: RenderSettings, **changes: Unpack[_SettingsKwargs]) -> RenderSettings\n\n"
                "Returns a copy with changes, by the keywords of the constructor. Settings that a change makes "
                "meaningless are removed:\nthe noise goal if spp is a number, and the illuminant if no effect uses it. "
                "Raises InputError.");
        for (const ShotKey& key : settings_in_table()) {
            if (!key.get) continue;
            const std::string text = "(self: RenderSettings) -> " + attribute_type(key) + "\n\n" + description(key);
            type.def_property_readonly(key.name, py::cpp_function(
                                                     [&key](const RenderSettings& self) {
                                                         return object_of(key, key.get(shot::request_of(self)));
                                                     },
                                                     py::is_method(type), text.c_str()));
        }
    }
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
