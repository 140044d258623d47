#pragma once

namespace realcam::app {

/// The program: `argv` as main gets it. Returns the exit code; whatever goes wrong has been told on stderr.
int run_command_line(int argc, char** argv);

}  // namespace realcam::app
