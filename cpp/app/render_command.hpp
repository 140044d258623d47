#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

class FilmWriter;

/// Adds `render`, which throws Interrupted if a signal stopped it. `film_writer`: null if this program writes no
/// videos; the pointer is kept.
void add_render_command(CLI::App& app, const FilmWriter* film_writer);
/// Adds `plan`, which plans a shot without rendering it.
void add_plan_command(CLI::App& app);

struct Interrupted {
    int signal;
    std::string remark;  ///< work done before the signal; printed after "stopped"
};

}  // namespace realcam::app
