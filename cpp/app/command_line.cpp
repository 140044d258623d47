#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <new>

#include "../io/text/one_line.hpp"
#include "devices.hpp"
#include "help.hpp"
#include "lens_command.hpp"
#include "lens_words.hpp"
#include "render_command.hpp"
#include "usage_error.hpp"

namespace realcam::app {
namespace {

constexpr int kFailure = 2;

int fail(const std::string& message) {
    std::fprintf(stderr, "realcam: error: %s\n", io::one_line(message).c_str());
    return kFailure;
}

/// Adds the commands to `app` in place, because CLI11's objects can be neither copied nor moved.
void set_up(CLI::App& app, const FilmWriter* film_writer = nullptr) {
    app.name("realcam");
    app.description("Photographs 3D scenes through real lenses.");
    app.option_defaults()->disable_flag_override();
    set_help(app);
    app.set_version_flag("--version", "realcam " REALCAM_VERSION, "Print the version");
    app.require_subcommand(1);
    add_render_command(app, film_writer);
    add_plan_command(app);
    add_lens_command(app);
    CLI::App* devices = app.add_subcommand("devices", "List what this machine can render with.");
    const auto as_json = std::make_shared<bool>(false);
    devices->add_flag("--json", *as_json, "Print JSON");
    set_examples(*devices, {"realcam devices", "realcam devices --json"});
    devices->callback([as_json] { list_devices(*as_json); });
}

void list(const CLI::App& command, std::vector<std::string> words, std::vector<ListedCommand>& listed) {
    const std::vector<const CLI::App*> below = command.get_subcommands({});
    for (const CLI::App* one : below) {
        words.push_back(one->get_name());
        list(*one, words, listed);
        words.pop_back();
    }
    if (!below.empty()) return;
    ListedCommand& entry = listed.emplace_back(ListedCommand{words, command.get_description(), {}});
    for (const CLI::Option* option : command.get_options())
        if (option != command.get_help_ptr())
            entry.options.push_back({names_of(*option), type_of(*option), option->get_description()});
}

int run(int argc, char** argv, const FilmWriter* film_writer) {
    CLI::App app;
    set_up(app, film_writer);
    if (argc == 1) {
        std::fputs(app.help().c_str(), stdout);
        return 0;
    }
    try {
        app.parse(argc, argv);
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
    list(app, {}, listed);
    return listed;
}

int run_command_line(int argc, char** argv, const FilmWriter* film_writer) {
    try {
        return run(argc, argv, film_writer);
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
