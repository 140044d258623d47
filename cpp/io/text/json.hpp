#pragma once
// The subset of JSON that scene and lens files need: reading, and access to members that may be absent.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "../../checkpoint.hpp"

namespace realcam::io {

/// Numbers that the parser accepts. JSON has only finite ones; Python also writes Infinity, -Infinity and NaN.
enum class JsonNumbers { finite, with_infinity };

/// Value of a JSON document.
class Json {
public:
    using Array = std::vector<Json>;
    /// Members sorted by name.
    using Object = std::vector<std::pair<std::string, Json>>;

    Json() = default;
    Json(bool value) : value_(value) {}
    Json(double value) : value_(value) {}
    Json(std::string value) : value_(std::move(value)) {}
    Json(Array value) : value_(std::move(value)) {}
    Json(Object value) : value_(std::move(value)) {}

    /// Parses a text. Throws std::runtime_error, with line and column (in bytes), if the text is not valid JSON, is
    /// nested more than 200 deep, or has more than eight million values (some 600 MB). Of members with the same name
    /// the last one counts. `with_infinity` also reads Infinity, -Infinity and NaN.
    static Json parse(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers = JsonNumbers::finite);

    /// Returns the member or element, or null (a Json that is_null()) if it does not exist or this is not an object or
    /// array.
    const Json& operator[](std::string_view name) const;
    const Json& operator[](const char* name) const { return (*this)[std::string_view(name)]; }
    const Json& operator[](std::size_t index) const;

    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    bool is_number() const { return std::holds_alternative<double>(value_); }
    /// True only for the value `true`.
    bool is_true() const { return std::holds_alternative<bool>(value_) && std::get<bool>(value_); }
    /// Returns the number of elements of an array; 0 for anything else.
    std::size_t size() const;
    /// Returns a number; for anything else `default_value`.
    double number(double default_value) const;
    /// Returns a whole number from 0 to 2^53, which glTF uses for counts and indices; for anything else
    /// `default_value`.
    std::size_t index(std::size_t default_value) const;
    /// Returns the text of a string; empty for anything else.
    const std::string& text() const;

private:
    std::variant<std::monostate, bool, double, std::string, Array, Object> value_;
};

}  // namespace realcam::io
