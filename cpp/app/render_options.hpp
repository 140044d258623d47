#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../plan/plan.hpp"
#include "../shot/shot_request.hpp"
#include "lens_words.hpp"

namespace realcam::app {

/// The words of `render` as they were typed; empty: not given.
struct RenderWords {
    std::string scene, lens, film, film_shift, resolution, camera, position, look_at, up, focus, f_number, blades,
        blade_rounding, blade_rotation, exposure_time, shutter_opens, readout_time, iso, model, scale, environment,
        environment_scale, environment_rotation, tone, spp, noise, noise_codes, seconds, max_spp, seed, max_bounces,
        transport, clamp, threads, layers, effects, quality, threshold_px, threshold_codes, illuminant, device = "auto";
    std::vector<std::string> outputs;
    bool verbose = false, explains = false, as_json = false;
    LensWords lens_file;
};

/// Those that say what is photographed and how.
void add_shot_options(CLI::App& command, RenderWords& words);
/// The same, and what to write.
void add_render_options(CLI::App& command, RenderWords& words);

/// Of what a plan leaves out. Throws InputError.
PlanThresholds thresholds_of(const RenderWords& words);

/// What they mean: those of the shot file, if `scene` is one, with typed values instead of those in the file.
/// Throws InputError that names option or file.
shot::ShotRequest understand(const RenderWords& words);

}  // namespace realcam::app
