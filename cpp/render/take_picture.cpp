#include "take_picture.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "seconds_since.hpp"

namespace realcam {

Image take_picture(Session& session, const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    session.set(scene, camera, settings, keep_going);
    session.restart(keep_going);
    const double setup_seconds = seconds_since(start);
    std::string shortfall;
    if (settings.noise)
        shortfall = shortfall_of(session.add_until(*settings.noise, progress), *settings.noise);
    else
        session.add(settings.spp, progress);
    Image image = session.picture();
    image.shortfall = std::move(shortfall);
    image.stats.setup_seconds = setup_seconds;
    image.stats.seconds = seconds_since(start);
    return image;
}

}  // namespace realcam
