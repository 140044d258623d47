#include "printable.hpp"

#include <algorithm>
#include <cstddef>

namespace realcam::io {
namespace {

constexpr std::size_t kMostQuoted = 60;
constexpr std::string_view kReplacement = "\xef\xbf\xbd";

bool is_between(char c, unsigned low, unsigned high) {
    const auto value = static_cast<unsigned char>(c);
    return value >= low && value <= high;
}

/// Bytes of the character that begins a text; 0 where that is none. Overlong forms, surrogates and what lies beyond
/// U+10FFFF show in the second byte.
std::size_t character_size(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    if (first < 0xc2 || first > 0xf4) return 0;
    const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    if (text.size() < size) return 0;
    const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (!is_between(text[1], low, high)) return 0;
    for (std::size_t i = 2; i < size; ++i)
        if (!is_between(text[i], 0x80, 0xbf)) return 0;
    return size;
}

/// Ends at a character's end once there are `most` bytes.
std::string cleaned(std::string_view bytes, std::size_t most) {
    std::string out;
    while (!bytes.empty() && out.size() < most) {
        const std::size_t size = character_size(bytes);
        const bool is_control = size == 1 && (is_between(bytes[0], 0, 0x1f) || bytes[0] == 0x7f);
        // U+0080 to U+009F, of which U+0085 ends a line.
        const bool is_late_control = size == 2 && bytes[0] == '\xc2' && is_between(bytes[1], 0x80, 0x9f);
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
    return cleaned(bytes, std::string_view::npos);
}

bool is_utf8(std::string_view bytes) {
    while (!bytes.empty()) {
        const std::size_t size = character_size(bytes);
        if (size == 0) return false;
        bytes.remove_prefix(size);
    }
    return true;
}

std::string in_quotes(std::string_view bytes) {
    return '"' + cleaned(bytes, kMostQuoted) + '"';
}

}  // namespace realcam::io
