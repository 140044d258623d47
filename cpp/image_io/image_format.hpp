#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace realcam::image_io {

/// Returns OpenImageIO's name of the reader for a file's first bytes: "png", "jpeg", "openexr", "hdr", "tiff", "bmp",
/// "webp", or "targa" by the suffix of `path`, because that format has no signature. Empty for anything else:
/// OpenImageIO's readers of rarer formats crash on broken files.
std::string image_format(std::span<const std::uint8_t> first_bytes, const std::string& path);

/// Number of bytes that image_format examines.
inline constexpr std::size_t kFormatBytes = 16;

/// The formats of image_format, for messages.
inline constexpr const char* kReadFormats = "PNG, JPEG, OpenEXR, Radiance HDR, TIFF, BMP, WebP or TGA";

}  // namespace realcam::image_io
