#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../files/regular_file.hpp"

namespace realcam::io {

struct PlyType {
    char kind;  // 'i', 'u' or 'f'
    std::size_t bytes;
};

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count_type;  // type of the length, if the property is a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian } format = Format::ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  // names in "comment TextureFile"
    std::size_t size = 0;  // in bytes; the data begin here
};

/// Parses the header. Throws SceneFileError with `path` and the line.
PlyHeader parse_ply_header(std::string_view text, const std::string& path);

/// PLY file, read piece by piece: its header, and the numbers after it, one after the other.
class PlyData {
public:
    /// Opens the file. Throws FileError, and SceneFileError for errors in the header.
    PlyData(const std::string& path, Checkpoint& checkpoint);

    const PlyHeader& header() const { return header_; }
    /// Returns the next number; std::nullopt at the end of the data, or if the data are not a number.
    std::optional<double> next(PlyType type) {
        if (end_ - begin_ < kLongestNumber && file_.left() > 0) read_more();
        return header_.format == PlyHeader::Format::ascii ? next_ascii() : next_binary(type);
    }
    std::uint64_t bytes_left() const { return end_ - begin_ + file_.left(); }
    /// Returns the least number of bytes that a number of a type occupies.
    std::size_t least_bytes(PlyType type) const { return header_.format == PlyHeader::Format::ascii ? 2 : type.bytes; }

private:
    /// Greatest length of a number, including blanks before it; longer ones are cut off.
    static constexpr std::size_t kLongestNumber = 1 << 12;

    void read_more();
    std::optional<double> next_ascii();
    std::optional<double> next_binary(PlyType type);

    Checkpoint& checkpoint_;
    RegularFile file_;
    PlyHeader header_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;  // range of the unread bytes in the buffer
};

}  // namespace realcam::io
