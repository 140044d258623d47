#pragma once
#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "../render/effect_names.hpp"
#include "../render/seconds_since.hpp"
#include "../render/session.hpp"
#include "plan.hpp"
#include "small_film.hpp"

namespace REALCAM_NAMESPACE {

namespace measure_times_detail {

/// Long enough that the resolution of the clock and the start of a device do not matter.
inline constexpr double kLeast_s = 0.02;

/// Seconds for `spp` samples per pixel: the least of three runs, because other programs can only slow one down.
inline double seconds_of(Session& session, int spp, const Progress& progress) {
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
/// effects, one effect at a time; takes some tenths of a second for each. Preparations, which a picture needs once, are
/// not counted. `settings`: those of the picture. Effects that this camera cannot have get no time.
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
    EffectChoice none;
    none.motion_blur = none.rolling_shutter = false;
    const auto set = [&](const EffectChoice& effects) {
        settings.effects = effects;
        RenderSettings given = settings;
        if (!effects.have_wavelengths()) given.illuminant.reset();
        session.set(scene, camera, given, keep_going);
        session.add(1, progress);  // runs what a device does only once
    };
    set(none);
    // The film grows until a run takes kLeast_s: a sample of a small film costs nearly as much as one of the whole
    // picture. On a fast device it grows to the whole picture, where the use of memory counts, too.
    int spp = 1;
    double alone = seconds_of(session, spp, progress);
    while (alone < kLeast_s && spp < (1 << 20)) {
        if (camera.film == whole) {
            spp *= 2;
        } else {
            camera.film = with_long_side(whole, long_side *= 2);
            set(none);
        }
        alone = seconds_of(session, spp, progress);
    }
    std::vector<std::optional<double>> with(plan.decisions.size());
    for (std::size_t k = 0; k < plan.decisions.size(); ++k) {
        if (plan.decisions[k].name == "bounces") {
            settings.max_bounces = 0;
            set(none);
            plan.decisions[k].time = std::max(alone / seconds_of(session, spp, progress) - 1, 0.0);
            settings.max_bounces = plan.max_bounces;
            continue;
        }
        const EffectInfo* effect = find_effect(plan.decisions[k].name);
        if (!effect) continue;  // it comes with the camera model
        EffectChoice one = none;
        one.*effect->member = true;
        try {
            set(one);
        } catch (const InputError&) {
            continue;  // for example because the index of a glass is not known at all wavelengths
        }
        with[k] = seconds_of(session, spp, progress);
    }
    set(none);
    alone = std::min(alone, seconds_of(session, spp, progress));
    for (std::size_t k = 0; k < with.size(); ++k)
        if (with[k]) plan.decisions[k].time = std::max(*with[k] / alone - 1, 0.0);
}

}  // namespace REALCAM_NAMESPACE
