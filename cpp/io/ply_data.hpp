#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace realcam::io {

struct PlyType {
    char kind;  // 'i', 'u' or 'f'
    std::size_t bytes;
};

struct PlyProperty {
    std::string name;
    PlyType type;
    std::optional<PlyType> count_type;  // of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian } format = Format::ascii;
    std::vector<PlyElement> elements;
    std::string texture;  // of "comment TextureFile"
    std::size_t size = 0;  // in bytes; the data begin here
};

/// Throws SceneFileError with `path` and the line.
PlyHeader parse_ply_header(std::string_view text, const std::string& path);

/// The numbers after the header, one after the other.
class PlyData {
public:
    PlyData(std::string_view bytes, PlyHeader::Format format) : bytes_(bytes), format_(format) {}

    /// Nothing at the end of the data, or at what is no number.
    std::optional<double> next(PlyType type);
    std::size_t bytes_left() const { return bytes_.size(); }

private:
    std::string_view bytes_;
    PlyHeader::Format format_;
};

}  // namespace realcam::io
