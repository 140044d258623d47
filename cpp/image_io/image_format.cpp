#include "image_format.hpp"

#include <algorithm>
#include <string_view>

#include "../io/files/file_suffix.hpp"

namespace realcam::image_io {

std::string image_format(std::span<const std::uint8_t> first_bytes, const std::string& path) {
    using namespace std::string_view_literals;
    const std::string_view bytes(reinterpret_cast<const char*>(first_bytes.data()), first_bytes.size());
    const auto begins = [&](std::string_view mark) { return bytes.substr(0, mark.size()) == mark; };
    if (begins("\x89PNG\r\n\x1a\n"sv)) return "png";
    if (begins("\xff\xd8\xff"sv)) return "jpeg";
    if (begins("\x76\x2f\x31\x01"sv)) return "openexr";
    if (begins("#?RADIANCE"sv) || begins("#?RGBE"sv)) return "hdr";
    if (begins("II*\0"sv) || begins("MM\0*"sv)) return "tiff";
    if (begins("RIFF"sv) && bytes.substr(std::min<std::size_t>(8, bytes.size()), 4) == "WEBP"sv) return "webp";
    if (begins("BM"sv)) return "bmp";
    return io::suffix_of(path) == ".tga" ? "targa" : "";
}

}  // namespace realcam::image_io
