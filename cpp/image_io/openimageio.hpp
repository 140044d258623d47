#pragma once
// Interface to the parts of OpenImageIO that are used here: it passes on a file's numbers and does not interpret them.
// There are two implementations, and a program is linked with one of them: cpp/openimageio calls the C++ library, for
// the executable, and cpp/bindings calls the Python package of that name, for the extension.

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

/// Result of a call. OpenImageIO can also have a message for a call that succeeds.
struct Outcome {
    bool is_good;
    std::string said;  ///< OpenImageIO's message, or empty
};

/// Header of a file or of one of its parts (OpenImageIO's ImageSpec).
struct EncodedHeader {
    int x = 0, y = 0, width = 0, height = 0, depth = 1;           ///< the data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;  ///< the display window
    struct Channel {
        std::string name;
        bool is_number = false;  ///< whole numbers of 32 bits
    };
    std::string part_name;  ///< in a file of several parts (OpenEXR)
    std::vector<Channel> channel_names;
    int bytes_per_value = 1;
    int tile_height = 0;  ///< 0: scanlines instead of tiles
    bool is_floating_point = false, is_deep = false;
    std::optional<std::array<float, 8>> chromaticities;
    std::string texture_format;
    std::vector<std::pair<std::string, std::string>> entries;  ///< metadata entries named "realcam:..."
};

/// Half-open ranges of rows and channels of one part. Row 0 is the data window's first. In a tiled picture, the rows
/// must be those of whole tiles.
struct EncodedRegion {
    int part, first_row, end_row, first_channel, end_channel;
};

/// Greatest number of parts that are read: a file of 20 kB can have thousands.
inline constexpr int kMostParts = 256;

/// Opened picture file whose headers have been read.
class PictureDecoder {
public:
    virtual ~PictureDecoder() = default;

    std::vector<EncodedHeader> parts;  ///< at least one

    /// Decodes a region into a contiguous array: display values from 0 to 255, or numbers with white = 1.
    virtual Outcome read(const EncodedRegion& region, std::uint8_t* pixels) = 0;
    virtual Outcome read(const EncodedRegion& region, float* pixels) = 0;
};

/// Opens the file `path`, or, if it is empty, the bytes of a file, which have to outlive the result. `format`:
/// OpenImageIO's name of it. Throws Error, with the reason alone.
std::unique_ptr<PictureDecoder> open_decoder(const std::string& format, const std::string& path,
                                             std::span<const std::uint8_t> bytes);

/// Header of a picture to be encoded.
struct EncodedPicture {
    struct Channel {
        std::string name;
        bool is_number = false;  ///< uint32, not float
    };

    std::string format;
    int width = 0, height = 0;
    std::vector<Channel> channels;  ///< empty: red, green and blue as 8-bit display values
    std::vector<std::pair<std::string, std::variant<std::string, float, std::array<float, 2>>>> attributes;
};

/// Encodes the rows of a picture, in order.
class PictureEncoder {
public:
    virtual ~PictureEncoder() = default;

    /// Writes the rows from `first` to before `end`, contiguous: 8-bit display values, or four bytes per channel.
    virtual Outcome write(int first, int end, const void* pixels) = 0;
    /// Completes the file after the last row.
    virtual Outcome close() = 0;
};

/// Begins to write `picture` into `file`, which has to outlive the result. Throws Error, with the reason alone.
std::unique_ptr<PictureEncoder> open_encoder(const EncodedPicture& picture, UnfinishedFile& file);

/// Returns the first line of a message of OpenImageIO.
inline std::string first_line(const std::string& said) {
    return said.substr(0, said.find('\n'));
}

/// Returns the first line in parentheses, to end a message with; empty if OpenImageIO's own formatting of it failed.
inline std::string reason(const std::string& said) {
    const std::string line = first_line(said);
    return line.empty() || line.find("fixme") != std::string::npos ? "" : " (" + line + ")";
}

}  // namespace realcam::image_io
