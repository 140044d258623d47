#include "printable.hpp"

#include <algorithm>
#include <cstddef>

namespace realcam::io {
namespace {

constexpr std::size_t kMaxQuotedBytes = 60;
constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD in UTF-8

// Limits of one_line, in bytes: longer words and lines are shortened to this number of bytes at each end.
constexpr std::size_t kMaxWord = 300, kWordEnds = 100, kMaxLine = 2000, kLineEnds = 800;

/// Replaces control characters and invalid bytes (see printable), and truncates at the end of a character after
/// `max_bytes` bytes.
std::string sanitized(std::string_view bytes, std::size_t max_bytes) {
    std::string out;
    while (!bytes.empty() && out.size() < max_bytes) {
        const std::size_t size = utf8_size(bytes);
        const bool is_control = size == 1 && (static_cast<unsigned char>(bytes[0]) < 0x20 || bytes[0] == 0x7f);
        // U+0080 to U+009F; U+0085 ends a line.
        const bool is_late_control = size == 2 && bytes[0] == '\xc2' && static_cast<unsigned char>(bytes[1]) < 0xa0;
        if (size == 0)
            out += kReplacement;
        else if (is_control || is_late_control)
            out += ' ';
        else
            out += bytes.substr(0, size);
        bytes.remove_prefix(std::max<std::size_t>(size, 1));
    }
    return bytes.empty() ? out : out + "...";
}

}  // namespace

std::string printable(std::string_view bytes) {
    return sanitized(bytes, std::string_view::npos);
}

std::string in_quotes(std::string_view bytes) {
    return '"' + sanitized(bytes, kMaxQuotedBytes) + '"';
}

namespace {

/// Replaces the middle of a text that is longer than `max_length` by the number of bytes left out; `kept`: number of
/// bytes that remain at each end.
std::string shortened(const std::string& text, std::size_t max_length, std::size_t kept) {
    if (text.size() <= max_length) return text;
    return text.substr(0, kept) + "[... " + std::to_string(text.size() - 2 * kept) + " characters ...]" +
           text.substr(text.size() - kept);
}

}  // namespace

std::string one_line(const std::string& message) {
    std::string line, word;
    const auto end_word = [&] {
        line += shortened(word, kMaxWord, kWordEnds);
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
    return shortened(line, kMaxLine, kLineEnds);
}

namespace {

/// True if the byte lies between two values, inclusive.
bool is_between(char c, unsigned low, unsigned high) {
    const auto value = static_cast<unsigned char>(c);
    return value >= low && value <= high;
}

}  // namespace

std::size_t utf8_size(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4) return 0;
    const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (text.size() < size) return 0;
    // The second byte reveals overlong forms, surrogates and code points beyond U+10FFFF.
    const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (!is_between(text[1], low, high)) return 0;
    for (std::size_t i = 2; i < size; ++i)
        if (!is_between(text[i], 0x80, 0xbf)) return 0;
    return size;
}

bool is_utf8(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t size = utf8_size(bytes);
        if (size == 0) return false;
        bytes.remove_prefix(size);
    }
    return true;
}

std::size_t utf8_begin(std::string_view text, std::size_t byte) {
    while (byte > 0 && is_between(text[byte], 0x80, 0xbf)) --byte;
    return byte;
}

void append_utf8(std::string& out, unsigned point) {
    const auto add = [&](unsigned byte) { out += static_cast<char>(byte); };
    if (point < 0x80) return add(point);
    if (point < 0x800) {
        add(0xc0 | (point >> 6));
    } else if (point < 0x10000) {
        add(0xe0 | (point >> 12));
        add(0x80 | ((point >> 6) & 0x3f));
    } else {
        add(0xf0 | (point >> 18));
        add(0x80 | ((point >> 12) & 0x3f));
        add(0x80 | ((point >> 6) & 0x3f));
    }
    add(0x80 | (point & 0x3f));
}

}  // namespace realcam::io
