#include "lens_words.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "../io/lens/lens_format.hpp"
#include "../io/text/printable.hpp"

namespace realcam::app {

void add_lens_path_option(CLI::App& command, std::vector<std::string>& folders) {
    command
        .add_option("--lens-path", folders,
                    "A folder whose lens files are known by their names; may be repeated [REALCAM_LENS_PATH]")
        ->type_name("DIR")
        ->allow_extra_args(false);
}

void set_lens_path(const std::vector<std::string>& folders) {
    if (folders.empty()) return;
    std::string path;
    for (const std::string& folder : folders) {
        if (!std::filesystem::is_directory(folder)) throw InputError("--lens-path: " + folder + " is no folder");
        path += folder + ':';
    }
    if (const char* before = std::getenv("REALCAM_LENS_PATH")) path += before;
    setenv("REALCAM_LENS_PATH", path.c_str(), 1);
}

void add_lens_options(CLI::App& command, LensWords& words) {
    command
        .add_option("--glass", words.glasses,
                    "A glass that the lens's file names and no catalogue has, or several: by n_d and V_d, or as "
                    "NAME=schott:F4; may be repeated")
        ->type_name("NAME=N,V")
        ->allow_extra_args(false);
    command
        .add_option("--glass-catalogue", words.catalogues,
                    "A catalogue of glasses (.agf) for those that the lens's file names; may be repeated")
        ->type_name("FILE")
        ->allow_extra_args(false);
    add_lens_path_option(command, words.folders);
    command.add_flag("--force", words.force,
                     "Leave out what the lens's file has that there is no model of, and name it");
    command
        .add_option(
            "--pbrt-thickness", words.pbrt_thickness,
            "Where a thickness in a .dat file stands: after or before the surface of its row [by the first row]")
        ->type_name("WHERE");
}

std::string advice_on(const io::LensReadError& error) {
    if (error.can_be_forced) return "; --force reads it all the same";
    if (error.glass.empty()) return "";
    return "; --glass " + error.glass + '=' + (error.candidate.empty() ? "n_d,V_d" : error.candidate) + " names it";
}

io::LensReadOptions lens_options_of(const LensWords& words) {
    io::LensReadOptions options;
    for (const std::string& text : words.glasses) {
        const auto [name, glass] = [&] {
            try {
                return io::named_glass(text);
            } catch (const InputError& error) {
                throw InputError(std::string("--glass: ") + error.what());
            }
        }();
        if (!options.glasses.emplace(name, glass).second)
            throw InputError("--glass: the glass \"" + name + "\" is given twice");
    }
    set_lens_path(words.folders);
    for (const std::string& file : words.catalogues) io::read_glass_catalogue(file, options.catalogue);
    options.force = words.force;
    if (!words.pbrt_thickness.empty()) options.pbrt_thickness = io::pbrt_thickness_named(words.pbrt_thickness);
    options.warn = [](const std::string& message) {
        std::fprintf(stderr, "realcam: warning: %s\n", io::one_line(message).c_str());
    };
    return options;
}

}  // namespace realcam::app
