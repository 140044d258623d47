#pragma once
#include <string>
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
