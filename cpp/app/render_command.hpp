#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

class VideoWriter;

/// Adds `render`, which throws Interrupted if a signal stopped it. `video_writer`: null if this program writes no
/// videos; the pointer is kept.
void add_render_command(CLI::App& app, const VideoWriter* video_writer);
/// Adds `plan`, which plans a shot without rendering it.
void add_plan_command(CLI::App& app);

/// Thrown by the callback of `render` after Ctrl-C or SIGTERM.
struct Interrupted {
    int signal;  ///< number of the signal: SIGINT or SIGTERM
    std::string remark;  ///< names the files written before the signal; printed after "stopped"
};

}  // namespace realcam::app
