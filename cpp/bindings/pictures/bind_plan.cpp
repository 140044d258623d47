#include <pybind11/stl.h>

#include <cmath>

#include "../../embree/lens_rays.hpp"
#include "../../io/files/image_metadata.hpp"
#include "../../plan/make_plan.hpp"
#include "../bindings.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "owned_session.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Decision of a plan as Python exposes it.
struct Decision {
    std::string effect, unit, by, reason;
    double size, threshold;
    std::optional<double> time_share;
    bool is_kept;
};

struct Planned {
    std::string model;
    std::vector<std::string> effects;
    int max_bounces;
    std::vector<Decision> decisions;
    std::string text, summary;
};

Planned planned_of(const Plan& plan) {
    const std::string model = io::name_of(plan.model);
    Planned planned{model, names_of(plan.effects), plan.max_bounces, {}, text_of(plan, model), summary_of(plan)};
    for (const PlanDecision& d : plan.decisions)
        planned.decisions.push_back({d.name, name_of(d.unit), d.by == DecidedBy::user ? "user" : "planner", d.reason,
                                     d.size, d.threshold, d.time, d.is_kept});
    return planned;
}

Planned plan(const Assembly& scene, const Camera& camera, const RenderSettings& settings, const std::string& device,
             bool times) {
    return OwnedSession::shared(device).use([&](const auto& session) {
        return planned_of(make_plan(*session, scene, camera, settings, times, fast_pupil_tracer(),
                                    [](double) { return heed_signals(); }));
    });
}

/// Returns the camera model, the settings, the summary and a warning for a film sequence, from the camera of its first
/// frame and those of other frames.
std::tuple<std::string, RenderSettings, std::string, std::string> resolved_film(const Assembly& scene,
                                                                                const Camera& camera,
                                                                                const std::vector<Camera>& others,
                                                                                const RenderSettings& settings,
                                                                                const std::string& device) {
    if (!settings.needs_plan()) return {io::name_of(camera.model), settings, "", ""};  // avoids creating a session
    std::vector<Camera> cameras = {camera};
    cameras.insert(cameras.end(), others.begin(), others.end());
    ResolvedFilm film = OwnedSession::shared(device).use([&](const auto& session) {
        return resolve_film(*session, scene, cameras, settings, fast_pupil_tracer(),
                            [](double) { return heed_signals(); });
    });
    return {io::name_of(film.model), std::move(film.settings), film.summary, film.warning};
}

}  // namespace

template <>
struct RestoredCheck<Decision> : AnyMembers {};
template <>
struct RestoredCheck<Planned> : AnyMembers {};

void bind_plan(py::module_& m) {
    m.def("_number_text", [](double value, int digits) { return number_text(value, digits); }, "value"_a, "digits"_a);
    py::class_<Decision> decision(m, "PlanDecision", "One thing that a picture may have or do without.");
    def_value(decision);
    decision.def_readonly("effect", &Decision::effect)
        .def_readonly("size", &Decision::size, "By how much the picture changes where it is left out.")
        .def_readonly("unit", &Decision::unit, "Of size and threshold: \"px\", or \"codes\" of 8 bits.")
        .def_readonly("threshold", &Decision::threshold)
        .def_readonly("is_kept", &Decision::is_kept)
        .def_readonly("by", &Decision::by, "\"planner\", or \"user\" where the effect was named.")
        .def_readonly("time_share", &Decision::time_share,
                      R"(What the effect by itself adds to the picture's time, as a share of that without effects,
measured on the device; None: not measured.)")
        .def_readonly("reason", &Decision::reason)
        .def("__repr__", [](const Decision& d) {
            return "<realcam.PlanDecision " + d.effect + ' ' + (d.is_kept ? "kept" : "left out") + ": " +
                   digits(d.size) + ' ' + d.unit + " of " + digits(d.threshold) + '>';
        });
    py::class_<Planned> planned(m, "Plan", "What a shot calls for. str() makes a table of it.");
    def_value(planned);
    planned
        .def_readonly("model", &Planned::model, "The cheapest camera model that looks like every surface of the lens.")
        .def_readonly("effects", &Planned::effects, "Names, as render takes them.")
        .def_readonly("max_bounces", &Planned::max_bounces)
        .def_readonly("decisions", &Planned::decisions)
        .def_readonly("summary", &Planned::summary, "What was decided, in a line, as it is in a picture's metadata.")
        .def("__str__", [](const Planned& p) { return p.text; })
        .def("__repr__", [](const Planned& p) {
            std::string names;
            for (const std::string& name : p.effects) names += (names.empty() ? "" : ", ") + name;
            return "<realcam.Plan: model " + p.model + ", effects " + (names.empty() ? "none" : names) + '>';
        });
    m.def("_plan", &plan, "scene"_a, "camera"_a, "settings"_a, "device"_a, "times"_a);
    m.def("_resolve_film", &resolved_film, "scene"_a, "camera"_a, "others"_a, "settings"_a, "device"_a);
}

}  // namespace realcam::bindings
