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
        "usage"_a, "description"_a, "sections"_a, "examples"_a);
    m.def("_did_you_mean", &io::did_you_mean, "name"_a, "candidates"_a);
}

}  // namespace realcam::bindings
