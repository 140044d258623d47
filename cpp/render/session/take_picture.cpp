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

/// Takes `spp` samples of each pixel in rounds that double their number, so that, whenever the picture is stopped, no
/// pixel has less than half as many samples as another one. The samples are the same as in a single round.
void add_evenly(Session& session, int spp, const Progress& progress) {
    constexpr int kFirstRound = 8;
    for (int taken = 0; taken < spp;) {
        const int round = std::min(std::max(kFirstRound, taken), spp - taken);
        session.add(round, [&](double done) { return progress((taken + done * round) / spp); });
        taken += round;
    }
}

/// Returns the value of Image::shortfall for a picture that was stopped after `taken` of `spp` samples per pixel.
std::string stop_message(std::int64_t taken, int spp) {
    return "it was stopped after " + std::to_string(taken) + " of " + std::to_string(spp) + " samples, and has about " +
           number_text(std::sqrt(static_cast<double>(spp) / static_cast<double>(taken)), 2) +
           " times the noise of all of them";
}

}  // namespace

Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress, const KeepGoing& keep_partial) {
    const auto start = std::chrono::steady_clock::now();
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    session.set(scene, camera, settings, keep_going);
    session.restart(keep_going);
    const double setup_seconds = seconds_since(start);
    std::string shortfall;
    bool is_stopped = false;
    try {
        if (settings.noise)
            shortfall = shortfall_message(session.add_until(*settings.noise, progress), *settings.noise);
        // With learned pupils, samples depend on the rounds, which must therefore be the same for all pictures.
        else if (keep_partial && progress && settings.pupil_sampling != PupilSampling::pixel)
            add_evenly(session, settings.spp, progress);
        else
            session.add(settings.spp, progress);
    } catch (const Cancelled&) {
        if (!keep_partial || !keep_partial() || std::ranges::min(session.sample_counts().counts) == 0) throw;
        is_stopped = true;
    }
    constexpr std::int64_t kMaxLayerSamplesAfterStop = 16;  // after a stop, layers of all samples would take too long
    Image image = session.picture(keep_partial, is_stopped ? kMaxLayerSamplesAfterStop : Session::kAllSamples);
    if (is_stopped)
        shortfall = settings.noise ? "it was stopped; " + shortfall_message(session.noise_so_far(), *settings.noise)
                                   : stop_message(image.spp, settings.spp);
    image.shortfall = std::move(shortfall);
    image.stats.setup_seconds = setup_seconds;
    image.stats.seconds = seconds_since(start);
    return image;
}

}  // namespace realcam
