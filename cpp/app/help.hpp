#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace realcam::app {

/// Adds --help to the program and to all commands that are added afterwards, formatted by io::text_of.
void set_help(CLI::App& app);

/// Sets the example command lines that end a command's help.
void set_examples(CLI::App& command, const std::vector<std::string>& examples);

/// Full name of a command, such as "realcam lens info".
std::string path_of(const CLI::App& command);

/// Names of an option, such as "-o" and "--output"; empty for a positional argument.
std::vector<std::string> names_of(const CLI::Option& option);

/// Placeholder of an option's value, such as "FILE"; empty for a flag.
std::string type_of(const CLI::Option& option);

}  // namespace realcam::app
