#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <new>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "../cuda/device/cuda_devices.hpp"
#include "../devices/devices.hpp"
#include "../io/text/help_page.hpp"
#include "../io/text/json_writer.hpp"
#include "../io/text/printable.hpp"
#include "help.hpp"
#include "lens_command.hpp"
#include "lens_file_options.hpp"
#include "render_command.hpp"

namespace realcam::app {

namespace {

/// The innermost subcommand that the user has typed; the program itself if it names no command.
const CLI::App& invoked_command(const CLI::App& app) {
    const std::vector<CLI::App*> invoked = app.get_subcommands();
    return invoked.empty() ? app : invoked_command(*invoked.back());
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

std::string joined_with_commas(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// CLI11's message, rephrased where the commands in Python phrase it differently.
std::string rephrased(const CLI::ParseError& error) {
    const std::string words = error.what();
    constexpr std::array<std::pair<const char*, const char*>, 3> kRephrasings{{
        {": At Most 1 required but received ", " is specified more than once"},
        {": 1 required ", " requires a value"},
        {" was given a disallowed flag override", " takes no value"},
    }};
    for (const auto& [cli11_text, our_text] : kRephrasings) {
        const std::size_t at = words.find(cli11_text);
        if (at == std::string::npos) continue;
        // If a flag was given a value, CLI11 reports the flag's name without dashes.
        const std::string dashes = words[0] == '-' ? "" : at == 1 ? "-" : "--";
        return dashes + words.substr(0, at) + our_text;
    }
    return words;
}

/// Describes the error without the reference to --help. `command`: the invoked one.
std::string error_text(const CLI::App& command, const CLI::ParseError& error) {
    const std::vector<std::string> unparsed = command.remaining(), commands = command_names(command);
    // Unknown options come before missing ones: a misspelt option is missing, too.
    for (const std::string& word : unparsed) {
        if (word.size() < 2 || word[0] != '-') continue;
        const std::string option = word.substr(0, word.find('='));
        return "unknown option " + option + io::did_you_mean(option, option_names(command));
    }
    if (!commands.empty() && !unparsed.empty())
        return "unknown command \"" + unparsed.front() + '"' + io::did_you_mean(unparsed.front(), commands);
    if (!commands.empty()) return "a command is missing; " + joined_with_commas(commands) + " are known";
    if (!unparsed.empty()) return "unexpected argument \"" + unparsed.front() + '"';
    return rephrased(error);
}

/// Describes an error of the command line: an unknown option or command with the nearest known name, or CLI11's own
/// message; then names the command whose --help lists the options. `app`: the program's, after it has thrown `error`.
std::string usage_message(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = invoked_command(app);
    return error_text(command, error) + " (" + path_of(command) + " --help lists the " +
           (command_names(command).empty() ? "options)" : "commands)");
}

/// Prints the devices of this machine, the CPU first, and on stderr the reason if no GPU can be used.
void list_devices(bool as_json) {
    const std::vector<Device> found = devices();
    if (!as_json) {
        for (const Device& device : found) std::printf("%-7s %s\n", device.name.c_str(), device.description.c_str());
        std::fflush(stdout);
        if (const std::string why = why_no_cuda_device(); !why.empty())
            std::fprintf(stderr, "realcam: no GPU: %s\n", io::one_line(why).c_str());
        return;
    }
    io::JsonWriter json;
    json.begin_array();
    for (const Device& device : found)
        json.begin_object().key("device").text(device.name).key("name").text(device.description).end();
    json.end();
    std::puts(json.finish().c_str());
}

constexpr int kFailure = 2;  // exit code

/// Prints an error, and returns the exit code.
int fail(const std::string& message) {
    std::fprintf(stderr, "realcam: error: %s\n", io::one_line(message).c_str());
    return kFailure;
}

/// Adds the commands to `app` in place, because CLI11's objects can be neither copied nor moved.
void set_up(CLI::App& app, const VideoWriter* video_writer = nullptr) {
    app.name("realcam");
    app.description("Photographs 3D scenes through real lenses.");
    app.option_defaults()->disable_flag_override();
    set_help(app);
    app.set_version_flag("--version", "realcam " REALCAM_VERSION, "Print the version");
    app.require_subcommand(1);
    add_render_command(app, video_writer);
    add_plan_command(app);
    add_lens_command(app);
    CLI::App* devices = app.add_subcommand("devices", "List the devices of this machine for rendering.");
    const auto as_json = std::make_shared<bool>(false);
    devices->add_flag("--json", *as_json, "Print JSON");
    set_examples(*devices, {"realcam devices", "realcam devices --json"});
    devices->callback([as_json] { list_devices(*as_json); });
}

/// Appends all commands below `command` that have no subcommands. `words`: the words that lead to `command`.
void collect_commands(const CLI::App& command, std::vector<std::string> words, std::vector<ListedCommand>& listed) {
    const std::vector<const CLI::App*> subcommands = command.get_subcommands({});
    for (const CLI::App* subcommand : subcommands) {
        words.push_back(subcommand->get_name());
        collect_commands(*subcommand, words, listed);
        words.pop_back();
    }
    if (!subcommands.empty()) return;
    ListedCommand& entry = listed.emplace_back(ListedCommand{words, command.get_description(), {}});
    for (const CLI::Option* option : command.get_options())
        if (option != command.get_help_ptr())
            entry.options.push_back({names_of(*option), type_of(*option), option->get_description()});
}

/// Returns the arguments in reverse order, as CLI11 expects them. An option with an empty value, such as "--frames=",
/// becomes two words, because CLI11 would take the next word as its value.
std::vector<std::string> reversed_words(int argc, char** argv) {
    std::vector<std::string> words;
    bool has_options = true;  // up to "--"
    for (int i = 1; i < argc; ++i) {
        std::string word = argv[i];
        has_options = has_options && word != "--";
        const bool is_empty_option = has_options && word.starts_with("--") && word.find('=') == word.size() - 1;
        if (is_empty_option) word.pop_back();
        words.push_back(std::move(word));
        if (is_empty_option) words.emplace_back();
    }
    std::reverse(words.begin(), words.end());
    return words;
}

/// Parses the arguments and runs the command. Returns the exit code; errors of the command are thrown.
int run(int argc, char** argv, const VideoWriter* video_writer) {
    CLI::App app;
    set_up(app, video_writer);
    if (argc == 1) {
        std::fputs(app.help().c_str(), stdout);
        return 0;
    }
    try {
        app.parse(reversed_words(argc, argv));
        return std::fflush(stdout) == 0 ? 0 : fail("the standard output cannot be written to");
    } catch (const CLI::Success& success) {  // --help and --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return fail(usage_message(app, error));
    }
}

}  // namespace

std::vector<ListedCommand> listed_commands() {
    CLI::App app;
    set_up(app);
    std::vector<ListedCommand> listed;
    collect_commands(app, {}, listed);
    return listed;
}

int run_command_line(int argc, char** argv, const VideoWriter* video_writer) {
    try {
        return run(argc, argv, video_writer);
    } catch (const Interrupted& interrupted) {
        std::fprintf(stderr, "realcam: stopped%s\n", interrupted.remark.c_str());
        return 128 + interrupted.signal;
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const io::LensReadError& error) {
        return fail(error.what() + advice_on(error));
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}

}  // namespace realcam::app
