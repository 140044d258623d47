#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../shot/shot_file.hpp"
#include "lens_words.hpp"

namespace realcam::app {

/// Options of the command `render`.
struct RenderWords {
    std::string scene, device = "auto";
    shot::ShotChanges changes;  ///< overrides of the shot file's values
    bool denoises = false, keeps_noise = false;  ///< see ShotRequest
    std::vector<std::string> outputs;
    std::optional<std::string> frames;  ///< frames of a film; std::nullopt for a single picture
    double frames_per_second = 24;
    bool takes_again = false;  ///< takes frames that already exist again
    bool verbose = false, explains = false, as_json = false, is_quiet = false;
    LensWords lens_file;
};

/// True if the file holds linear exposure (.exr), not developed 8-bit values for a screen.
bool is_exr(const std::string& path);

/// Adds the options for what is photographed and how.
void add_shot_options(CLI::App& command, RenderWords& words);
/// Adds the shot options and those for the output.
void add_render_options(CLI::App& command, RenderWords& words);

/// Builds the request from the options. If `scene` is a shot file, options override its values. Throws InputError that
/// names the option or file.
shot::ShotRequest understand(const RenderWords& words);

}  // namespace realcam::app
