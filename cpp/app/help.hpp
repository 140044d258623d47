#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace realcam::app {

/// Prints the help of the program, and of all commands that are added afterwards, through io::text_of.
void set_help(CLI::App& app);

/// Sets the example command lines at the end of a command's help.
void set_examples(CLI::App& command, const std::vector<std::string>& examples);

/// Full name of a command: "realcam lens info".
std::string path_of(const CLI::App& command);

/// "-o" and "--output"; empty for a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// "FILE"; empty for a flag.
std::string type_of(const CLI::Option& option);

}  // namespace realcam::app
