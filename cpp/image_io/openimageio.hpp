#pragma once
// Interface to the part of OpenImageIO that is used here, which decodes and encodes files without interpreting the
// numbers. There are two implementations, and a program is linked with one of them: cpp/openimageio calls the C++
// library, for the executable, and cpp/bindings calls the Python package of that name, for the extension.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "unfinished_file.hpp"

namespace realcam::image_io {

/// Result of a call to OpenImageIO, which can have a message even if it succeeds.
struct Outcome {
    bool is_good;      ///< true if the call succeeded
    std::string said;  ///< OpenImageIO's message, or empty
};

/// Header of a file or of one of its parts (OpenImageIO's ImageSpec).
struct EncodedHeader {
    int x = 0, y = 0, width = 0, height = 0, depth = 1;           ///< the data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;  ///< the display window
    /// Channel of the file.
    struct Channel {
        std::string name;
        bool is_number = false;  ///< true for whole numbers of 32 bits (UINT), false for other types
    };
    std::string part_name;  ///< in a file of several parts (OpenEXR)
    std::vector<Channel> channel_names;
    int bytes_per_value = 1;
    int tile_height = 0;  ///< rows of a tile; 0: the file has scanlines
    bool is_floating_point = false, is_deep = false;
    std::optional<std::array<float, 8>> chromaticities;
    std::string texture_format;  ///< OpenImageIO's attribute textureformat; empty: none
    std::vector<std::pair<std::string, std::string>> entries;  ///< metadata entries named "realcam:..."
};

/// Half-open ranges of rows and channels of one part. Row 0 is the first row of the data window. In a tiled picture,
/// the rows must be those of complete tiles.
struct EncodedRegion {
    int part, first_row, end_row, first_channel, end_channel;
};

/// Greatest number of parts of a file that are read: a file of 20 kB can have thousands.
inline constexpr int kMaxParts = 256;

/// Opened picture file whose headers have been read.
class PictureDecoder {
public:
    virtual ~PictureDecoder() = default;

    std::vector<EncodedHeader> parts;  ///< at least one

    /// Decodes a region into a contiguous array of its rows, pixels and channels: display values from 0 to 255, or
    /// numbers with white = 1.
    virtual Outcome read(const EncodedRegion& region, std::uint8_t* pixels) = 0;
    virtual Outcome read(const EncodedRegion& region, float* pixels) = 0;
};

/// Opens the file `path`, or, if it is empty, the bytes of a file, which must outlive the result. `format`:
/// OpenImageIO's name of the format. Throws Error, whose message is the reason without the path.
std::unique_ptr<PictureDecoder> open_decoder(const std::string& format, const std::string& path,
                                             std::span<const std::uint8_t> bytes);

/// Header of a picture to be encoded.
struct EncodedPicture {
    struct Channel {
        std::string name;
        bool is_number = false;  ///< true for uint32, false for float
    };

    std::string format;  ///< OpenImageIO's name of the format
    int width = 0, height = 0;
    std::vector<Channel> channels;  ///< empty: red, green and blue as 8-bit display values
    std::vector<std::pair<std::string, std::variant<std::string, float, std::array<float, 2>, std::array<float, 8>>>>
        attributes;
};

/// Encodes the rows of a picture, in order.
class PictureEncoder {
public:
    virtual ~PictureEncoder() = default;

    /// Writes the rows from `first` to `end` (exclusive), which are contiguous: 8-bit display values, or four bytes per
    /// channel.
    virtual Outcome write(int first, int end, const void* pixels) = 0;
    /// Completes the file after the last row.
    virtual Outcome close() = 0;
};

/// Begins to write `picture` into `file`, which must outlive the result. Throws Error, whose message is
/// the reason without the path.
std::unique_ptr<PictureEncoder> open_encoder(const EncodedPicture& picture, UnfinishedFile& file);

/// Returns the first line of a message of OpenImageIO.
inline std::string first_line(const std::string& said) {
    return said.substr(0, said.find('\n'));
}

/// Returns the first line in parentheses, for the end of a message; empty if there is none, or if OpenImageIO failed to
/// format it.
inline std::string reason(const std::string& said) {
    const std::string line = first_line(said);
    return line.empty() || line.find("fixme") != std::string::npos ? "" : " (" + line + ")";
}

}  // namespace realcam::image_io
