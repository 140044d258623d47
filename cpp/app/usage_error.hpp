#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

/// Describes an error of the command line: an unknown option or command with the nearest known name, or CLI11's own
/// message; and where the options are listed. `app`: the program's, after it has thrown `error`.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace realcam::app
