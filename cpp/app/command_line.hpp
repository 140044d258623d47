#pragma once
#include <string>
#include <vector>

namespace realcam::app {

class FilmWriter;

struct ListedOption {
    std::vector<std::string> names;  ///< "-o" and "--output"; of an argument none
    std::string type;                ///< "FILE"; of a flag empty
    std::string help;
};
struct ListedCommand {
    std::vector<std::string> words;  ///< "lens" and "info"
    std::string description;
    std::vector<ListedOption> options;
};

/// All commands that run_command_line takes.
std::vector<ListedCommand> listed_commands();

/// The program: `argv` as main gets it. Returns the exit code; whatever goes wrong has been told on stderr.
/// film_writer: null where there is none.
int run_command_line(int argc, char** argv, const FilmWriter* film_writer = nullptr);

}  // namespace realcam::app
