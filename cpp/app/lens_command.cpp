#include "lens_command.hpp"

#include <cstdio>
#include <memory>

#include "../io/lens/lens_file.hpp"
#include "../io/text/json_writer.hpp"
#include "../io/text/printable.hpp"
#include "../optics/lens/rings.hpp"
#include "../shot/shot_keys.hpp"
#include "help.hpp"
#include "lens_file_options.hpp"
#include "lens_report.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

/// Values of the options of `lens info`, as typed; empty: not given.
struct InfoOptions {
    std::string lens;  ///< bundled lens or lens file
    std::string zoom, f_number, focus;
    LensFileOptions file;
    bool as_json = false;
};

void run_info(const InfoOptions& options) {
    Rings rings;
    if (!options.zoom.empty()) rings.zoom = options.zoom;
    if (!options.f_number.empty()) rings.f_number = parse_number("--f-number", options.f_number);
    if (!options.focus.empty()) rings.focus_distance = 1000 * parse_distance("--focus", options.focus);
    const LensSystem lens = with_rings(io::read_lens(options.lens, lens_options_of(options.file)), rings);
    std::fputs((options.as_json ? lens_as_json(lens) : lens_as_text(lens)).c_str(), stdout);
}

/// Prints names and titles of the bundled lenses, then names and files of those in the folders of the lens path.
void run_list(bool as_json, const std::vector<std::string>& folders) {
    set_lens_path(folders);
    io::JsonWriter json;
    json.begin_array();
    for (const std::string& name : io::lens_names()) {
        const LensSystem lens = io::read_lens(name);
        if (as_json) {
            json.begin_object().key("name").text(name).key("title").text(lens.title).end();
        } else {
            std::printf("%-32s %s\n", name.c_str(), lens.title.c_str());
        }
    }
    for (const auto& [name, path] : io::lens_files_on_path()) {
        const std::string shown = io::printable(name), file = io::printable(path);
        if (as_json)
            json.begin_object().key("name").text(shown).key("title").text(file).end();
        else
            std::printf("%-32s %s\n", shown.c_str(), file.c_str());
    }
    if (as_json) std::puts(json.end().finish().c_str());
}

}  // namespace

void add_lens_command(CLI::App& app) {
    CLI::App* lens = app.add_subcommand("lens", "Print data of lenses.");
    lens->require_subcommand(1);

    CLI::App* info = lens->add_subcommand("info", "Print a lens's table of surfaces and its first-order data.");
    const auto options = std::make_shared<InfoOptions>();
    info->add_option("LENS", options->lens,
                     "A bundled lens, or a lens file: .toml, .zmx, .seq, .len, .dat, .json, .roa")
        ->required()
        ->type_name("LENS");
    const auto add_ring = [info](const char* name, std::string& value) {
        const shot::ShotKey& key = shot::shot_key(name);
        info->add_option(key.option, value, key.text)->type_name(key.placeholder);
    };
    add_ring("f_number", options->f_number);
    add_ring("focus_m", options->focus);
    add_ring("zoom", options->zoom);
    add_lens_options(*info, options->file);
    info->add_flag("--json", options->as_json, "Print JSON; null stands for infinite, and for the radius of a plane");
    set_examples(*info, {
                            "realcam lens info tessar-50mm",
                            "realcam lens info double-gauss-50mm --f-number 8 --focus 2",
                            "realcam lens info my-lens.zmx --json",
                        });
    info->callback([options] { run_info(*options); });

    CLI::App* list = lens->add_subcommand("list", "List the bundled lenses, and those of the lens path.");
    const auto list_as_json = std::make_shared<bool>(false);
    list->add_flag("--json", *list_as_json, "Print JSON");
    set_examples(*list, {"realcam lens list", "realcam lens list --json"});
    const auto folders = std::make_shared<std::vector<std::string>>();
    add_lens_path_option(*list, *folders);
    list->callback([list_as_json, folders] { run_list(*list_as_json, *folders); });
}

}  // namespace realcam::app
