#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace realcam::io {

/// Returns " (did you mean \"a\" or \"b\"?)" with up to three candidates that are closest to a misspelt name; empty if
/// no candidate is close, for names of more than 64 bytes, and for more than 10,000 candidates.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

/// Content of a command's --help.
struct HelpPage {
    /// Group of options, or the list of subcommands.
    struct Section {
        std::string title;
        std::vector<std::pair<std::string, std::string>> rows;  ///< an option or a command, and its description
    };

    std::string usage;  ///< usage line: "realcam lens info [OPTIONS] LENS"
    std::string description;  ///< paragraphs with an empty line between them
    std::vector<Section> sections;
    std::vector<std::string> examples;  ///< command lines
};

/// Formats a page in lines of at most 80 columns; longer words stand on a line of their own.
std::string text_of(const HelpPage& page);

}  // namespace realcam::io
