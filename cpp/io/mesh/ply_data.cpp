#include "ply_data.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

#include "../../error.hpp"
#include "../text/printable.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Returns the type of a name in a header; std::nullopt for other words.
std::optional<PlyType> type_of(const std::string& name) {
    struct Named {
        const char *name, *other_name;
        PlyType type;
    };
    static constexpr Named types[] = {{"char", "int8", {'i', 1}},     {"uchar", "uint8", {'u', 1}},
                                      {"short", "int16", {'i', 2}},   {"ushort", "uint16", {'u', 2}},
                                      {"int", "int32", {'i', 4}},     {"uint", "uint32", {'u', 4}},
                                      {"float", "float32", {'f', 4}}, {"double", "float64", {'f', 8}}};
    for (const Named& t : types) {
        if (name == t.name || name == t.other_name) return t.type;
    }
    return std::nullopt;
}

constexpr std::size_t kBlockBytes = 1 << 20;

/// Converts the first bytes, a number of type T, to a double.
template <class T>
double to_double(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
}

}  // namespace

PlyHeader parse_ply_header(std::string_view text, const std::string& path) {
    PlyHeader header;
    std::size_t line = 0;
    const auto fail = [&](const std::string& message) {
        throw SceneFileError(path + ": line " + std::to_string(line) + ": " + message);
    };
    const auto next_type = [&](std::istringstream& words) {
        std::string name;
        words >> name;
        const std::optional<PlyType> type = type_of(name);
        if (!type) fail("expected a type such as float or uchar, not " + in_quotes(name));
        return *type;
    };
    bool has_format = false;
    while (header.size < text.size()) {
        const std::size_t end = std::min(text.find('\n', header.size), text.size());
        std::istringstream words(std::string(text.substr(header.size, end - header.size)));
        header.size = std::min(end + 1, text.size());
        std::string word, argument;
        words >> word;
        if (++line == 1) {
            if (word != "ply") fail("expected \"ply\"");
        } else if (word == "format") {
            words >> argument;
            has_format = true;
            if (argument == "binary_little_endian")
                header.format = PlyHeader::Format::little_endian;
            else if (argument == "binary_big_endian")
                header.format = PlyHeader::Format::big_endian;
            else if (argument != "ascii")
                fail("expected ascii, binary_little_endian or binary_big_endian");
        } else if (word == "comment") {
            if (!(words >> argument) || argument != "TextureFile") continue;
            std::string& texture = header.textures.emplace_back();
            std::getline(words >> std::ws, texture);
            while (texture.ends_with('\r') || texture.ends_with(' ')) texture.pop_back();
            if (texture.empty()) header.textures.pop_back();
        } else if (word == "element") {
            PlyElement& element = header.elements.emplace_back();
            words >> element.name >> argument;
            std::string_view number = argument;
            const std::optional<std::int64_t> count = consume_integer(number);
            if (!count || !number.empty() || *count < 0)
                fail("expected \"element\", a name and a number of at least 0");
            element.count = static_cast<std::uint64_t>(*count);
        } else if (word == "property") {
            if (header.elements.empty()) fail("expected an element before its properties");
            PlyProperty property{{}, {}, std::nullopt};
            const auto start = words.tellg();
            if (words >> argument; argument == "list")
                property.count_type = next_type(words);
            else
                words.seekg(start);
            property.type = next_type(words);
            if (!(words >> property.name)) fail("expected the property's name");
            header.elements.back().properties.push_back(property);
        } else if (word == "end_header") {
            if (!has_format) fail("expected a line \"format\" before this one");
            return header;
        } else if (!word.empty() && word != "obj_info") {
            fail("expected \"element\", \"property\" or \"end_header\"");
        }
    }
    fail("the header has no end; expected a line \"end_header\"");
    return header;
}

PlyData::PlyData(const std::string& path, Checkpoint& checkpoint)
    : checkpoint_(checkpoint), file_(path), buffer_(kBlockBytes + kLongestNumber) {
    read_more();
    header_ = parse_ply_header({buffer_.data(), end_}, path);
    begin_ = header_.size;
}

void PlyData::read_more() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    const std::size_t n = file_.read(buffer_.data() + end_, std::min(kBlockBytes, buffer_.size() - end_));
    checkpoint_.pass(n / 64);
    end_ += n;
}

std::optional<double> PlyData::next_ascii() {
    const auto is_blank = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
    while (begin_ < end_ && is_blank(buffer_[begin_])) {
        ++begin_;
        if (begin_ == end_ && file_.left() > 0) read_more();
    }
    std::string_view text{buffer_.data() + begin_, end_ - begin_};
    const std::optional<double> value = consume_number(text);
    if (value) begin_ = end_ - text.size();
    return value;
}

std::optional<double> PlyData::next_binary(PlyType type) {
    if (end_ - begin_ < type.bytes) return std::nullopt;
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), buffer_.data() + begin_, type.bytes);
    begin_ += type.bytes;
    if (header_.format == PlyHeader::Format::big_endian)
        std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(type.bytes));
    if (type.kind == 'f') return type.bytes == 4 ? to_double<float>(bytes) : to_double<double>(bytes);
    const bool is_signed = type.kind == 'i';
    switch (type.bytes) {
        case 1: return is_signed ? to_double<std::int8_t>(bytes) : to_double<std::uint8_t>(bytes);
        case 2: return is_signed ? to_double<std::int16_t>(bytes) : to_double<std::uint16_t>(bytes);
        default: return is_signed ? to_double<std::int32_t>(bytes) : to_double<std::uint32_t>(bytes);
    }
}

namespace {

/// Replaces a list with one value per vertex by a list with one value per corner of the triangles.
template <class T>
void expand_to_corners(std::vector<T>& values, const std::vector<Triangle>& triangles, Checkpoint& checkpoint) {
    if (values.empty()) return;
    std::vector<T> out;
    out.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        checkpoint.pass();
        for (const std::uint32_t v : t.vertices) out.push_back(values[v]);
    }
    values = std::move(out);
}

}  // namespace

void apply_corners(Scene& scene, const PlyCorners& corners, Checkpoint& checkpoint) {
    if (corners.uvs.empty() && corners.colours.empty()) return;
    if (scene.triangles.size() > std::numeric_limits<std::uint32_t>::max() / 3)
        throw InputError("more than 1431655765 triangles");
    expand_to_corners(scene.positions_m, scene.triangles, checkpoint);
    expand_to_corners(scene.normals, scene.triangles, checkpoint);
    expand_to_corners(scene.uvs, scene.triangles, checkpoint);
    expand_to_corners(scene.colors, scene.triangles, checkpoint);
    if (!corners.uvs.empty()) scene.uvs = corners.uvs;
    if (!corners.colours.empty()) {
        scene.colors.clear();
        scene.colors.reserve(3 * corners.colours.size());
        for (const VertexColor& c : corners.colours) scene.colors.insert(scene.colors.end(), 3, c);
    }
    std::uint32_t corner = 0;
    for (Triangle& t : scene.triangles)
        for (std::uint32_t& v : t.vertices) v = corner++;
}

}  // namespace realcam::io
