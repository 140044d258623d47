#pragma once
#include <string>
#include <utility>
#include <vector>

#include "../camera/camera_setup.hpp"
#include "../optics/pupil/film_symmetry.hpp"
#include "plan.hpp"
#include "plan_costs.hpp"
#include "plan_shot.hpp"
#include "probe_scene.hpp"

namespace REALCAM_NAMESPACE {

/// Probes the scene and the lens, and decides on the effects, camera model and bounces that the settings leave to the
/// planner. `settings`: those of the picture; `measures_times`: true to measure the render time of each effect, too;
/// `tracer`: see Pupil. Throws the errors of probe_scene, and InputError if the lens passes no light or a threshold is
/// invalid.
inline Plan make_plan(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                      bool measures_times, const PupilTracer& tracer, const Progress& progress = {}) {
    validate(settings);
    // Effects of a lens whose surfaces are unknown cannot be estimated.
    if (!settings.effects.is_automatic || camera.ray_pairs) {
        Plan plan{camera.model, without_plan(settings.effects), {}, {}};
        plan_bounces(session, scene, camera, settings, plan, progress);
        return plan;
    }
    // Errors and effects are estimated for the centred lens, because tilts change them little.
    Camera full = camera;
    full.lens = centred(camera.lens);
    const SceneFacts facts = probe_scene(session, scene, full, settings, progress);
    full.model = CameraModel::full_lens;
    // All models have the directions of a calibration, so that the bundles of the lens itself are compared.
    Camera traced = full;
    traced.geometry = nullptr;
    Camera ideal = traced;
    ideal.model = CameraModel::thin_lens;
    const CameraSetup full_setup(traced, tracer), ideal_setup(ideal, tracer);
    const LensErrors errors =
        lens_errors(full_setup.view({0, 0, 0}), ideal_setup.view({0, 0, 0}), full.lens, facts, tracer);
    Plan plan = plan_shot(camera, errors, facts, settings);
    plan_bounces(session, scene, full, settings, plan, progress);
    plan_media(session, scene, full, settings, plan, progress);
    if (measures_times) measure_times(session, scene, camera, settings, plan, progress);
    return plan;
}

/// Settings of a picture, or of all frames of a video, after planning.
struct ResolvedSettings {
    CameraModel model = CameraModel::full_lens;
    RenderSettings settings;
    std::vector<Plan> plans;  ///< one for each frame that was planned
    std::string summary;      ///< the plans in one line
    std::string warning;      ///< why there was nothing to plan; otherwise empty
};

/// Plans frames, given by their cameras, together. An effect is used if any frame requires it, because an effect that
/// switches on and off within a video would be visible, unless the lens of another frame cannot show it. The camera
/// model is the planned one, or that of the first camera if the plans differ. Frames that see nothing are ignored.
/// `requested`: settings as given by the user. Throws the errors of make_plan, except NothingToPlan.
inline ResolvedSettings resolve_settings(Session& session, const Assembly& scene, const std::vector<Camera>& cameras,
                                         const RenderSettings& requested, const PupilTracer& tracer,
                                         const Progress& progress = {}) {
    ResolvedSettings film{cameras.front().model, requested, {}, "", ""};
    if (!requested.needs_plan()) return film;
    for (const Camera& camera : cameras) {
        try {
            film.plans.push_back(make_plan(session, scene, camera, requested, false, tracer, progress));
        } catch (const NothingToPlan& nothing) {
            film.warning = std::string(nothing.what()) + "; the picture has the effects that are named";
        }
    }
    EffectChoice& effects = film.settings.effects;
    if (film.plans.empty()) {
        effects = without_plan(effects);
        if (!effects.have_wavelengths()) film.settings.remove_spectra();
        return film;
    }
    film.warning.clear();
    film.model = film.plans.front().model;
    effects = film.plans.front().effects;
    film.settings.max_bounces = 0;
    for (const Plan& plan : film.plans) {
        for (const EffectInfo& effect : kEffects)
            effects.*effect.member = effects.*effect.member || plan.effects.*effect.member;
        film.settings.max_bounces = std::max(*film.settings.max_bounces, plan.max_bounces);
        if (plan.model != film.model) film.model = cameras.front().model;
        const std::string summary = summary_of(plan);
        if (film.summary.find(summary) == std::string::npos)
            film.summary += (film.summary.empty() ? "" : "; ") + summary;
    }
    for (const Camera& camera : cameras)
        for (const EffectInfo& effect : kEffects)
            if (requested.effects.is_automatic && effect.needs_rotational_lens && !has_radial_pupil(camera.lens) &&
                !(requested.effects.*effect.member))
                effects.*effect.member = false;
    if (!effects.have_wavelengths()) film.settings.remove_spectra();
    return film;
}

}  // namespace REALCAM_NAMESPACE
