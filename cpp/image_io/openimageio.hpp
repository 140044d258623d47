#pragma once
// OpenImageIO as far as it is used here: the file's numbers, and nothing of what they mean. It is defined twice, and a
// program is linked with one of the two: cpp/openimageio calls the C++ library, for the executable, and cpp/bindings
// the Python package of that name, for the extension.

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

/// What a call came to. OpenImageIO also has something to say of calls that succeed.
struct Outcome {
    bool is_good;
    std::string said;  ///< empty: nothing
};

/// What a file, or one part of it, says before its pixels are decoded; OpenImageIO's ImageSpec.
struct EncodedHeader {
    int x = 0, y = 0, width = 0, height = 0, depth = 1;           ///< the data window
    int full_x = 0, full_y = 0, full_width = 0, full_height = 0;  ///< the display window
    struct Channel {
        std::string name;
        bool is_number = false;  ///< whole numbers of 32 bits
    };
    std::string part_name;  ///< of a file of several parts (OpenEXR)
    std::vector<Channel> channel_names;
    int bytes_per_value = 1;
    int tile_height = 0;  ///< 0: rows
    bool is_floating_point = false, is_deep = false;
    std::optional<std::array<float, 8>> chromaticities;
    std::string texture_format;
    std::vector<std::pair<std::string, std::string>> entries;  ///< those named "realcam:..."
};

/// Rows and channels of one part, from the first to before the end. Row 0 is the data window's first. Of a picture of
/// tiles, rows of whole tiles are wanted.
struct EncodedRegion {
    int part, first_row, end_row, first_channel, end_channel;
};

/// Parts of a file that are looked at: a file of 20 kB can have thousands.
inline constexpr int kMostParts = 256;

/// A file whose headers are read.
class PictureDecoder {
public:
    virtual ~PictureDecoder() = default;

    std::vector<EncodedHeader> parts;  ///< at least one

    /// Decodes a region without gaps: codes from 0 to 255, or numbers of which 1 is white.
    virtual Outcome read(const EncodedRegion& region, std::uint8_t* pixels) = 0;
    virtual Outcome read(const EncodedRegion& region, float* pixels) = 0;
};

/// Opens the file `path`, or, where it is empty, the bytes of one, which have to outlive the result. `format`: as
/// OpenImageIO names it. Throws Error, with the reason alone.
std::unique_ptr<PictureDecoder> open_decoder(const std::string& format, const std::string& path,
                                             std::span<const std::uint8_t> bytes);

/// A picture that is to be encoded.
struct EncodedPicture {
    struct Channel {
        std::string name;
        bool is_number = false;  ///< uint32, not float
    };

    std::string format;
    int width = 0, height = 0;
    std::vector<Channel> channels;  ///< empty: red, green and blue in codes of 8 bits
    std::vector<std::pair<std::string, std::variant<std::string, float, std::array<float, 2>>>> attributes;
};

/// Takes the rows of a picture, from the first to the last.
class PictureEncoder {
public:
    virtual ~PictureEncoder() = default;

    /// Rows from `first` to `end`, without gaps: codes, or four bytes for each channel.
    virtual Outcome write(int first, int end, const void* pixels) = 0;
    /// After the last row.
    virtual Outcome close() = 0;
};

/// Begins to write `picture` into `file`, which has to outlive the result. Throws Error, with the reason alone.
std::unique_ptr<PictureEncoder> open_encoder(const EncodedPicture& picture, UnfinishedFile& file);

/// The first line of what OpenImageIO says.
inline std::string first_line(const std::string& said) {
    return said.substr(0, said.find('\n'));
}

/// The same for the end of a message, unless OpenImageIO's own formatting of it failed.
inline std::string reason(const std::string& said) {
    const std::string line = first_line(said);
    return line.empty() || line.find("fixme") != std::string::npos ? "" : " (" + line + ")";
}

}  // namespace realcam::image_io
