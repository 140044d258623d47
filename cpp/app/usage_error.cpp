#include "usage_error.hpp"

#include <array>
#include <utility>

#include "../io/text/nearest_names.hpp"
#include "help.hpp"

namespace realcam::app {
namespace {

/// The innermost command on the command line; the program itself if it names no command.
const CLI::App& typed_command(const CLI::App& app) {
    const std::vector<CLI::App*> typed = app.get_subcommands();
    return typed.empty() ? app : typed_command(*typed.back());
}

/// Long names only: a mistyped one-letter option could be any other one.
std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<std::string> command_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* other : command.get_subcommands({})) names.push_back(other->get_name());
    return names;
}

std::string with_commas(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// CLI11's message, reworded where the commands in Python use other words.
std::string said(const CLI::ParseError& error) {
    const std::string words = error.what();
    constexpr std::array<std::pair<const char*, const char*>, 3> kInPlaceOf{{
        {": At Most 1 required but received ", " is given more than once"},
        {": 1 required ", " wants a value"},
        {" was given a disallowed flag override", " takes no value"},
    }};
    for (const auto& [of_cli11, ours] : kInPlaceOf) {
        const std::size_t at = words.find(of_cli11);
        if (at == std::string::npos) continue;
        // If a flag has a value, CLI11 reports its name without dashes.
        const std::string dashes = words[0] == '-' ? "" : at == 1 ? "-" : "--";
        return dashes + words.substr(0, at) + ours;
    }
    return words;
}

std::string what_is_wrong(const CLI::App& command, const CLI::ParseError& error) {
    const std::vector<std::string> left = command.remaining(), commands = command_names(command);
    // Unknown options come before missing ones: a misspelt option is missing, too.
    for (const std::string& word : left) {
        if (word.size() < 2 || word[0] != '-') continue;
        const std::string option = word.substr(0, word.find('='));
        return "unknown option " + option + io::did_you_mean(option, option_names(command));
    }
    if (!commands.empty() && !left.empty())
        return "unknown command \"" + left.front() + '"' + io::did_you_mean(left.front(), commands);
    if (!commands.empty()) return "a command is missing; " + with_commas(commands) + " are known";
    if (!left.empty()) return "unexpected argument \"" + left.front() + '"';
    return said(error);
}

}  // namespace

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = typed_command(app);
    return what_is_wrong(command, error) + " (" + path_of(command) + " --help lists the " +
           (command_names(command).empty() ? "options)" : "commands)");
}

}  // namespace realcam::app
