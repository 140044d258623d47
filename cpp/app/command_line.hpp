#pragma once
#include <string>
#include <vector>

namespace realcam::app {

class VideoWriter;

/// Option or positional argument of a command, as its help text lists it.
struct ListedOption {
    std::vector<std::string> names;  ///< "-o" and "--output"; empty for a positional argument
    std::string type;                ///< placeholder of the value, such as "FILE"; empty for a flag
    std::string help;
};
/// Command without subcommands, as its help text describes it.
struct ListedCommand {
    std::vector<std::string> words;  ///< the command's words, such as "lens" and "info"
    std::string description;
    std::vector<ListedOption> options;
};

/// All commands that run_command_line accepts.
std::vector<ListedCommand> listed_commands();

/// Runs the program `realcam` with the arguments of main. Returns the exit code; errors have been printed on stderr.
/// `video_writer`: null if this program writes no videos.
int run_command_line(int argc, char** argv, const VideoWriter* video_writer = nullptr);

}  // namespace realcam::app
