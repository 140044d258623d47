#pragma once
// The parser is compiled once, in toml_document.cpp.
#define TOML_HEADER_ONLY 0
#include <toml++/toml.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "../../error.hpp"
#include "help_page.hpp"
#include "printable.hpp"

namespace realcam::io {

/// Function that throws the error type of a kind of file. `line` and `surface` are 1-based; 0 if they do not apply.
using RaiseFileError = void (*)(const std::string& message, const std::string& file, int line, int surface);

/// RaiseFileError for lens files.
[[noreturn]] inline void raise_lens_file_error(const std::string& message, const std::string& file, int line,
                                               int surface) {
    throw LensFileError(message, file, line, surface);
}

/// Table of a TOML file that knows its position, so that every error names file, line and, in a lens file, surface.
class TomlTable {
public:
    /// `table` must outlive this object. `file`: its name in messages. `surface`: number of the lens surface that the
    /// table describes; 0: none. `raise`: throws the errors.
    TomlTable(const toml::table& table, std::string file, int surface = 0, RaiseFileError raise = raise_lens_file_error)
        : table_(table), file_(std::move(file)), surface_(surface), raise_(raise) {}

    /// Throws an error at the line of `node` or, if it is null, of the table.
    [[noreturn]] void fail(const std::string& message, const toml::node* node = nullptr) const {
        const toml::node& location = node ? *node : table_;
        raise_(message, file_, static_cast<int>(location.source().begin.line), surface_);
        std::abort();  // raise_ has thrown
    }

    /// Throws an error for a key that is not one of `keys`: a misspelt key must not be ignored.
    void allow(const std::vector<std::string_view>& keys) const {
        for (const auto& [key, node] : table_) {
            bool is_known = false;
            for (std::string_view allowed : keys) is_known |= key.str() == allowed;
            if (!is_known)
                fail("unknown key " + in_quotes(key.str()) +
                         did_you_mean(key.str(), std::vector<std::string>(keys.begin(), keys.end())),
                     &node);
        }
    }

    /// Returns the value of a key; null if the key is absent.
    const toml::node* find(std::string_view key) const { return table_.get(key); }

    /// Returns a finite number; std::nullopt if the key is absent.
    std::optional<double> number(std::string_view key) const {
        const toml::node* node = find(key);
        if (!node) return std::nullopt;
        return as_number(*node, shown(key));
    }

    /// Returns the value of a node as a finite number. `what`: noun phrase for it, which begins the error message.
    double as_number(const toml::node& node, const std::string& what) const {
        // value_or returns no value for an integer that no double represents exactly.
        const double value = node.is_integer()  ? static_cast<double>(node.as_integer()->get())
                             : node.is_number() ? node.value_or(0.0)
                                                : std::nan("");
        if (!std::isfinite(value)) fail(what + " must be a finite number", &node);
        return value;
    }

    /// Returns a text; empty if the key is absent.
    std::string text(std::string_view key) const {
        const toml::node* node = find(key);
        if (!node) return {};
        if (!node->is_string()) fail(shown(key) + " must be a text in quotes", node);
        return *node->value<std::string>();
    }

    /// Returns a text that must be a single line, without control characters; empty if the key is absent.
    std::string line(std::string_view key) const {
        std::string value = text(key);
        if (printable(value) != value)
            fail(shown(key) + " must be one line of text, without control characters", find(key));
        return value;
    }

    /// Throws an error at `node` if the name of a table within this one is not a single line without control
    /// characters.
    void check_name(std::string_view key, const toml::node& node) const {
        if (printable(key) != key)
            fail("the name " + in_quotes(key) + " must be one line of text, without control characters", &node);
    }

    /// Returns a truth value; false if the key is absent.
    bool flag(std::string_view key) const {
        const toml::node* node = find(key);
        if (!node) return false;
        if (!node->is_boolean()) fail(shown(key) + " must be true or false", node);
        return *node->value<bool>();
    }

    /// Returns an array of exactly `count` numbers (any number of them if `count` is 0); empty if the key is absent.
    std::vector<double> numbers(std::string_view key, std::size_t count) const {
        const toml::node* node = find(key);
        if (!node) return {};
        const toml::array* array = node->as_array();
        const std::string what = shown(key);
        if (!array || array->empty() || (count && array->size() != count))
            fail(what + " must be an array of " + (count ? std::to_string(count) + " " : "") + "numbers", node);
        std::vector<double> values;
        for (const toml::node& item : *array) values.push_back(as_number(item, "each value of " + what));
        return values;
    }

    /// Returns an array of texts; empty if the key is absent.
    std::vector<std::string> texts(std::string_view key) const {
        const toml::node* node = find(key);
        if (!node) return {};
        const toml::array* array = node->as_array();
        const std::string what = shown(key) + " must be an array of texts in quotes";
        if (!array) fail(what, node);
        std::vector<std::string> values;
        for (const toml::node& item : *array) {
            if (!item.is_string()) fail(what, &item);
            values.push_back(*item.value<std::string>());
        }
        return values;
    }

    /// Returns the table of a key; std::nullopt if the key is absent.
    std::optional<TomlTable> table(std::string_view key) const {
        const toml::node* node = find(key);
        if (!node) return std::nullopt;
        if (!node->is_table()) fail(shown(key) + " must be a table", node);
        return TomlTable(*node->as_table(), file_, surface_, raise_);
    }

    /// Returns a table within this one, whose errors name the same file and surface.
    TomlTable within(const toml::table& inner) const { return TomlTable(inner, file_, surface_, raise_); }

    /// The table of toml++.
    const toml::table& raw() const { return table_; }
    const std::string& file() const { return file_; }

    /// Returns a key's name for messages.
    std::string shown(std::string_view key) const { return name_ ? name_(key) : '"' + std::string(key) + '"'; }

protected:
    std::function<std::string(std::string_view)> name_;  ///< name of a key in messages, if it is not the key in quotes

private:
    const toml::table& table_;
    std::string file_;
    int surface_;
    RaiseFileError raise_;
};

}  // namespace realcam::io
