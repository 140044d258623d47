#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"
#include "../../scene/scene_view.hpp"
#include "../files/regular_file.hpp"

namespace realcam::io {

// Header and numbers of PLY files, and the meaning of their properties, for ply_file.cpp.

/// Attributes that the faces of a PLY give to their own corners, in the order of the triangles.
struct PlyCorners {
    std::vector<Vec2f> uvs;            ///< three per triangle, or empty
    std::vector<VertexColor> colours;  ///< one per triangle, or empty
};

/// Gives each triangle three vertices of its own, with the attributes from its face. Equal vertices are merged later
/// (clean_geometry).
void apply_corners(Scene& scene, const PlyCorners& corners, Checkpoint& checkpoint);

/// Type of a number.
struct PlyType {
    char kind;  ///< 'i', 'u' or 'f': signed integer, unsigned integer or floating-point
    std::size_t bytes;
};

/// Property of an element: a number or a list.
struct PlyProperty {
    std::string name;
    PlyType type;  ///< type of the number, or of the numbers in the list
    std::optional<PlyType> count_type;  ///< type of the list's length; std::nullopt: the property is a single number
};

/// Kind of elements, such as "vertex" or "face".
struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

/// Header of a PLY file.
struct PlyHeader {
    enum class Format { ascii, little_endian, big_endian } format = Format::ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  ///< names in "comment TextureFile"
    std::size_t size = 0;  ///< in bytes; the data begin here
};

/// Parses the header at the beginning of `text`. Throws SceneFileError with `path` and the line.
PlyHeader parse_ply_header(std::string_view text, const std::string& path);

/// PLY file, read block by block: its header, and the numbers after it, one after the other.
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
    /// Number of bytes of the file that have not been read.
    std::uint64_t bytes_left() const { return end_ - begin_ + file_.left(); }
    /// Returns the least number of bytes that a number of a type occupies, in ASCII a digit and a blank.
    std::size_t min_bytes(PlyType type) const { return header_.format == PlyHeader::Format::ascii ? 2 : type.bytes; }

private:
    /// Greatest length of a number in ASCII, including blanks before it; longer numbers are truncated.
    static constexpr std::size_t kLongestNumber = 1 << 12;

    /// Reads the next block of the file.
    void read_more();
    std::optional<double> next_ascii();
    std::optional<double> next_binary(PlyType type);

    Checkpoint& checkpoint_;
    RegularFile file_;
    PlyHeader header_;
    std::vector<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;  ///< range of the unread bytes in the buffer
};

}  // namespace realcam::io

namespace realcam::io::ply_detail {

/// Properties of a vertex or a face that are read, as indices in PlyNumbers; `unread` stands for all others.
enum PlySlot : std::size_t { x, y, z, nx, ny, nz, u, v, red, green, blue, alpha, slot_count, unread = slot_count };

/// Values of one vertex or face, by PlySlot.
using PlyNumbers = std::array<double, slot_count + 1>;

/// Returns the slot of a property; up to three names for it are in use.
inline PlySlot slot_of(std::string_view name) {
    static constexpr std::string_view names[][slot_count] = {
        {"x", "y", "z", "nx", "ny", "nz", "s", "t", "red", "green", "blue", "alpha"},
        {"", "", "", "", "", "", "u", "v", "diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
        {"", "", "", "", "", "", "texture_u", "texture_v", "r", "g", "b", "a"}};
    for (const auto& convention : names)
        for (std::size_t i = 0; i < slot_count; ++i)
            if (convention[i] == name) return static_cast<PlySlot>(i);
    return unread;
}

/// Returns, for each slot, true if an element has that property.
inline std::array<bool, slot_count + 1> slots_of(const PlyElement& element) {
    std::array<bool, slot_count + 1> has{};
    for (const PlyProperty& p : element.properties) has[p.count_type ? unread : slot_of(p.name)] = true;
    return has;
}

/// True if an element has a colour. `has`: see slots_of.
inline bool has_colour(const std::array<bool, slot_count + 1>& has) {
    return has[red] && has[green] && has[blue];
}

/// Converts a number in the file to a value: integer colours are fractions of the largest value of their type.
inline double value_of(PlySlot slot, PlyType type, double number) {
    if (slot < red || slot > alpha || type.kind == 'f') return number;
    const double value_count = static_cast<double>(std::size_t{1} << (8 * type.bytes - (type.kind == 'i' ? 1 : 0)));
    return number / (value_count - 1);
}

/// Returns the colour of a vertex or face, as encoded in the file.
inline VertexColor colour_of(const PlyNumbers& n, bool has_alpha) {
    const auto f = [&](PlySlot slot) { return static_cast<float>(n[slot]); };
    return {{f(red), f(green), f(blue)}, has_alpha ? f(alpha) : 1.0f};
}

}  // namespace realcam::io::ply_detail
