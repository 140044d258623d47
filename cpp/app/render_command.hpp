#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

/// Adds `render`. It throws Interrupted where a signal stopped it.
void add_render_command(CLI::App& app);
/// Adds `plan`, which looks at a shot and renders nothing.
void add_plan_command(CLI::App& app);

struct Interrupted {
    int signal;
    std::string remark;  ///< what was done before, to follow on "stopped"
};

}  // namespace realcam::app
