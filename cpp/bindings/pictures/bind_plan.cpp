// The planner: the classes Plan and PlanDecision.

#include <pybind11/stl.h>

#include <cmath>

#include "../../embree/lens_rays.hpp"
#include "../../plan/make_plan.hpp"
#include "../../render/settings/setting_names.hpp"
#include "../bindings.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "owned_session.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Decision of a plan as Python exposes it; see the docstrings.
struct Decision {
    std::string effect, unit, by, reason;
    double size, threshold;
    std::optional<double> time_share;
    bool is_kept;
};

/// Plan as Python exposes it; see the docstrings.
struct Planned {
    std::string model;
    std::vector<std::string> effects;
    int max_bounces;
    std::vector<Decision> decisions;
    std::string text, summary;
};

Planned planned_of(const Plan& plan) {
    const std::string model = name_of(plan.model);
    Planned planned{model, names_of(plan.effects), plan.max_bounces, {}, text_of(plan, model), summary_of(plan)};
    for (const PlanDecision& d : plan.decisions)
        planned.decisions.push_back({d.name, name_of(d.unit), d.by == DecidedBy::user ? "user" : "planner", d.reason,
                                     d.size, d.threshold, d.time, d.is_kept});
    return planned;
}

/// `times`: also measures the render time of each effect.
Planned plan(const Assembly& scene, const Camera& camera, const RenderSettings& settings, const std::string& device,
             bool times) {
    return OwnedSession::shared(device).use([&](const auto& session) {
        return planned_of(make_plan(*session, scene, camera, settings, times, fast_pupil_tracer(),
                                    [](double) { return heed_signals(); }));
    });
}

/// Plans a video. Returns the camera model, the settings, a summary of the plan and a warning (or empty texts).
/// `camera`: that of the first frame; `others`: cameras of other frames.
std::tuple<std::string, RenderSettings, std::string, std::string> resolved_video(const Assembly& scene,
                                                                                 const Camera& camera,
                                                                                 const std::vector<Camera>& others,
                                                                                 const RenderSettings& settings,
                                                                                 const std::string& device) {
    if (!settings.needs_plan()) return {name_of(camera.model), settings, "", ""};  // avoids creating a session
    std::vector<Camera> cameras = {camera};
    cameras.insert(cameras.end(), others.begin(), others.end());
    ResolvedSettings video = OwnedSession::shared(device).use([&](const auto& session) {
        return resolve_settings(*session, scene, cameras, settings, fast_pupil_tracer(),
                                [](double) { return heed_signals(); });
    });
    return {name_of(video.model), std::move(video.settings), video.summary, video.warning};
}

}  // namespace

void bind_plan(py::module_& m) {
    m.def(
        "_number_text", [](double value, int digits) { return number_text(value, digits); }, "value"_a, "digits"_a,
        "Internal. Formats a number with this number of significant digits.");
    py::class_<Decision> decision(m, "PlanDecision", "Decision of a Plan: whether an effect is simulated.");
    def_value(decision);
    decision.def_readonly("effect", &Decision::effect, "Name of the effect, or of another choice such as the bounces.")
        .def_readonly("size", &Decision::size, "Change of the picture if the effect is left out.")
        .def_readonly("unit", &Decision::unit,
                      "Unit of size and threshold: \"px\" (pixels), or \"codes\" (steps of an 8-bit picture).")
        .def_readonly("threshold", &Decision::threshold, "Size from which the planner keeps the effect.")
        .def_readonly("is_kept", &Decision::is_kept, "True if the effect is simulated.")
        .def_readonly("by", &Decision::by, "Who decided: \"planner\", or \"user\" if the effect was named.")
        .def_readonly("time_share", &Decision::time_share,
                      R"(Additional render time of the effect alone, relative to the time without effects, measured on
the device; None: not measured.)")
        .def_readonly("reason", &Decision::reason, "Explanation of the decision.")
        .def("__repr__", [](const Decision& d) {
            return "<realcam.PlanDecision " + d.effect + ' ' + (d.is_kept ? "kept" : "left out") + ": " +
                   digits(d.size) + ' ' + d.unit + " of " + digits(d.threshold) + '>';
        });
    py::class_<Planned> planned(
        m, "Plan",
        "Camera model, effects and bounces that a shot requires (rc.plan). str() returns a table "
        "of the decisions.");
    def_value(planned);
    planned
        .def_readonly("model", &Planned::model,
                      "The cheapest camera model whose picture does not differ visibly from the model \"full\".")
        .def_readonly("effects", &Planned::effects, "Names of the effects, for RenderSettings(effects=...).")
        .def_readonly("max_bounces", &Planned::max_bounces, "Maximum number of bounces of a path.")
        .def_readonly("decisions", &Planned::decisions, "List of PlanDecisions.")
        .def_readonly("summary", &Planned::summary, "The decisions in one line, as in a picture's metadata.")
        .def("__str__", [](const Planned& p) { return p.text; })
        .def("__repr__", [](const Planned& p) {
            std::string names;
            for (const std::string& name : p.effects) names += (names.empty() ? "" : ", ") + name;
            return "<realcam.Plan: model " + p.model + ", effects " + (names.empty() ? "none" : names) + '>';
        });
    m.def("_plan", &plan, "scene"_a, "camera"_a, "settings"_a, "device"_a, "times"_a,
          "Internal: use realcam.plan. times: True measures the render time of each effect.");
    m.def(
        "_resolve_film", &resolved_video, "scene"_a, "camera"_a, "others"_a, "settings"_a, "device"_a,
        R"(Internal. Plans a video from the camera of its first frame and those of other frames. Returns (camera model,
settings, summary, warning); the texts are empty without a plan.)");
}

}  // namespace realcam::bindings
