#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace realcam::app {

/// Has the help of the program, and of all commands that are added afterwards, printed by io::text_of.
void set_help(CLI::App& app);

/// Command lines that the help of a command shows at its end.
void set_examples(CLI::App& command, const std::vector<std::string>& examples);

/// The words that call it: "realcam lens info".
std::string path_of(const CLI::App& command);

/// "-o" and "--output"; of an argument none.
std::vector<std::string> names_of(const CLI::Option& option);

/// "FILE"; empty for a flag, whose type of CLI11 nobody gives.
std::string type_of(const CLI::Option& option);

}  // namespace realcam::app
