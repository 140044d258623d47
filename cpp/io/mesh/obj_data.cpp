#include "obj_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "../text/printable.hpp"
#include "../text/text_lines.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

using Indices = std::vector<std::uint32_t>;

/// Assigns indices to names in the order of their first use.
class Names {
public:
    explicit Names(std::vector<std::string>& names) : names_(names) {}

    /// Returns the index of a name.
    std::uint32_t index_of(std::string_view name) {
        const auto found = indices_.find(name);
        if (found != indices_.end()) return found->second;
        names_.emplace_back(name);
        return indices_.emplace(name, static_cast<std::uint32_t>(names_.size() - 1)).first->second;
    }

private:
    std::vector<std::string>& names_;
    std::map<std::string, std::uint32_t, std::less<>> indices_;
};

/// References to one of the three lists of elements: positions, texture coordinates or normals. A face may refer to
/// elements that follow it in the file, so that references are checked at the end.
struct References {
    const char* name;  ///< name of an element, for messages
    std::uint64_t largest = 0;  ///< largest number in a reference, counted from 1
    std::size_t largest_line = 0;  ///< line with that reference
};

/// Removes a comment from numbers. Not used for names: "Material #25" is a material's name in 3ds Max.
std::string_view without_comment(std::string_view numbers) {
    return trimmed(numbers.substr(0, numbers.find('#')));
}

/// Implementation of read_obj_data.
class ObjParser {
public:
    ObjParser(const std::string& path, double scale, Checkpoint& checkpoint)
        : path_(path), scale_(scale), checkpoint_(checkpoint), lines_(path, checkpoint) {}

    ObjData parse() {
        group_ = groups_.index_of("");
        std::string_view line;
        while (lines_.next(line)) {
            checkpoint_.pass();
            line = trimmed(line);
            if (!line.empty() && line[0] != '#') parse_statement(line);
        }
        check_references();
        return std::move(out_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const { fail(lines_.number(), message); }
    [[noreturn]] void fail(std::size_t line, const std::string& message) const {
        throw SceneFileError(path_ + ": line " + std::to_string(line) + ": " + message);
    }

    /// Parses a line. Unsupported statements, such as curves, are ignored.
    void parse_statement(std::string_view line) {
        std::string_view arguments = line;
        const std::string_view keyword = consume_word(arguments);
        if (keyword == "v")
            parse_position(without_comment(arguments));
        else if (keyword == "vt")
            parse_uv(without_comment(arguments));
        else if (keyword == "vn")
            parse_normal(without_comment(arguments));
        else if (keyword == "f" || keyword == "fo")
            parse_face(without_comment(arguments));
        else if (keyword == "o" || keyword == "g")
            group_ = groups_.index_of(printable(arguments));
        else if (keyword == "s")
            parse_smoothing(without_comment(arguments));
        else if (keyword == "usemtl")
            material_ = materials_.index_of(arguments);
        else if (keyword == "mtllib")
            libraries_.index_of(arguments);
    }

    /// Parses at most seven numbers and returns their count, which must be at least `min_count`.
    std::size_t parse_numbers(std::string_view text, std::array<double, 7>& numbers, std::size_t min_count) {
        std::size_t count = 0;
        while (count < numbers.size() && !text.empty()) {
            std::string_view word = text;
            const std::optional<double> value = consume_number(text);
            if (!value || !(text.empty() || text[0] == ' ' || text[0] == '\t'))
                fail("expected a number, not " + in_quotes(consume_word(word)));
            numbers[count++] = *value;
            text = trimmed(text);
        }
        if (count < min_count) fail("expected " + std::to_string(min_count) + " numbers, not " + std::to_string(count));
        return count;
    }

    /// Parses x y z, x y z w, x y z r g b or x y z r g b a.
    void parse_position(std::string_view numbers) {
        std::array<double, 7> n{};
        const std::size_t count = parse_numbers(numbers, n, 3);
        Vec3d p = {n[0], n[1], n[2]};
        if (count == 4 && n[3] != 0) p = (1 / n[3]) * p;  // homogeneous
        if (!in_reach(scale_ * p)) fail(coordinates_error({n[0], n[1], n[2]}));
        // Vertices without a colour are white in a file that has colours.
        if (count >= 6 && out_.colours.empty()) out_.colours.resize(out_.positions.size());
        out_.positions.push_back(p);
        if (count < 6 && out_.colours.empty()) return;
        const auto f = [](double v) { return static_cast<float>(v); };
        out_.colours.push_back(count < 6 ? VertexColor{}
                                         : VertexColor{{f(n[3]), f(n[4]), f(n[5])}, count == 7 ? f(n[6]) : 1.0f});
    }

    /// Parses a smoothing group. "off" and 0 are flat, and so are faces before the first such line. ZBrush writes the
    /// keyword alone to switch smoothing on.
    void parse_smoothing(std::string_view argument) {
        out_.has_smoothing = true;
        const std::string_view word = consume_word(argument);
        std::string_view number = word;
        const std::optional<std::int64_t> group = consume_integer(number);
        constexpr std::int64_t kMaxGroup = 0xfffffffe;  // kSmoothByAngle is the next number
        if (word == "off")
            smoothing_ = 0;
        else
            smoothing_ = static_cast<std::uint32_t>(group ? std::clamp<std::int64_t>(*group, 0, kMaxGroup) : 1);
    }

    void parse_uv(std::string_view numbers) {
        std::array<double, 7> n{};
        parse_numbers(numbers, n, 1);
        out_.uvs.push_back({static_cast<float>(n[0]), static_cast<float>(n[1])});
    }

    void parse_normal(std::string_view numbers) {
        std::array<double, 7> n{};
        parse_numbers(numbers, n, 3);
        out_.normals.push_back({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
    }

    void parse_face(std::string_view corners) {
        const std::size_t first = out_.corner_positions.size();
        while (!corners.empty()) {
            checkpoint_.pass();
            parse_corner(corners);
        }
        const std::size_t count = out_.corner_positions.size() - first;
        if (out_.corner_positions.size() >= ObjData::kNone) fail("there are more than 4294967294 corners of faces");
        if (count < 3) {
            if (count > 0) ++out_.short_faces;
            for (Indices* list : {&out_.corner_positions, &out_.corner_uvs, &out_.corner_normals})
                if (list->size() > first) list->resize(first);
            return;
        }
        const ObjData::Run run{static_cast<std::uint32_t>(out_.face_ends.size()), material_, group_, smoothing_};
        if (out_.runs.empty() || !run.continues(out_.runs.back())) out_.runs.push_back(run);
        out_.face_ends.push_back(static_cast<std::uint32_t>(out_.corner_positions.size()));
    }

    /// Parses v, v/vt, v//vn or v/vt/vn, and removes it and the blanks behind it from `text`.
    void parse_corner(std::string_view& text) {
        const std::string_view start = text;
        const auto fail_form = [&] {
            std::string_view word = start;
            fail("a corner is v, v/vt, v//vn or v/vt/vn, not " + in_quotes(consume_word(word)));
        };
        std::array<std::optional<std::int64_t>, 3> numbers;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool may_be_absent = i == 1 && text.starts_with('/');
            if (!may_be_absent) {
                numbers[i] = consume_integer(text);
                if (!numbers[i]) fail_form();
            }
            if (!text.starts_with('/')) break;
            if (i == 2) fail_form();
            text.remove_prefix(1);
            // "1/" and "1//" are read as "1".
            if (text.empty() || text[0] == ' ' || text[0] == '\t') break;
        }
        if (!text.empty() && text[0] != ' ' && text[0] != '\t') fail_form();
        text = trimmed(text);
        out_.corner_positions.push_back(resolved(*numbers[0], out_.positions.size(), references_[0]));
        add_optional(out_.corner_uvs, numbers[1], out_.uvs.size(), references_[1]);
        add_optional(out_.corner_normals, numbers[2], out_.normals.size(), references_[2]);
    }

    /// Appends the index of an optional reference for the last corner; kNone if it is absent. `so_far`: number of
    /// elements of the list before this line.
    void add_optional(Indices& list, const std::optional<std::int64_t>& number, std::size_t so_far, References& kind) {
        if (!number && list.empty()) return;
        list.resize(out_.corner_positions.size() - 1, ObjData::kNone);
        list.push_back(number ? resolved(*number, so_far, kind) : ObjData::kNone);
    }

    /// Returns the index of a reference: positive numbers count from 1 at the beginning of the file, negative ones
    /// backwards from this line.
    std::uint32_t resolved(std::int64_t number, std::size_t so_far, References& kind) {
        if (number == 0) fail(std::string(kind.name) + " 0 does not exist; numbers begin with 1");
        if (number < 0) {
            if (number < -static_cast<std::int64_t>(so_far))
                fail(std::string(kind.name) + ' ' + std::to_string(number) + " does not exist; there are " +
                     std::to_string(so_far) + " before this line");
            return static_cast<std::uint32_t>(static_cast<std::int64_t>(so_far) + number);
        }
        if (static_cast<std::uint64_t>(number) > kind.largest) {
            kind.largest = static_cast<std::uint64_t>(number);
            kind.largest_line = lines_.number();
        }
        return number < ObjData::kNone ? static_cast<std::uint32_t>(number - 1) : ObjData::kNone - 1;
    }

    /// Throws if a reference is out of range, and completes the lists of optional references.
    void check_references() {
        const std::size_t counts[] = {out_.positions.size(), out_.uvs.size(), out_.normals.size()};
        for (std::size_t i = 0; i < 3; ++i) {
            if (counts[i] >= ObjData::kNone)
                throw SceneFileError(path_ + ": there are more than 4294967294 lines of one kind");
            if (references_[i].largest > counts[i])
                fail(references_[i].largest_line, std::string(references_[i].name) + ' ' +
                                                      std::to_string(references_[i].largest) +
                                                      " does not exist; there are " + std::to_string(counts[i]));
        }
        for (Indices* list : {&out_.corner_uvs, &out_.corner_normals})
            if (!list->empty()) list->resize(out_.corner_positions.size(), ObjData::kNone);
    }

    const std::string& path_;
    double scale_;
    Checkpoint& checkpoint_;
    TextLines lines_;
    ObjData out_;
    Names groups_{out_.groups}, materials_{out_.materials}, libraries_{out_.libraries};
    std::array<References, 3> references_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
    std::uint32_t group_ = 0, material_ = ObjData::kNone, smoothing_ = 0;
};

}  // namespace

ObjData read_obj_data(const std::string& path, double scale, Checkpoint& checkpoint) {
    return ObjParser(path, scale, checkpoint).parse();
}

}  // namespace realcam::io
