#pragma once
#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "../render/effect_names.hpp"
#include "../render/seconds_since.hpp"
#include "../render/session.hpp"
#include "plan.hpp"

namespace REALCAM_NAMESPACE {

namespace measure_times_detail {

/// Long enough that a clock and a device's start do not count.
inline constexpr double kLeast_s = 0.02;

/// The same view in fewer pixels: what a sample costs depends little on their number.
inline void make_small(Film& film) {
    constexpr int kLongSide = 96;
    const double scale = std::min(1.0, static_cast<double>(kLongSide) / std::max(film.width, film.height));
    film.width = std::max(1, static_cast<int>(film.width * scale));
    film.height = std::max(1, static_cast<int>(film.height * scale));
}

/// Of taking so many samples: the least of three times, because other programs can only slow one down.
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

/// Measures what each effect of a plan adds to this picture's time on the session's device, each by itself beside every
/// surface of the lens without effects: some tenths of a second for each. Preparations, which a picture needs once, are
/// not counted. `settings`: of the picture. What this camera cannot have keeps no time.
inline void measure_times(Session& session, const Assembly& scene, Camera camera, RenderSettings settings, Plan& plan,
                          const Progress& progress) {
    using namespace measure_times_detail;
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    make_small(camera.film);
    camera.model = CameraModel::full_lens;
    settings.layers = {};
    settings.noise.reset();
    EffectChoice none;
    none.motion_blur = none.rolling_shutter = false;
    const auto set = [&](const EffectChoice& effects) {
        settings.effects = effects;
        RenderSettings given = settings;
        if (!effects.have_wavelengths()) given.illuminant.reset();
        session.set(scene, camera, given, keep_going);
        session.add(1, progress);  // whatever a device does but once
    };
    set(none);
    int spp = 1;
    while (spp < (1 << 20) && seconds_of(session, spp, progress) < kLeast_s) spp *= 2;
    double alone = seconds_of(session, spp, progress);
    std::vector<std::optional<double>> with(plan.decisions.size());
    for (std::size_t k = 0; k < plan.decisions.size(); ++k) {
        const EffectInfo* effect = find_effect(plan.decisions[k].name);
        if (!effect) continue;  // what comes along with the camera model
        EffectChoice one = none;
        one.*effect->member = true;
        try {
            set(one);
        } catch (const InputError&) {
            continue;  // of a glass that is not known at all wavelengths, say
        }
        with[k] = seconds_of(session, spp, progress);
    }
    set(none);
    alone = std::min(alone, seconds_of(session, spp, progress));
    for (std::size_t k = 0; k < with.size(); ++k)
        if (with[k]) plan.decisions[k].time = std::max(*with[k] / alone - 1, 0.0);
}

}  // namespace REALCAM_NAMESPACE
