#include "lens_words.hpp"

#include <cstdio>

#include "../io/lens/lens_format.hpp"
#include "../io/text/one_line.hpp"

namespace realcam::app {

void add_lens_options(CLI::App& command, LensWords& words) {
    command
        .add_option("--zoom", words.zoom,
                    "Zoom position, by its name in `realcam lens info` [as the lens's file gives it]")
        ->type_name("NAME");
    command
        .add_option("--glass", words.glasses,
                    "A glass that the lens's file names and no catalogue has, or several: by n_d and V_d, or as "
                    "NAME=schott:F4; may be repeated")
        ->type_name("NAME=N,V")
        ->allow_extra_args(false);
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
    options.force = words.force;
    if (!words.pbrt_thickness.empty()) options.pbrt_thickness = io::pbrt_thickness_named(words.pbrt_thickness);
    options.warn = [](const std::string& message) {
        std::fprintf(stderr, "realcam: warning: %s\n", io::one_line(message).c_str());
    };
    return options;
}

}  // namespace realcam::app
