#pragma once
#include <CLI/CLI.hpp>

namespace realcam::app {

/// Adds the commands `lens info` and `lens list`.
void add_lens_command(CLI::App& app);

}  // namespace realcam::app
