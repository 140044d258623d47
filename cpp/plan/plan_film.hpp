#pragma once
#include <string>
#include <vector>

#include "../optics/pupil/pupil_grid.hpp"
#include "make_plan.hpp"
#include "plan_text.hpp"

namespace REALCAM_NAMESPACE {

/// What all frames of a film are taken with.
struct FilmPlan {
    EffectChoice effects;
    CameraModel model = CameraModel::full_lens;
    int max_bounces = 1;
    std::string summary;
};

/// Plans some frames, given by their cameras, together: all effects that any of them calls for, because one that comes
/// and goes would show, but for those that the lens of another cannot show; and their camera model, or that of the
/// cameras where they call for different ones. A frame that sees nothing has no say. Throws NothingToPlan where none
/// sees anything, and what make_plan throws.
inline FilmPlan plan_film(Session& session, const Assembly& scene, const std::vector<Camera>& cameras,
                          const RenderSettings& settings, const PupilTracer& tracer, const Progress& progress = {}) {
    std::vector<Plan> plans;
    std::string last_reason;
    for (const Camera& camera : cameras) {
        try {
            plans.push_back(make_plan(session, scene, camera, settings, false, tracer, progress));
        } catch (const NothingToPlan& nothing) {
            last_reason = nothing.what();
        }
    }
    if (plans.empty()) throw NothingToPlan(last_reason);
    FilmPlan film{plans.front().effects, plans.front().model, plans.front().max_bounces, ""};
    for (const Plan& plan : plans) {
        for (const EffectInfo& effect : kEffects)
            film.effects.*effect.member = film.effects.*effect.member || plan.effects.*effect.member;
        film.max_bounces = std::max(film.max_bounces, plan.max_bounces);
        if (plan.model != film.model) film.model = cameras.front().model;
        const std::string summary = summary_of(plan);
        if (film.summary.find(summary) == std::string::npos)
            film.summary += (film.summary.empty() ? "" : "; ") + summary;
    }
    for (const Camera& camera : cameras)
        for (const EffectInfo& effect : kEffects)
            if (settings.effects.is_automatic && effect.needs_round_lens && !has_radial_pupil(camera.lens) &&
                !(settings.effects.*effect.member))
                film.effects.*effect.member = false;
    return film;
}

}  // namespace REALCAM_NAMESPACE
