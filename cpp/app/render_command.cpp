#include "render_command.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include "../devices/devices.hpp"
#include "../image_io/image_file.hpp"
#include "../render/daylight.hpp"
#include "../render/metering.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"
#include "render_options.hpp"
#include "render_summary.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

void say(const std::string& text) {
    std::fprintf(stderr, "realcam: %s\n", text.c_str());
}

/// Names what the memory was wanted for.
template <class Work>
auto with_memory_for(const std::string& what, Work&& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw Error("out of memory: " + what);
    }
}

Assembly read_scene(const RenderRequest& request) {
    const Assembly scene = with_memory_for("while reading " + request.scene, [&] {
        return io::read_scene(request.scene, {request.scale}, image_io::read_image);
    });
    const std::vector<std::string>& warnings = scene.static_geometry->warnings;
    constexpr std::size_t kShown = 10;
    for (std::size_t i = 0; i < std::min(kShown, warnings.size()); ++i) say("warning: " + warnings[i]);
    if (warnings.size() > kShown) say("and " + std::to_string(warnings.size() - kShown) + " more warnings");
    if (request.environment_cd_m2) {
        const auto radiance = static_cast<float>(*request.environment_cd_m2);
        return with_static_geometry(scene, [&](Scene& changed) {
            changed.environment = {};
            changed.environment.constant = {radiance, radiance, radiance};
        });
    }
    if (!request.environment_file.empty())
        return with_memory_for("while reading " + request.environment_file, [&] {
            return with_static_geometry(scene, [&](Scene& changed) {
                changed.environment = image_io::read_environment(request.environment_file);
            });
        });
    return scene;
}

/// A progress callback that draws, and stops on a signal.
Progress drawing_on(ProgressBar& bar) {
    return [&bar](double done) {
        bar.show(done);
        return Interrupt::signal() == 0;
    };
}

Image expose(Backend& backend, const Assembly& scene, RenderRequest& request) {
    Camera& camera = request.camera;
    if (request.meters_exposure) {
        ProgressBar bar("metering ");
        camera.exposure_time_s = metered_exposure_time(backend, scene, camera, request.settings, drawing_on(bar));
    }
    ProgressBar bar("rendering");
    const Film& film = camera.film;
    return with_memory_for(
        "for a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
        [&] { return backend.render(scene, camera, request.settings, drawing_on(bar)); });
}

void run_render(const RenderWords& words) {
    const auto start = std::chrono::steady_clock::now();
    RenderRequest request = understand(words);
    const auto backend = make_backend(request.device);  // first, because reading a scene may take long
    Assembly scene = read_scene(request);
    set_view(request.camera, scene, request.view);
    // An environment that was asked for counts even where it is dark.
    const bool chosen = request.environment_cd_m2 || !request.environment_file.empty();
    if (!scene.has_light() && !chosen) {
        scene = with_static_geometry(scene, [&](Scene& changed) { add_daylight(changed, request.camera.pose); });
        say("the scene holds no light; it gets daylight: a sun of 80 klux from the upper left, and a sky of 5000 "
            "cd/m^2");
    }
    // Until here nothing is on disk, and a signal may simply end the program.
    const Interrupt interrupt;
    Image image;
    try {
        image = expose(*backend, scene, request);
        const auto metadata = image_io::metadata_of(request.camera, request.settings);
        for (const std::string& path : request.outputs) {
            if (Interrupt::signal() != 0) throw Cancelled();
            image_io::write_image(image, path, metadata, request.tone);
        }
    } catch (const Cancelled&) {
        throw Interrupted{Interrupt::signal()};
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::fputs(summary(request, image, seconds).c_str(), stdout);
}

}  // namespace

void add_render_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Photograph a scene through a lens");
    const auto words = std::make_shared<RenderWords>();
    add_render_options(*command, *words);
    command->callback([words] { run_render(*words); });
}

}  // namespace realcam::app
