#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

/// What is wrong with the command line, and the nearest to it that is not: a misspelt option or command, or CLI11's own
/// words; and where the options stand. `app`: the program's, after it has thrown `error`.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error);

}  // namespace realcam::app
