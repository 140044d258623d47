// The command line in C++, run from Python's command `realcam`.

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include "../app/command_line.hpp"
#include "../app/outputs.hpp"
#include "../error.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Film writer that calls realcam.video.
class VideoWriterInPython : public app::VideoWriter {
public:
    void check(const std::string& film) const override {
        const py::gil_scoped_acquire locked;
        call("check_film", text_from(film));
    }

    void write(const std::string& film, const std::vector<std::string>& pictures, double frames_per_second,
               const KeepGoing& keep_going) const override {
        const py::gil_scoped_acquire locked;
        py::list names;
        for (const std::string& picture : pictures) names.append(text_from(picture));
        call("write_film", text_from(film), names, frames_per_second, keep_going);
    }

private:
    template <class... Arguments>
    static void call(const char* function, const Arguments&... arguments) {
        try {
            py::module_::import("realcam.video").attr(function)(arguments...);
        } catch (py::error_already_set& error) {
            if (error.matches(py::module_::import("realcam").attr("Cancelled"))) throw Cancelled();
            throw Error(path_from(py::str(error.value())));
        }
    }
};

/// Runs a command and returns its exit status. `words`: arguments behind "realcam" on the command line.
int run_command(const Typed<"list[bytes]", py::list>& words) {
    auto arguments = words.cast<std::vector<std::string>>();
    arguments.insert(arguments.begin(), "realcam");
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const VideoWriterInPython film_writer;
    const Unlocked unlocked;
    return app::run_command_line(static_cast<int>(arguments.size()), pointers.data(), &film_writer);
}

Typed<"list[tuple[list[str], str, list[tuple[list[str], str, str]]]]", py::list> listed_commands() {
    py::list commands;
    for (const app::ListedCommand& command : app::listed_commands()) {
        py::list options;
        for (const app::ListedOption& option : command.options)
            options.append(py::make_tuple(option.names, option.type, option.help));
        commands.append(py::make_tuple(command.words, command.description, options));
    }
    return commands;
}

}  // namespace

void bind_command(py::module_& m) {
    m.def("_run_command", &run_command, "words"_a,
          "Internal. Runs a command and returns its exit status. words: arguments behind \"realcam\", by os.fsencode.");
    m.def("_listed_commands", &listed_commands,
          "Internal. Returns all commands in C++ as (words, description, options); an option is (names, type, help).");
}

}  // namespace realcam::bindings
