// Reads TOML files for the Python part of the package, with the parser of the C++ core.

#include <algorithm>
#include <utility>
#include <vector>

#include "../io/text/toml_document.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

[[noreturn]] void raise_toml_error(const std::string& message, const std::string& file, int line, int) {
    throw InputError(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + message);
}

/// Calls f(key, node) for all entries of a table in the order of the file, which the parser does not preserve.
template <class F>
void for_each_in_order(const toml::table& table, F&& f) {
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
    std::sort(entries.begin(), entries.end(),
              [](const auto& a, const auto& b) { return a.first->source().begin < b.first->source().begin; });
    for (const auto& [key, node] : entries) f(*key, *node);
}

py::str text_of(const toml::key& key) {
    return {std::string(key.str())};
}

/// Converts a node to a Python value; tables become dicts and arrays become lists.
py::object value_of(const toml::node& node) {
    if (const auto* table = node.as_table()) {
        py::dict values;
        for_each_in_order(*table,
                          [&](const toml::key& key, const toml::node& item) { values[text_of(key)] = value_of(item); });
        return values;
    }
    if (const auto* array = node.as_array()) {
        py::list values;
        for (const toml::node& item : *array) values.append(value_of(item));
        return values;
    }
    if (const auto* text = node.as_string()) return py::str(text->get());
    if (const auto* number = node.as_integer()) return py::int_(number->get());
    if (const auto* number = node.as_floating_point()) return py::float_(number->get());
    if (const auto* flag = node.as_boolean()) return py::bool_(flag->get());
    return py::none();  // dates, which realcam's files do not use
}

/// Returns (values, lines): the table, and the line of each key at the top level.
Typed<"tuple[dict[str, Any], dict[str, int]]", py::tuple> read_toml(const std::string& text, const std::string& file) {
    const toml::table table = io::parse_toml(text, file, raise_toml_error);
    py::dict lines;
    for (const auto& [key, node] : table) lines[text_of(key)] = key.source().begin.line;
    return py::make_tuple(value_of(table), lines);
}

}  // namespace

void bind_toml(py::module_& m) {
    m.def(
        "_read_toml", &read_toml, "text"_a, "file"_a,
        "Internal. Parses TOML. Returns the values, and the line number of each top-level key. file: name of the file, "
        "for messages. Raises InputError with the line.");
}

}  // namespace realcam::bindings
