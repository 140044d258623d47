#pragma once
#include <CLI/CLI.hpp>

namespace realcam::app {

/// Adds `render`. It throws Interrupted where a signal stopped it.
void add_render_command(CLI::App& app);

struct Interrupted {
    int signal;
};

}  // namespace realcam::app
