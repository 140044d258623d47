#include "json_writer.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace realcam::io {

JsonWriter& JsonWriter::begin(char open, char close) {
    before_value();
    text_ += open;
    closers_.push_back(close);
    is_first_ = true;
    return *this;
}

JsonWriter& JsonWriter::end() {
    const char close = closers_.back();
    closers_.pop_back();
    if (!is_first_) new_line();
    text_ += close;
    is_first_ = false;
    return *this;
}

JsonWriter& JsonWriter::key(const std::string& name) {
    before_value();
    quote(name);
    text_ += ": ";
    is_after_key_ = true;
    return *this;
}

JsonWriter& JsonWriter::text(const std::string& value) {
    before_value();
    quote(value);
    return *this;
}

JsonWriter& JsonWriter::number(double value) {
    before_value();
    char digits[32];
    if (std::isfinite(value)) {
        text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    } else {
        text_ += "null";
    }
    return *this;
}

JsonWriter& JsonWriter::number_or_infinity(double value) {
    if (!std::isinf(value)) return number(value);
    before_value();
    text_ += value > 0 ? "Infinity" : "-Infinity";
    return *this;
}

JsonWriter& JsonWriter::truth(bool value) {
    before_value();
    text_ += value ? "true" : "false";
    return *this;
}

JsonWriter& JsonWriter::null() {
    before_value();
    text_ += "null";
    return *this;
}

JsonWriter& JsonWriter::numbers(const std::vector<double>& values) {
    begin_array();
    for (const double value : values) number(value);
    return end();
}

JsonWriter& JsonWriter::numbers(std::initializer_list<std::pair<const char*, double>> members) {
    for (const auto& [name, value] : members) number(name, value);
    return *this;
}

void JsonWriter::before_value() {
    if (!is_after_key_ && !closers_.empty()) {
        if (!is_first_) text_ += ',';
        new_line();
    }
    is_first_ = is_after_key_ = false;
}

void JsonWriter::new_line() {
    text_ += '\n' + std::string(2 * closers_.size(), ' ');
}

void JsonWriter::quote(const std::string& value) {
    text_ += '"';
    for (const char c : value) {
        if (static_cast<unsigned char>(c) < 0x20) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c));
            text_ += escape;
        } else {
            if (c == '"' || c == '\\') text_ += '\\';
            text_ += c;
        }
    }
    text_ += '"';
}

}  // namespace realcam::io
