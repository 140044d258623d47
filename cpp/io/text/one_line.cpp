#include "one_line.hpp"

namespace realcam::io {
namespace {

/// Removes the middle of a text that is longer than `longest`, and keeps `kept` characters at each end.
std::string shortened(const std::string& text, std::size_t longest, std::size_t kept) {
    if (text.size() <= longest) return text;
    return text.substr(0, kept) + "[... " + std::to_string(text.size() - 2 * kept) + " characters ...]" +
           text.substr(text.size() - kept);
}

}  // namespace

std::string one_line(const std::string& message) {
    std::string line, word;
    const auto end_word = [&] {
        line += shortened(word, 300, 100);
        word.clear();
    };
    for (const char c : message) {
        const auto code = static_cast<unsigned char>(c);
        if (code > ' ' && code != 0x7f) {
            word += c;
        } else {
            end_word();
            line += ' ';
        }
    }
    end_word();
    return shortened(line, 2000, 800);
}

}  // namespace realcam::io
