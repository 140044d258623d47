#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace realcam::io {

/// Bytes of the character that begins a text, which is not empty; 0 where its bytes are no UTF-8.
std::size_t utf8_size(std::string_view text);

/// Whether bytes are valid UTF-8.
bool is_utf8(std::string_view bytes);

/// The beginning of the character that a byte of a text belongs to.
std::size_t utf8_begin(std::string_view text, std::size_t byte);

/// Appends the character of a code point.
void append_utf8(std::string& out, unsigned point);

/// The code point of a surrogate pair of UTF-16.
constexpr unsigned from_surrogates(unsigned high, unsigned low) {
    return 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00);
}

}  // namespace realcam::io
