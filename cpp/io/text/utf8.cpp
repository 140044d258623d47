#include "utf8.hpp"

namespace realcam::io {
namespace {

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
