#pragma once
#include "../camera/camera_setup.hpp"
#include "measure_times.hpp"
#include "plan_bounces.hpp"
#include "plan_shot.hpp"
#include "probe_scene.hpp"

namespace REALCAM_NAMESPACE {

/// Probes the scene and the lens, and plans what the settings leave to the planner. `settings`: those of the picture.
/// Throws what probe_scene throws, and InputError if the lens passes no light or a threshold is invalid.
inline Plan make_plan(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                      bool measures_times, const PupilTracer& tracer, const Progress& progress = {}) {
    validate(settings);
    if (!settings.effects.is_automatic) {
        Plan plan{camera.model, settings.effects, {}, {}};
        plan_bounces(session, scene, camera, settings, plan, progress);
        return plan;
    }
    // Errors and effects are estimated for the centred lens, because tilts change them little.
    Camera full = camera;
    full.lens = centred(camera.lens);
    const SceneFacts facts = probe_scene(session, scene, full, settings, progress);
    Camera ideal = full;
    full.model = CameraModel::full_lens;
    ideal.model = CameraModel::thin_lens;
    const CameraSetup of_surfaces(full, tracer), of_ideal(ideal, tracer);
    const LensErrors errors =
        lens_errors(of_surfaces.view({0, 0, 0}), of_ideal.view({0, 0, 0}), full.lens, facts, tracer);
    Plan plan = plan_shot(camera, errors, facts, settings);
    plan_bounces(session, scene, full, settings, plan, progress);
    if (measures_times) measure_times(session, scene, camera, settings, plan, progress);
    return plan;
}

}  // namespace REALCAM_NAMESPACE
