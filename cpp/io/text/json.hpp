#pragma once
// As much JSON as files of scenes and lenses need: reading, and asking for what may be absent.

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "../../checkpoint.hpp"

namespace realcam::io {

/// Numbers that JSON has not, and Python writes all the same.
enum class JsonNumbers { finite, with_infinity };

class Json {
public:
    using Array = std::vector<Json>;
    /// Sorted by name.
    using Object = std::vector<std::pair<std::string, Json>>;

    Json() = default;
    Json(bool value) : value_(value) {}
    Json(double value) : value_(value) {}
    Json(std::string value) : value_(std::move(value)) {}
    Json(Array value) : value_(std::move(value)) {}
    Json(Object value) : value_(std::move(value)) {}

    /// Throws std::runtime_error, with line and column (in bytes), if the text is no JSON, is nested more than 200
    /// deep, or holds more than eight million values (some 600 MB). Of members with one name the last counts.
    /// `with_infinity` reads Infinity, -Infinity and NaN too.
    static Json parse(std::string_view text, Checkpoint& checkpoint, JsonNumbers numbers = JsonNumbers::finite);

    /// The member or element, or null (a Json that is_null()) if there is none or this is something else.
    const Json& operator[](std::string_view name) const;
    const Json& operator[](const char* name) const { return (*this)[std::string_view(name)]; }
    const Json& operator[](std::size_t index) const;

    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    bool is_number() const { return std::holds_alternative<double>(value_); }
    bool is_true() const { return std::holds_alternative<bool>(value_) && std::get<bool>(value_); }
    /// Elements of an array; 0 for anything else.
    std::size_t size() const;
    double number(double otherwise) const;
    /// A whole number from 0 to 2^53, as glTF counts and numbers things.
    std::size_t index(std::size_t otherwise) const;
    /// Empty for anything but a string.
    const std::string& text() const;

private:
    std::variant<std::monostate, bool, double, std::string, Array, Object> value_;
};

}  // namespace realcam::io
