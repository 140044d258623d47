// Help texts that the commands in Python share with those in C++.

#include <pybind11/stl.h>

#include "../io/text/help_page.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

void bind_help(py::module_& m) {
    using Rows = std::vector<std::pair<std::string, std::string>>;
    m.def(
        "_help_text",
        [](const std::string& usage, const std::string& description,
           const std::vector<std::pair<std::string, Rows>>& sections, const std::vector<std::string>& examples) {
            io::HelpPage page{usage, description, {}, examples};
            for (const auto& [title, rows] : sections) page.sections.push_back({title, rows});
            return io::text_of(page);
        },
        "usage"_a, "description"_a, "sections"_a, "examples"_a,
        "Internal. Returns a command's help page. sections: list of (title, list of (option or command, help text)).");
    m.def("_did_you_mean", &io::did_you_mean, "name"_a, "candidates"_a,
          "Internal. Returns the end of an error message that suggests the candidates most similar to a name; empty if "
          "no candidate is similar.");
}

}  // namespace realcam::bindings
