#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace realcam::app {

class FilmWriter;

/// Adds `render`. It throws Interrupted where a signal stopped it. film_writer: null where there is none; the pointer
/// is kept.
void add_render_command(CLI::App& app, const FilmWriter* film_writer);
/// Adds `plan`, which looks at a shot and renders nothing.
void add_plan_command(CLI::App& app);

struct Interrupted {
    int signal;
    std::string remark;  ///< what was done before, to follow on "stopped"
};

}  // namespace realcam::app
