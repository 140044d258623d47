#include "printable.hpp"

#include <algorithm>
#include <cstddef>

#include "utf8.hpp"

namespace realcam::io {
namespace {

constexpr std::size_t kMostQuoted = 60;
constexpr std::string_view kReplacement = "\xef\xbf\xbd";

/// Cleans a text, and cuts it at the end of a character after `most` bytes.
std::string cleaned(std::string_view bytes, std::size_t most) {
    std::string out;
    while (!bytes.empty() && out.size() < most) {
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
    return cleaned(bytes, std::string_view::npos);
}

std::string in_quotes(std::string_view bytes) {
    return '"' + cleaned(bytes, kMostQuoted) + '"';
}

}  // namespace realcam::io
