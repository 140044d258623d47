#include <pybind11/stl.h>

#include "../app/command_line.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

int run_command(std::vector<std::string> words) {
    words.insert(words.begin(), "realcam");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const Unlocked unlocked;
    return app::run_command_line(static_cast<int>(words.size()), pointers.data());
}

py::list listed_commands() {
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

// Words are bytes, as os.fsencode makes them.
void bind_command(py::module_& m) {
    m.def("_run_command", &run_command, "words"_a);
    m.def("_listed_commands", &listed_commands);
}

}  // namespace realcam::bindings
