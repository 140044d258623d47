#include "help.hpp"

#include <memory>
#include <sstream>
#include <utility>

#include "../io/text/help_page.hpp"

namespace realcam::app {
namespace {

/// Names of an option with the placeholder of its value, and its description.
using HelpRow = std::pair<std::string, std::string>;

HelpRow row_of(const CLI::Option& option) {
    const std::string names = CLI::detail::join(names_of(option), ", "), type = type_of(option);
    return {names + (names.empty() || type.empty() ? "" : " ") + type,
            option.get_description() + (option.get_required() ? " [required]" : "")};
}

/// Help of a command: its arguments, its options by group, its subcommands, and examples.
io::HelpPage page_of(const CLI::App& command) {
    io::HelpPage page{path_of(command) + " [OPTIONS]", command.get_description(), {{"Arguments", {}}}, {}};
    for (const CLI::Option* option : command.get_options()) {
        if (option->nonpositional()) continue;
        page.usage += ' ' + option->get_type_name();
        page.sections.front().rows.push_back(row_of(*option));
    }
    const HelpRow help = row_of(*command.get_help_ptr());
    for (const std::string& group : command.get_groups()) {
        if (group.empty()) continue;  // of hidden options
        io::HelpPage::Section section{group, {}};
        for (const CLI::Option* option : command.get_options())
            if (option->nonpositional() && option->get_group() == group && option != command.get_help_ptr())
                section.rows.push_back(row_of(*option));
        if (group == command.get_help_ptr()->get_group()) section.rows.push_back(help);
        page.sections.push_back(std::move(section));
    }
    io::HelpPage::Section commands{"Commands", {}};
    for (const CLI::App* subcommand : command.get_subcommands({}))
        commands.rows.emplace_back(subcommand->get_name(), subcommand->get_description());
    if (!commands.rows.empty()) page.usage += " COMMAND [ARGS]...";
    page.sections.push_back(std::move(commands));
    std::istringstream examples(command.get_footer());
    for (std::string line; std::getline(examples, line);) page.examples.push_back(line);
    return page;
}

}  // namespace

void set_help(CLI::App& app) {
    app.set_help_flag("-h,--help", "Show this message and exit");
    app.formatter_fn(
        [](const CLI::App* command, const std::string&, CLI::AppFormatMode) { return io::text_of(page_of(*command)); });
}

void set_examples(CLI::App& command, const std::vector<std::string>& examples) {
    command.footer(CLI::detail::join(examples, "\n"));
}

std::string path_of(const CLI::App& command) {
    const CLI::App* parent = command.get_parent();
    return (parent ? path_of(*parent) + ' ' : "") + command.get_name();
}

std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back('-' + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

std::string type_of(const CLI::Option& option) {
    return option.get_items_expected_max() > 0 ? option.get_type_name() : "";
}

}  // namespace realcam::app
