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

    std::uint32_t number(std::string_view name) {
        const auto found = numbers_.find(name);
        if (found != numbers_.end()) return found->second;
        names_.emplace_back(name);
        return numbers_.emplace(name, static_cast<std::uint32_t>(names_.size() - 1)).first->second;
    }

private:
    std::vector<std::string>& names_;
    std::map<std::string, std::uint32_t, std::less<>> numbers_;
};

/// One of the three lists that faces refer to. A face may refer to elements that follow it, so whether they exist is
/// known only at the end of the file.
struct Referred {
    const char* name;
    std::uint64_t farthest = 0;  ///< largest index in a reference, from 1
    std::size_t farthest_line = 0;
};

/// Removes a comment from numbers. Not used for names: "Material #25" is a material's name in 3ds Max.
std::string_view without_comment(std::string_view numbers) {
    return trimmed(numbers.substr(0, numbers.find('#')));
}

class ObjParser {
public:
    ObjParser(const std::string& path, double scale, Checkpoint& checkpoint)
        : path_(path), scale_(scale), checkpoint_(checkpoint), lines_(path, checkpoint) {}

    ObjData parse() {
        group_ = groups_.number("");
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

    /// Parses a statement. Others that OBJ has, such as curves, are ignored.
    void parse_statement(std::string_view rest) {
        const std::string_view keyword = take_word(rest);
        if (keyword == "v")
            parse_position(without_comment(rest));
        else if (keyword == "vt")
            parse_uv(without_comment(rest));
        else if (keyword == "vn")
            parse_normal(without_comment(rest));
        else if (keyword == "f" || keyword == "fo")
            parse_face(without_comment(rest));
        else if (keyword == "o" || keyword == "g")
            group_ = groups_.number(printable(rest));
        else if (keyword == "s")
            parse_smoothing(without_comment(rest));
        else if (keyword == "usemtl")
            material_ = materials_.number(rest);
        else if (keyword == "mtllib")
            libraries_.number(rest);
    }

    /// Reads the numbers of a line, at most seven, and returns how many.
    std::size_t take_numbers(std::string_view rest, std::array<double, 7>& numbers, std::size_t least) {
        std::size_t count = 0;
        while (count < numbers.size() && !rest.empty()) {
            const std::string_view word = rest;
            const std::optional<double> value = take_number(rest);
            if (!value || !(rest.empty() || rest[0] == ' ' || rest[0] == '\t')) {
                std::string_view shown = word;
                fail("expected a number, not " + in_quotes(take_word(shown)));
            }
            numbers[count++] = *value;
            rest = trimmed(rest);
        }
        if (count < least) fail("expected " + std::to_string(least) + " numbers, not " + std::to_string(count));
        return count;
    }

    void parse_position(std::string_view rest) {
        std::array<double, 7> n{};
        const std::size_t count = take_numbers(rest, n, 3);
        Vec3d p = {n[0], n[1], n[2]};
        if (count == 4 && n[3] != 0) p = (1 / n[3]) * p;  // homogeneous
        if (!in_reach(scale_ * p)) fail(why_out_of_reach({n[0], n[1], n[2]}));
        // Vertices without a colour are white in a file that has colours.
        if (count >= 6 && out_.colours.empty()) out_.colours.resize(out_.positions.size());
        out_.positions.push_back(p);
        if (count < 6 && out_.colours.empty()) return;
        const auto f = [](double v) { return static_cast<float>(v); };
        out_.colours.push_back(count < 6 ? VertexColor{}
                                         : VertexColor{{f(n[3]), f(n[4]), f(n[5])}, count == 7 ? f(n[6]) : 1.0f});
    }

    /// Reads a smoothing group. "off" and 0 are flat, and so are faces before the first such line. ZBrush writes the
    /// keyword alone for on.
    void parse_smoothing(std::string_view rest) {
        out_.has_smoothing = true;
        const std::string_view word = take_word(rest);
        std::string_view number = word;
        const std::optional<std::int64_t> group = take_integer(number);
        constexpr std::int64_t kMost = 0xfffffffe;
        if (word == "off")
            smoothing_ = 0;
        else
            smoothing_ = static_cast<std::uint32_t>(group ? std::clamp<std::int64_t>(*group, 0, kMost) : 1);
    }

    void parse_uv(std::string_view rest) {
        std::array<double, 7> n{};
        take_numbers(rest, n, 1);
        out_.uvs.push_back({static_cast<float>(n[0]), static_cast<float>(n[1])});
    }

    void parse_normal(std::string_view rest) {
        std::array<double, 7> n{};
        take_numbers(rest, n, 3);
        out_.normals.push_back({static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
    }

    void parse_face(std::string_view rest) {
        const std::size_t first = out_.corner_positions.size();
        while (!rest.empty()) {
            checkpoint_.pass();
            parse_corner(rest);
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

    // Reads v, v/vt, v//vn or v/vt/vn, and the blanks behind it.
    void parse_corner(std::string_view& rest) {
        const std::string_view from = rest;
        const auto fail_form = [&] {
            std::string_view shown = from;
            fail("a corner is v, v/vt, v//vn or v/vt/vn, not " + in_quotes(take_word(shown)));
        };
        std::array<std::optional<std::int64_t>, 3> numbers;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool may_be_absent = i == 1 && rest.starts_with('/');
            if (!may_be_absent) {
                numbers[i] = take_integer(rest);
                if (!numbers[i]) fail_form();
            }
            if (!rest.starts_with('/')) break;
            if (i == 2) fail_form();
            rest.remove_prefix(1);
            // "1/" and "1//" are read as "1".
            if (rest.empty() || rest[0] == ' ' || rest[0] == '\t') break;
        }
        if (!rest.empty() && rest[0] != ' ' && rest[0] != '\t') fail_form();
        rest = trimmed(rest);
        out_.corner_positions.push_back(resolved(*numbers[0], out_.positions.size(), referred_[0]));
        add_optional(out_.corner_uvs, numbers[1], out_.uvs.size(), referred_[1]);
        add_optional(out_.corner_normals, numbers[2], out_.normals.size(), referred_[2]);
    }

    void add_optional(Indices& list, const std::optional<std::int64_t>& number, std::size_t so_far, Referred& kind) {
        if (!number && list.empty()) return;
        list.resize(out_.corner_positions.size() - 1, ObjData::kNone);
        list.push_back(number ? resolved(*number, so_far, kind) : ObjData::kNone);
    }

    /// Resolves a reference: positive numbers count from 1 at the beginning of the file, negative ones back from this
    /// line.
    std::uint32_t resolved(std::int64_t number, std::size_t so_far, Referred& kind) {
        if (number == 0) fail(std::string(kind.name) + " 0 does not exist; numbers begin with 1");
        if (number < 0) {
            if (number < -static_cast<std::int64_t>(so_far))
                fail(std::string(kind.name) + ' ' + std::to_string(number) + " does not exist; there are " +
                     std::to_string(so_far) + " before this line");
            return static_cast<std::uint32_t>(static_cast<std::int64_t>(so_far) + number);
        }
        if (static_cast<std::uint64_t>(number) > kind.farthest) {
            kind.farthest = static_cast<std::uint64_t>(number);
            kind.farthest_line = lines_.number();
        }
        return number < ObjData::kNone ? static_cast<std::uint32_t>(number - 1) : ObjData::kNone - 1;
    }

    void check_references() {
        const std::size_t counts[] = {out_.positions.size(), out_.uvs.size(), out_.normals.size()};
        for (std::size_t i = 0; i < 3; ++i) {
            if (counts[i] >= ObjData::kNone)
                throw SceneFileError(path_ + ": there are more than 4294967294 lines of one kind");
            if (referred_[i].farthest > counts[i])
                fail(referred_[i].farthest_line, std::string(referred_[i].name) + ' ' +
                                                     std::to_string(referred_[i].farthest) +
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
    std::array<Referred, 3> referred_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
    std::uint32_t group_ = 0, material_ = ObjData::kNone, smoothing_ = 0;
};

}  // namespace

ObjData read_obj_data(const std::string& path, double scale, Checkpoint& checkpoint) {
    return ObjParser(path, scale, checkpoint).parse();
}

}  // namespace realcam::io
