#pragma once
#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../render/backend.hpp"
#include "../render/default_view.hpp"

namespace realcam::app {

/// The words of `render` as they were typed; empty: not given.
struct RenderWords {
    std::string scene, lens = "double-gauss-50mm", film, resolution, position, look_at, up = "0,1,0", focus, f_number,
                       exposure_time, iso = "100", model = "full", scale = "1", environment, tone = "film",
                       device = "auto";
    std::vector<std::string> outputs;
    int spp = 64, max_bounces = 1, threads = 0;
    std::uint32_t seed = 0;
};

void add_render_options(CLI::App& command, RenderWords& words);

/// What they mean, as far as it can be said before the scene is read.
struct RenderRequest {
    std::string scene, device, environment_file;
    std::vector<std::string> outputs;
    Camera camera;
    ViewRequest view;
    RenderSettings settings;
    ToneCurve tone = ToneCurve::film;
    double scale = 1;
    std::optional<double> environment_cd_m2;
    bool meters_exposure = false;
};

/// Reads the lens, and checks all that can be checked: nobody should wait for a picture and be told then.
/// Throws InputError, LensFileError and ImageFileError.
RenderRequest understand(const RenderWords& words);

}  // namespace realcam::app
