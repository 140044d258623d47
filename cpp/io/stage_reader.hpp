#pragma once
// Stages of USD (.usd, .usda, .usdc, .usdz). Only the Python package reads them, with the package usd-core; it
// registers its functions here when its extension is loaded. The executable has none.

#include <functional>
#include <string>

#include "../scene/assembly.hpp"
#include "scene_file.hpp"

namespace realcam::io {

/// Functions that read USD stages.
struct StageReader {
    /// Reads a stage as read_scene does.
    std::function<Assembly(const std::string& path, const SceneFileOptions& options)> scene;
    /// Returns the settings of a stage's camera, as TOML with keys of shot files; paths are absolute. A further key,
    /// focus_is_to_pupil = true, says that focus distances are measured to the entrance pupil of the shot's lens.
    /// `camera`: its name; empty: the first perspective camera. Without such a camera the text is empty.
    std::function<std::string(const std::string& path, const SceneFileOptions& options, const std::string& camera)>
        camera_settings;
};

/// True if the suffix of a file is that of a USD stage.
bool is_stage(const std::string& path);

/// True if functions that read stages are registered.
bool has_stage_reader();

/// Returns the registered functions. Throws SceneFileError, which names the stage, if there are none.
const StageReader& stage_reader(const std::string& path);

/// Registers the functions that read stages. Call it before any scene is read.
void set_stage_reader(StageReader reader);

}  // namespace realcam::io
