#include "lens_file_options.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "../io/lens/lens_format.hpp"
#include "../io/text/printable.hpp"

namespace realcam::app {

void add_lens_path_option(CLI::App& command, std::vector<std::string>& folders) {
    command
        .add_option("--lens-path", folders,
                    "Folder in which lenses are found by name; may be repeated [REALCAM_LENS_PATH]")
        ->type_name("DIR")
        ->allow_extra_args(false);
}

void set_lens_path(const std::vector<std::string>& folders) {
    if (folders.empty()) return;
    std::string path;
    for (const std::string& folder : folders) {
        if (!std::filesystem::is_directory(folder)) throw InputError("--lens-path: " + folder + " is not a folder");
        path += folder + ':';
    }
    if (const char* inherited = std::getenv("REALCAM_LENS_PATH")) path += inherited;
    setenv("REALCAM_LENS_PATH", path.c_str(), 1);
}

void add_lens_options(CLI::App& command, LensFileOptions& values) {
    command
        .add_option(
            "--glass", values.glasses,
            "Definition of a glass in the lens file that no catalogue, or more than one, contains: NAME=n_d,V_d "
            "or NAME=schott:F4; may be repeated")
        ->type_name("NAME=N,V")
        ->allow_extra_args(false);
    command
        .add_option("--glass-catalogue", values.catalogues,
                    "Glass catalogue (.agf) that takes precedence over the bundled ones; may be repeated")
        ->type_name("FILE")
        ->allow_extra_args(false);
    add_lens_path_option(command, values.folders);
    command.add_flag("--force", values.force, "Ignore unsupported features of the lens file, with a warning");
    command
        .add_option(
            "--pbrt-thickness", values.pbrt_thickness,
            "Whether a thickness in a .dat file lies after or before the surface of its row [detected from the first "
            "row]")
        ->type_name("WHERE");
}

std::string advice_on(const io::LensReadError& error) {
    if (error.can_be_forced) return "; --force reads it all the same";
    if (error.glass.empty()) return "";
    return "; --glass " + error.glass + '=' + (error.candidate.empty() ? "n_d,V_d" : error.candidate) + " names it";
}

io::LensReadOptions lens_options_of(const LensFileOptions& values) {
    io::LensReadOptions options;
    for (const std::string& text : values.glasses) {
        const auto [name, glass] = [&] {
            try {
                return io::named_glass(text);
            } catch (const InputError& error) {
                throw InputError(std::string("--glass: ") + error.what());
            }
        }();
        if (!options.glasses.emplace(name, glass).second)
            throw InputError("--glass: the glass \"" + name + "\" is specified twice");
    }
    set_lens_path(values.folders);
    for (const std::string& file : values.catalogues) io::read_glass_catalogue(file, options.catalogue);
    options.force = values.force;
    if (!values.pbrt_thickness.empty()) options.pbrt_thickness = io::pbrt_thickness_named(values.pbrt_thickness);
    options.warn = [](const std::string& message) {
        std::fprintf(stderr, "realcam: warning: %s\n", io::one_line(message).c_str());
    };
    return options;
}

}  // namespace realcam::app
