#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace realcam::image_io {

/// Name of the reader for what a file begins with, as OpenImageIO has it: "png", "jpeg", "openexr", "hdr", "tiff",
/// "bmp", "webp", or "targa" by the suffix of `path`, because that format has no mark. Empty for anything else:
/// OpenImageIO's readers of rarer formats crash on broken files.
std::string image_format(std::span<const std::uint8_t> first_bytes, const std::string& path);

/// Bytes that image_format looks at.
inline constexpr std::size_t kFormatBytes = 16;

/// What image_format knows, for messages.
inline constexpr const char* kReadFormats = "PNG, JPEG, OpenEXR, Radiance HDR, TIFF, BMP, WebP or TGA";

}  // namespace realcam::image_io
