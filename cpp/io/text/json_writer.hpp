#pragma once
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace realcam::io {

/// Writes JSON, indented. Calls follow the text: begin_object().key("a").number(1).end().
class JsonWriter {
public:
    JsonWriter& begin_object() { return begin('{', '}'); }
    JsonWriter& begin_array() { return begin('[', ']'); }
    JsonWriter& end();
    JsonWriter& key(const std::string& name);
    JsonWriter& text(const std::string& value);
    /// Writes a number, or null if it is infinite or NaN, which JSON does not have.
    JsonWriter& number(double value);
    /// Writes a number; infinite ones as Infinity, as Python writes and reads them.
    JsonWriter& number_or_infinity(double value);
    JsonWriter& truth(bool value);
    JsonWriter& null();
    JsonWriter& numbers(const std::vector<double>& values);

    // The same as members of an object.
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

    std::string finish() const { return text_; }

private:
    JsonWriter& begin(char open, char close);
    void before_value();
    void new_line();
    void quote(const std::string& value);

    std::string text_;
    std::vector<char> closers_;
    bool first_ = true, after_key_ = false;
};

}  // namespace realcam::io
