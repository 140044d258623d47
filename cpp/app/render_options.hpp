#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "../shot/shot_file.hpp"
#include "lens_words.hpp"

namespace realcam::app {

/// What was typed behind `render`.
struct RenderWords {
    std::string scene, device = "auto";
    shot::ShotChanges changes;  ///< to what the shot file says
    bool denoises = false, keeps_noise = false;  ///< see ShotRequest
    std::vector<std::string> outputs;
    std::optional<std::string> frames;  ///< of a film; none: a single picture
    double frames_per_second = 24;
    bool takes_again = false;  ///< frames that are there, too
    bool verbose = false, explains = false, as_json = false, is_quiet = false;
    LensWords lens_file;
};

/// Whether the file holds linear exposure (.exr), and not developed codes for a screen.
bool is_exr(const std::string& path);

/// Those that say what is photographed and how.
void add_shot_options(CLI::App& command, RenderWords& words);
/// The same, and what to write.
void add_render_options(CLI::App& command, RenderWords& words);

/// What they mean: those of the shot file, if `scene` is one, with typed values instead of those in the file.
/// Throws InputError that names option or file.
shot::ShotRequest understand(const RenderWords& words);

}  // namespace realcam::app
