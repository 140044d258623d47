#pragma once
#include <string>
#include <vector>

namespace realcam::app {

class FilmWriter;

struct ListedOption {
    std::vector<std::string> names;  ///< "-o" and "--output"; empty for a positional argument
    std::string type;                ///< "FILE"; empty for a flag
    std::string help;
};
struct ListedCommand {
    std::vector<std::string> words;  ///< "lens" and "info"
    std::string description;
    std::vector<ListedOption> options;
};

/// All commands that run_command_line accepts.
std::vector<ListedCommand> listed_commands();

/// Runs the program with main's arguments. Returns the exit code; errors have been printed on stderr. `film_writer`:
/// null if this program writes no videos.
int run_command_line(int argc, char** argv, const FilmWriter* film_writer = nullptr);

}  // namespace realcam::app
