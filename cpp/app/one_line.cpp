#include "one_line.hpp"

namespace realcam::app {

std::string one_line(const std::string& message) {
    constexpr std::size_t kLongest = 300, kKept = 100;
    std::string line;
    const auto add = [&](const std::string& word) {
        line += word.size() <= kLongest ? word
                                        : word.substr(0, kKept) + "[... " + std::to_string(word.size() - 2 * kKept) +
                                              " characters ...]" + word.substr(word.size() - kKept);
    };
    std::string word;
    for (const char c : message) {
        const auto code = static_cast<unsigned char>(c);
        if (code > ' ' && code != 0x7f) {
            word += c;
            continue;
        }
        add(word);
        word.clear();
        line += ' ';
    }
    add(word);
    return line;
}

}  // namespace realcam::app
