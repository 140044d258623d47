#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "../camera/film/develop.hpp"
#include "../render/session/progress.hpp"
#include "../render/session/session.hpp"
#include "../render/session/take_picture.hpp"
#include "../render/settings/effect_names.hpp"
#include "plan.hpp"
#include "scene_facts.hpp"

namespace REALCAM_NAMESPACE {

namespace plan_bounces_detail {

/// Size of the small picture: pixels along its longer side, pixels along the side of a square, and samples per pixel.
/// Pictures are compared by means over squares, because Russian roulette lets few paths continue, which light up single
/// pixels.
inline constexpr int kLongSide = 48, kSquare = 4, kSamples = 32;
/// Fraction of the threshold by which the small picture may be too dark. It underestimates light that few samples find,
/// such as that of many reflections in glass. Superfluous bounces cost little, because few paths take them.
inline constexpr double kMargin = 0.5;

/// Renders a small picture; returns the display values (code_of) of its squares, three channels each. With another
/// number of bounces the same paths are followed as far as they go, so that two pictures differ only by the light of
/// the additional bounces.
inline std::vector<double> small_picture(Session& session, const Assembly& scene, const Camera& camera,
                                         RenderSettings settings, int max_bounces, const Progress& progress) {
    settings.max_bounces = max_bounces;
    const Image image = take_picture(session, scene, camera, settings, progress);
    std::vector<double> codes;
    for (int top = 0; top < image.height; top += kSquare)
        for (int left = 0; left < image.width; left += kSquare)
            for (int channel = 0; channel < 3; ++channel) {
                const int bottom = std::min(top + kSquare, image.height), right = std::min(left + kSquare, image.width);
                double sum = 0;
                for (int y = top; y < bottom; ++y)
                    for (int x = left; x < right; ++x)
                        sum += static_cast<double>(
                            image.exposure[static_cast<std::size_t>(3 * (y * image.width + x) + channel)]);
                codes.push_back(code_of(sensor_value(sum / ((bottom - top) * (right - left)), camera.iso)));
            }
    return codes;
}

/// Largest absolute difference between corresponding elements.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::fabs(a[i] - b[i]));
    return largest;
}

/// Camera and settings of small pictures.
struct SmallShot {
    Camera camera;
    RenderSettings settings;

    SmallShot(const Camera& of, const RenderSettings& settings_of) : camera(of), settings(settings_of) {
        camera.film = with_long_side(camera.film, kLongSide);
        // A pinhole camera shows the differences faster, if the lens has an axis.
        if (const LensSystem on_axis = centred(camera.lens); on_axis.is_rotational()) {
            camera.lens = on_axis;
            camera.model = CameraModel::pinhole;
            camera.ray_pairs = nullptr;
        }
        settings.spp = kSamples;
        settings.noise.reset();
        settings.effects = {};
        settings.pupil_sampling = PupilSampling::outline;
        settings.remove_spectra();
        settings.layers = {};
    }
};

/// True if a material has an interior that scatters light.
inline bool has_scattering_glass(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& material) { return material.has_scattering_interior(); });
}

/// Returns the scene with clear air.
inline Assembly without_air(const Assembly& scene) {
    return with_static_geometry(scene, [](Scene& changed) { changed.air = {}; });
}

/// Returns the scene with glass that does not scatter light, but absorbs it as before.
inline Assembly without_scattering_glass(const Assembly& scene) {
    Assembly changed = scene;
    // Instances of one object must share the changed object, too.
    std::unordered_map<const Scene*, std::shared_ptr<const Scene>> changed_parts;
    const auto change = [&](std::shared_ptr<const Scene>& part) {
        if (!has_scattering_glass(*part)) return;
        std::shared_ptr<const Scene>& result = changed_parts[part.get()];
        if (!result) {
            auto copy = std::make_shared<Scene>(*part);
            for (Material& material : copy->materials) material.scattering = {0, 0, 0};
            result = std::move(copy);
        }
        part = result;
    };
    change(changed.static_geometry);
    for (Instance& instance : changed.instances) change(instance.object);
    return changed;
}

/// Scattering medium that the planner measures by rendering the scene without it.
struct PlannedMedium {
    const char* name;  ///< PlanDecision::name
    const char* subject;  ///< of the sentence about it
    bool (*is_in)(const Assembly&);
    Assembly (*without)(const Assembly&);
};

inline constexpr std::array<PlannedMedium, 2> kPlannedMedia = {
    {{"air", "the air changes", [](const Assembly& scene) { return scene.static_geometry->air.is_present(); },
      without_air},
     {"scattering_glass", "scattering in glass changes",
      [](const Assembly& scene) {
          return has_scattering_glass(*scene.static_geometry) ||
                 std::any_of(scene.instances.begin(), scene.instances.end(),
                             [](const Instance& instance) { return has_scattering_glass(*instance.object); });
      },
      without_scattering_glass}}};

}  // namespace plan_bounces_detail

/// Sets the plan's number of bounces, and adds the decision: the least number with which every square of a small
/// picture is darker than with all bounces by less than kMargin times the threshold in codes. `settings`: those of the
/// picture. Throws the errors of take_picture.
inline void plan_bounces(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                         Plan& plan, const Progress& progress) {
    using namespace plan_bounces_detail;
    if (settings.max_bounces) {
        plan.max_bounces = *settings.max_bounces;
        return;
    }
    const double threshold = settings.thresholds.codes;
    const SmallShot small(camera, settings);
    const auto with = [&](int bounces) {
        return small_picture(session, scene, small.camera, small.settings, bounces, progress);
    };
    const std::vector<double> all = with(kMaxBounces);
    const double indirect = largest_difference(with(0), all);
    double missing = indirect, missing_with_fewer = indirect;
    plan.max_bounces = 0;
    for (const int bounces : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, kMaxBounces}) {
        if (missing < kMargin * threshold) break;
        missing_with_fewer = missing;
        plan.max_bounces = bounces;
        missing = bounces == kMaxBounces ? 0 : largest_difference(with(bounces), all);
    }
    const auto codes = [](double size) { return counted(size, "code", 2); };
    plan.decisions.push_back(
        {"bounces", indirect, SizeUnit::codes, threshold, plan.max_bounces > 0, DecidedBy::planner, std::nullopt,
         plan.max_bounces == 0 ? "indirect light adds " + codes(indirect)
                               : "with " + counted(plan.max_bounces, "bounce") + " the picture lacks " +
                                     codes(missing) + ", with fewer " + codes(missing_with_fewer) +
                                     " (half the threshold is allowed), with direct light alone " + codes(indirect)});
}

/// Adds the changes of the picture by the air and by glass that scatters light, if there are any, with the plan's
/// number of bounces. `settings`: those of the picture. Throws the errors of take_picture.
inline void plan_media(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                       Plan& plan, const Progress& progress) {
    using namespace plan_bounces_detail;
    const SmallShot small(camera, settings);
    const auto of = [&](const Assembly& shown) {
        return small_picture(session, shown, small.camera, small.settings, plan.max_bounces, progress);
    };
    for (const PlannedMedium& medium : kPlannedMedia) {
        if (!medium.is_in(scene)) continue;
        const double change = largest_difference(of(scene), of(medium.without(scene)));
        plan.decisions.push_back({medium.name, change, SizeUnit::codes, settings.thresholds.codes, true,
                                  DecidedBy::user, std::nullopt,
                                  medium.subject + (" the picture by " + counted(change, "code", 2))});
    }
}

namespace measure_times_detail {

/// Shortest run that is used as a measurement: long enough that the resolution of the clock and the start of a device
/// do not matter.
inline constexpr double kMinRun_s = 0.02;

/// Render time of `spp` samples per pixel, s: the shortest of three runs, because other programs can only slow one
/// down.
inline double shortest_run_s(Session& session, int spp, const Progress& progress) {
    double least = kInfinity;
    for (int i = 0; i < 3; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        session.add(spp, progress);
        least = std::min(least, seconds_since(begin));
    }
    return least;
}

}  // namespace measure_times_detail

/// Measures the additional time of each effect of a plan on the session's device, relative to the full lens without
/// effects, one effect at a time, as PlanDecision::time; takes some tenths of a second for each. The set-up of a
/// picture is not counted. `settings`: those of the picture. Effects that this camera cannot show get no time.
inline void measure_times(Session& session, const Assembly& scene, Camera camera, RenderSettings settings, Plan& plan,
                          const Progress& progress) {
    using namespace measure_times_detail;
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    const Film whole = camera.film;
    int long_side = 96;
    camera.film = with_long_side(whole, long_side);
    camera.model = CameraModel::full_lens;
    settings.layers = {};
    settings.noise.reset();
    settings.max_bounces = plan.max_bounces;
    EffectChoice no_effects;
    no_effects.motion_blur = no_effects.rolling_shutter = false;
    const auto set_scene = [&](const Assembly& used_scene, const EffectChoice& effects) {
        settings.effects = effects;
        RenderSettings used = settings;
        if (!effects.have_wavelengths()) used.remove_spectra();
        session.set(used_scene, camera, used, keep_going);
        session.add(1, progress);  // warm-up: work that a device does only once
    };
    const auto set = [&](const EffectChoice& effects) { set_scene(scene, effects); };
    set(no_effects);
    // The film grows until a run takes kMinRun_s: a sample of a small film costs nearly as much as one of the whole
    // picture. On a fast device it grows to the whole picture, where the use of memory counts, too.
    int spp = 1;
    double base_s = shortest_run_s(session, spp, progress);
    while (base_s < kMinRun_s && spp < (1 << 20)) {
        if (camera.film == whole) {
            spp *= 2;
        } else {
            camera.film = with_long_side(whole, long_side *= 2);
            set(no_effects);
        }
        base_s = shortest_run_s(session, spp, progress);
    }
    std::vector<std::optional<double>> seconds_with(plan.decisions.size());
    for (std::size_t k = 0; k < plan.decisions.size(); ++k) {
        if (plan.decisions[k].name == "bounces") {
            settings.max_bounces = 0;
            set(no_effects);
            plan.decisions[k].time = std::max(base_s / shortest_run_s(session, spp, progress) - 1, 0.0);
            settings.max_bounces = plan.max_bounces;
            continue;
        }
        const auto& media = plan_bounces_detail::kPlannedMedia;
        const auto medium =
            std::find_if(media.begin(), media.end(), [&](const auto& m) { return m.name == plan.decisions[k].name; });
        if (medium != media.end()) {
            set_scene(medium->without(scene), no_effects);
            plan.decisions[k].time = std::max(base_s / shortest_run_s(session, spp, progress) - 1, 0.0);
            continue;
        }
        const EffectInfo* effect = find_effect(plan.decisions[k].name);
        if (!effect) continue;  // a property of the camera model
        EffectChoice one = no_effects;
        one.*effect->member = true;
        try {
            set(one);
        } catch (const InputError&) {
            continue;  // for example because the index of a glass is not known at all wavelengths
        }
        seconds_with[k] = shortest_run_s(session, spp, progress);
    }
    set(no_effects);
    base_s = std::min(base_s, shortest_run_s(session, spp, progress));
    for (std::size_t k = 0; k < seconds_with.size(); ++k)
        if (seconds_with[k]) plan.decisions[k].time = std::max(*seconds_with[k] / base_s - 1, 0.0);
}

}  // namespace REALCAM_NAMESPACE
