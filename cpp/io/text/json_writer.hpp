#pragma once
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace realcam::io {

/// Writes indented JSON. The calls follow the order of the text, such as begin_object().key("a").number(1).end(), and
/// each returns the writer. Values in an object must follow a key.
class JsonWriter {
public:
    JsonWriter& begin_object() { return begin('{', '}'); }
    JsonWriter& begin_array() { return begin('[', ']'); }
    /// Ends the innermost object or array.
    JsonWriter& end();
    /// Writes the name of the next member.
    JsonWriter& key(const std::string& name);
    /// Writes a string.
    JsonWriter& text(const std::string& value);
    /// Writes a number, or null if it is infinite or NaN, which JSON does not have.
    JsonWriter& number(double value);
    /// Writes a number; infinite numbers as Infinity, which Python writes and reads, but JSON does not have.
    JsonWriter& number_or_infinity(double value);
    /// Writes true or false.
    JsonWriter& truth(bool value);
    JsonWriter& null();
    /// Writes an array of numbers.
    JsonWriter& numbers(const std::vector<double>& values);

    // Members of an object: a key with its value.
    JsonWriter& numbers(std::initializer_list<std::pair<const char*, double>> members);
    JsonWriter& begin_object(const std::string& name) { return key(name).begin_object(); }
    JsonWriter& begin_array(const std::string& name) { return key(name).begin_array(); }
    JsonWriter& text(const std::string& name, const std::string& value) { return key(name).text(value); }
    JsonWriter& number(const std::string& name, double value) { return key(name).number(value); }
    JsonWriter& truth(const std::string& name, bool value) { return key(name).truth(value); }
    JsonWriter& null(const std::string& name) { return key(name).null(); }
    JsonWriter& numbers(const std::string& name, const std::vector<double>& values) {
        return key(name).numbers(values);
    }

    /// Returns the text, after all objects and arrays have been ended.
    std::string finish() const { return text_; }

private:
    JsonWriter& begin(char open, char close);
    /// Writes the comma and the line break that precede a key, or a value in an array.
    void before_value();
    void new_line();
    void quote(const std::string& value);

    std::string text_;
    std::vector<char> closers_;  ///< closing brackets of the open objects and arrays
    bool is_first_ = true;          ///< true before the first element of the innermost object or array
    bool is_after_key_ = false;     ///< true between a key and its value
};

}  // namespace realcam::io
