// Rendering of one picture, its statistics, the lists of effects and devices, and conversions that all bindings use.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>

#include "../../camera/film/develop.hpp"
#include "../../devices/cuda_plugin.hpp"
#include "../../devices/devices.hpp"
#include "../../render/session/metering.hpp"
#include "../../render/session/take_picture.hpp"
#include "../../render/settings/effect_names.hpp"
#include "../../render/settings/setting_names.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "owned_session.hpp"
#include "python_image.hpp"

namespace realcam::bindings {

using namespace py::literals;

void warn(const std::string& text) {
    const py::gil_scoped_acquire acquire;
    // Stack level 2 is the user's call: level 1 is the wrapper in realcam.arguments around each function of the module.
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 2) < 0) throw py::error_already_set();
}

ToneCurve tone_curve_from(const std::string& name) {
    if (const auto tone = value_named(kToneCurves, name)) return *tone;
    throw InputError("unknown tone curve \"" + name + "\"; expected " + one_of(kToneCurves));
}

std::uint32_t seed_from(std::int64_t seed, const char* what) {
    if (seed < 0 || seed > 0xffffffff)
        throw InputError("the " + std::string(what) + " must lie between 0 and 4294967295");
    return static_cast<std::uint32_t>(seed);
}

bool heed_signals() {
    stop_at_exit();
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return true;
}

Progress progress_of(const py::object& callback) {
    if (!callback.is_none() && !PyCallable_Check(callback.ptr()))
        throw InputError("progress must be a function of the finished fraction, 0 to 1");
    return [&callback](double fraction) {
        heed_signals();
        const py::gil_scoped_acquire acquire;
        if (callback.is_none()) return true;
        const py::object answer = callback(fraction);
        if (answer.is_none()) return true;
        const int continues = py::isinstance<py::str>(answer) ? -1 : PyObject_IsTrue(answer.ptr());
        if (continues >= 0) return continues != 0;
        PyErr_Clear();
        throw InputError("progress must return False to stop, otherwise True or None; it returned " +
                         py::module_::import("reprlib").attr("repr")(answer).cast<std::string>());
    };
}

namespace {

/// Renders a picture. `keeps_stopped`: if the progress function stops rendering, returns the picture of the samples
/// taken so far; otherwise throws Cancelled then.
PythonImage render(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const std::string& device, const ProgressFunction& progress, bool keeps_stopped,
                   const std::string& plan) {
    const Progress report = progress_of(progress);
    const KeepGoing finishes = keeps_stopped ? KeepGoing(heed_signals) : KeepGoing();
    Image image = OwnedSession::shared(device).use(
        [&](const auto& session) { return take_picture(*session, scene, camera, settings, report, finishes); });
    return python_image(std::move(image), camera, settings, plan);
}

/// Converts exposure in lux seconds (any shape) to 8-bit sRGB values of the same shape.
py::array_t<std::uint8_t> develop(const InputArray<float>& exposure, double iso, const std::string& tone) {
    const ToneCurve curve = tone_curve_from(tone);
    if (!(iso > 0) || !std::isfinite(iso)) throw InputError("the ISO number must be positive");
    py::array_t<std::uint8_t> codes(std::vector<py::ssize_t>(exposure.shape(), exposure.shape() + exposure.ndim()));
    const float* from = exposure.data();
    std::uint8_t* to = codes.mutable_data();
    constexpr py::ssize_t kBetweenSignals = 1 << 20;  // about ten milliseconds of work
    const Unlocked unlocked;
    const CodeTable code(iso, curve);
    for (py::ssize_t done = 0; done < exposure.size(); done += kBetweenSignals) {
        heed_signals();
        for (py::ssize_t i = done; i < std::min(done + kBetweenSignals, exposure.size()); ++i) to[i] = code(from[i]);
    }
    return codes;
}

std::string line_text(const EffectInfo& effect) {
    return effect.name + (": " + line_of(effect));
}

std::string line_text(const Device& device) {
    return device.name + ": " + device.description;
}

}  // namespace

void bind_render(py::module_& m) {
    py::class_<RenderStats> stats(m, "RenderStats", "Render time and number of rays of a picture.");
    def_hashable_value(stats);
    stats.def_readonly("seconds", &RenderStats::seconds, "Total time (wall clock).")
        .def_readonly("setup_seconds", &RenderStats::setup_seconds,
                      "Part of seconds spent on the pupil and the scene's acceleration structures.")
        .def_readonly("lens_seconds", &RenderStats::lens_seconds, "Time in the lens trace, summed over all threads.")
        .def_readonly("scene_seconds", &RenderStats::scene_seconds,
                      "Time in ray-scene intersection and shading, summed over all threads.")
        .def_readonly("other_seconds", &RenderStats::other_seconds, "Other time, summed over all threads.")
        .def_readonly("sampled_rays", &RenderStats::sampled_rays, "Number of rays sent into the lens from the film.")
        .def_readonly("passed_rays", &RenderStats::passed_rays, "Number of them that passed the lens.")
        .def_readonly("scene_rays", &RenderStats::scene_rays,
                      "Number of rays in the scene: camera, shadow and bounce rays.")
        .def_readonly("device", &RenderStats::device, "Name of the device.")
        .def("__repr__", [](const RenderStats& s) {
            return "<realcam.RenderStats " + digits(s.seconds) + " s on " + s.device + '>';
        });
    m.def("_render", &render, "scene"_a, "camera"_a, "settings"_a, "device"_a, "progress"_a, "keeps_stopped"_a,
          "plan"_a,
          R"(Internal: use realcam.render. keeps_stopped: if progress stops rendering, return the picture of the samples
taken so far instead of raising Cancelled. plan: summary of the plan.)");
    m.def(
        "_effect_notices",
        [](const LensSystem& lens, const RenderSettings& settings) { return effect_notices(settings.effects, lens); },
        "lens"_a, "settings"_a,
        "Internal. Returns sentences about named effects that the lens cannot show, or only approximately.");
    py::class_<EffectInfo> effect_type(
        m, "EffectInfo", "Optional effect of a picture. str() returns its name and description in a line.");
    def_copy(effect_type);
    // Each effect is one Python object that refers to the static table.
    py::tuple effect_rows(std::size(kEffects));
    for (std::size_t i = 0; i < std::size(kEffects); ++i)
        effect_rows[i] = py::cast(kEffects[i], py::return_value_policy::reference);
    def_pickle(
        effect_type, [](const py::object& self) { return self.attr("name"); },
        [effect_rows](const std::string& name) -> py::object {
            const EffectInfo* effect = find_effect(name);
            if (!effect) throw InputError("the effect does not exist in this version");
            return effect_rows[static_cast<std::size_t>(effect - kEffects)];
        });
    effect_type.def_readonly("name", &EffectInfo::name, "Name, for RenderSettings(effects=...).")
        .def_readonly("what", &EffectInfo::what, "Description.")
        .def_readonly("needs", &EffectInfo::needs, "Requirements on lens, scene and camera.")
        .def_readonly("usage", &EffectInfo::usage, "Further notes; may be empty.")
        .def_property_readonly("is_on", &EffectInfo::is_on,
                               "True if the effect is simulated unless it is switched off by \"-name\".")
        .def_property_readonly(
            "parameter",
            [](const EffectInfo& effect) {
                return effect.parameter ? std::optional(EffectChoice().*effect.parameter) : std::nullopt;
            },
            "Default of the number in \"name=number\"; None: the effect has no parameter.")
        .def_readonly("has_wavelengths", &EffectInfo::has_wavelengths,
                      "True if each sample has a wavelength, so that RenderSettings(illuminant=...) applies.")
        .def_readonly("needs_full_lens", &EffectInfo::needs_full_lens,
                      "True if the effect requires the camera model \"full\".")
        .def_readonly("needs_coatings", &EffectInfo::needs_coatings,
                      "True if the effect uses the coatings in the lens file; without them the result is a guess.")
        .def_readonly("shows_in_previews", &EffectInfo::shows_in_previews,
                      "True if the effect is simulated in previews, which have fewer pixels than the picture.")
        .def_readonly("cpu_time", &EffectInfo::cpu_time,
                      "Render time with the effect over that without it, on a CPU core (benchmarks/effects.py); 0: not "
                      "measured.")
        .def_readonly("gpu_time", &EffectInfo::gpu_time,
                      "Render time with the effect over that without it, on a GPU; 0: not measured.")
        .def_property_readonly("description", &line_of, "Description and requirements in a line.")
        .def("__str__", py::overload_cast<const EffectInfo&>(&line_text))
        .def("__repr__", [](const EffectInfo& e) { return std::string("<realcam.EffectInfo ") + e.name + '>'; });
    m.def(
        "effects", [effect_rows]()->Typed<"list[EffectInfo]", py::list> { return py::list(effect_rows); },
        "Returns the list of all optional effects, for RenderSettings(effects=...).");
    m.def("develop", &develop, "exposure"_a, "iso"_a, "tone"_a = "film",
          R"(Converts film exposure to 8-bit sRGB values of the same shape.
exposure: in lux seconds, any shape. iso: sensitivity; an exposure of 10 / iso lux seconds becomes middle grey, 118.
tone: tone curve, "film" (soft highlights) or "linear" (clipped highlights). Raises InputError.)");
    m.def(
        "_metered_exposure",
        [](const py::array_t<float, py::array::c_style | py::array::forcecast>& exposure) {
            Image image;
            image.exposure = PictureFloats({exposure.data(), static_cast<std::size_t>(exposure.size())});
            return metered_exposure(image);
        },
        "exposure"_a, "Internal. Returns the average exposure of a picture as a light meter sees it, in lux seconds.");
    py::class_<Device> device_type(m, "Device",
                                   "Device that this machine can render with. str() returns name and description.");
    def_hashable_value(device_type);
    device_type.def_readonly("name", &Device::name, "Name, for device=...: \"cpu\", \"cuda:0\", ...")
        .def_readonly("description", &Device::description, "Model of the processor or GPU.")
        .def("__str__", py::overload_cast<const Device&>(&line_text))
        .def("__repr__", [](const Device& d) { return "<realcam.Device " + line_text(d) + '>'; });
    m.def("devices", &devices, "Returns the list of all devices of this machine, the CPU first.");
    m.def(
        "_name_cuda_plugin", [](const py::bytes& path) { set_cuda_plugin_path(path); }, "path"_a,
        "Internal. Sets the path of the CUDA plug-in, which is loaded when a GPU is first used.");
}

}  // namespace realcam::bindings
