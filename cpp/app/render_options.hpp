#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../shot/shot_file.hpp"
#include "lens_file_options.hpp"

namespace realcam::app {

/// Values of the options of the command `render`, as typed.
struct RenderOptions {
    std::string scene;            ///< scene file or shot file
    std::string device = "auto";  ///< see make_session
    shot::ShotChanges changes;  ///< overrides of the shot file's values
    bool denoises = false, keeps_noise = false;  ///< see ShotRequest
    std::vector<std::string> outputs;
    std::optional<std::string> frames;  ///< frame numbers of a video (frame_numbers); std::nullopt: a single picture
    double frames_per_second = 24;
    bool retakes_frames = false;  ///< --again: frames that already exist are taken again
    bool verbose = false, explains = false, as_json = false,
         is_quiet = false;  ///< --verbose, --explain, --json, --quiet
    LensFileOptions lens_file;
};

/// True if the output holds linear exposure (.exr), not developed 8-bit values for a screen.
bool is_exr(const std::string& path);

/// Adds the options for the scene, the camera and the picture.
void add_shot_options(CLI::App& command, RenderOptions& options);
/// Adds the options of add_shot_options, and those for the output.
void add_render_options(CLI::App& command, RenderOptions& options);

/// Builds the request from the options. If `scene` is a shot file, options override its values. Throws InputError that
/// names the option or file.
shot::ShotRequest request_from_options(const RenderOptions& options);

}  // namespace realcam::app
