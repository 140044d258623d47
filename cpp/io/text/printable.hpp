#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace realcam::io {

/// Returns the number of bytes of the first character of a text that is not empty; 0 if the character is not valid
/// UTF-8.
std::size_t utf8_size(std::string_view text);

/// True if the bytes are valid UTF-8.
bool is_utf8(std::string_view bytes);

/// Returns the position of the first byte of the character to which the byte at position `byte` belongs.
std::size_t utf8_begin(std::string_view text, std::size_t byte);

/// Appends the UTF-8 encoding of a code point.
void append_utf8(std::string& out, unsigned point);

/// Returns the code point of a surrogate pair of UTF-16.
constexpr unsigned from_surrogates(unsigned high, unsigned low) {
    return 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00);
}

/// Returns a message as one line for a terminal. Control characters become blanks; the middle of words of more than 300
/// bytes and of messages of more than 2000 bytes, which only broken input causes, is replaced by the number of
/// characters left out.
std::string one_line(const std::string& message);

/// Returns any bytes as one line of valid UTF-8: control characters become blanks, and invalid bytes become U+FFFD.
std::string printable(std::string_view bytes);

/// Returns printable(bytes) in double quotes, truncated to about 60 bytes, to quote input in error messages.
std::string in_quotes(std::string_view bytes);

}  // namespace realcam::io
