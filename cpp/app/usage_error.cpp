#include "usage_error.hpp"

#include "../io/text/nearest_names.hpp"

namespace realcam::app {
namespace {

/// The command that was typed, as far as there is one.
const CLI::App& typed_command(const CLI::App& app) {
    const std::vector<CLI::App*> typed = app.get_subcommands();
    return typed.empty() ? app : typed_command(*typed.back());
}

std::string path_of(const CLI::App& command) {
    const CLI::App* parent = command.get_parent();
    return (parent ? path_of(*parent) + ' ' : "") + command.get_name();
}

/// Long names: who mistypes one letter means anything.
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

std::string what_is_wrong(const CLI::App& command, const CLI::ParseError& error) {
    const std::vector<std::string> left = command.remaining(), commands = command_names(command);
    // Before what is missing: a misspelt option is missing, too.
    for (const std::string& word : left) {
        if (word.size() < 2 || word[0] != '-') continue;
        const std::string option = word.substr(0, word.find('='));
        return "unknown option " + option + io::did_you_mean(option, option_names(command));
    }
    if (!commands.empty() && !left.empty())
        return "unknown command \"" + left.front() + '"' + io::did_you_mean(left.front(), commands);
    if (!commands.empty()) return "a command is missing; " + with_commas(commands) + " are known";
    const std::string words = error.what();
    const std::size_t twice = words.find(": At Most 1 required but received ");
    return twice == std::string::npos ? words : words.substr(0, twice) + " is given more than once";
}

}  // namespace

std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = typed_command(app);
    return what_is_wrong(command, error) + " (" + path_of(command) + " --help lists the " +
           (command_names(command).empty() ? "options)" : "commands)");
}

}  // namespace realcam::app
