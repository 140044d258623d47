#include "take_picture.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "../../number_text.hpp"
#include "progress.hpp"

namespace realcam {
namespace {

/// Takes the samples in rounds that double their number, so that no pixel has less than half as many as another one
/// whenever the picture is stopped. The samples are the same as in a single round.
void add_evenly(Session& session, int spp, const Progress& progress) {
    constexpr int kFirst = 8;
    for (int taken = 0; taken < spp;) {
        const int round = std::min(std::max(kFirst, taken), spp - taken);
        session.add(round, [&](double done) { return progress((taken + done * round) / spp); });
        taken += round;
    }
}

std::string stopped_sentence(std::int64_t taken, int spp) {
    return "it was stopped after " + std::to_string(taken) + " of " + std::to_string(spp) + " samples, and has about " +
           number_text(std::sqrt(static_cast<double>(spp) / static_cast<double>(taken)), 2) +
           " times the noise of all of them";
}

}  // namespace

Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress, const KeepGoing& finishes) {
    const auto start = std::chrono::steady_clock::now();
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    session.set(scene, camera, settings, keep_going);
    session.restart(keep_going);
    const double setup_seconds = seconds_since(start);
    std::string shortfall;
    bool is_stopped = false;
    try {
        if (settings.noise)
            shortfall = shortfall_of(session.add_until(*settings.noise, progress), *settings.noise);
        else if (finishes && progress && settings.pupil_sampling != PupilSampling::pixel)
            add_evenly(session, settings.spp, progress);
        else
            session.add(settings.spp, progress);
    } catch (const Cancelled&) {
        if (!finishes || !finishes() || std::ranges::min(session.sample_counts().counts) == 0) throw;
        is_stopped = true;
    }
    constexpr std::int64_t kLayerSamplesOfStopped = 16;  // after a stop, layers of all samples would take too long
    Image image = session.picture(finishes, is_stopped ? kLayerSamplesOfStopped : Session::kAllSamples);
    if (is_stopped)
        shortfall = settings.noise ? "it was stopped; " + shortfall_of(session.noise_so_far(), *settings.noise)
                                   : stopped_sentence(image.spp, settings.spp);
    image.shortfall = std::move(shortfall);
    image.stats.setup_seconds = setup_seconds;
    image.stats.seconds = seconds_since(start);
    return image;
}

}  // namespace realcam
