#include "mtl_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "../../error.hpp"
#include "../scene/mtl_picture.hpp"
#include "../text/printable.hpp"
#include "../text/text_lines.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

constexpr double kLargestFloat = std::numeric_limits<float>::max();

/// Statement with a colour.
struct ColourKey {
    std::string_view name;
    Vec3f MtlMaterial::* member;
};
constexpr ColourKey kColours[] = {{"Ka", &MtlMaterial::Ka},
                                  {"Kd", &MtlMaterial::Kd},
                                  {"Ks", &MtlMaterial::Ks},
                                  {"Ke", &MtlMaterial::Ke},
                                  {"Tf", &MtlMaterial::Tf}};

/// Range of valid numbers.
struct NumberRange {
    double min, max;
};
constexpr NumberRange kUnitRange{0, 1};

/// Statement with a number.
struct NumberKey {
    std::string_view name;
    std::variant<float MtlMaterial::*, std::optional<float> MtlMaterial::*> member;
    NumberRange range;
};
constexpr NumberKey kNumbers[] = {{"Ns", &MtlMaterial::Ns, {0, kLargestFloat}}, {"Ni", &MtlMaterial::Ni, {0.001, 10}},
                                  {"Pr", &MtlMaterial::Pr, kUnitRange},         {"Pm", &MtlMaterial::Pm, kUnitRange},
                                  {"Pc", &MtlMaterial::Pc, kUnitRange},         {"Pcr", &MtlMaterial::Pcr, kUnitRange}};

/// Statement with a texture.
struct PictureKey {
    std::string_view name;
    FileTexture MtlMaterial::* member;
};
constexpr PictureKey kPictures[] = {
    {"map_Kd", &MtlMaterial::map_Kd},       {"map_Ks", &MtlMaterial::map_Ks}, {"map_Ke", &MtlMaterial::map_Ke},
    {"map_emissive", &MtlMaterial::map_Ke}, {"map_d", &MtlMaterial::map_d},   {"map_Ns", &MtlMaterial::map_Ns},
    {"map_Pr", &MtlMaterial::map_Pr},       {"map_Pm", &MtlMaterial::map_Pm}, {"bump", &MtlMaterial::bump},
    {"map_bump", &MtlMaterial::bump},       {"norm", &MtlMaterial::norm}};

/// Statement without support.
struct OtherKey {
    std::string_view name;
};
/// Unsupported statements that change a surface's appearance. They are ignored without a warning if their number is 0.
constexpr OtherKey kNotModelled[] = {{"refl"},   {"map_refl"}, {"disp"},      {"map_disp"},   {"decal"}, {"Ps"},
                                     {"map_Ps"}, {"aniso"},    {"map_aniso"}, {"map_anisor"}, {"map_Tr"}};

/// Statements that a path tracer does not need.
constexpr OtherKey kNotNeeded[] = {{"map_Ka"}, {"map_aat"}, {"sharpness"}};

bool equal_without_case(std::string_view a, std::string_view b) {
    const auto lower = [](unsigned char c) { return std::tolower(c); };
    return std::ranges::equal(a, b, {}, lower, lower);
}

/// Finds a statement by its keyword, ignoring case, which differs between programs; null if there is none.
template <class Keys>
auto find_key(const Keys& keys, std::string_view name) -> decltype(&keys[0]) {
    for (const auto& key : keys)
        if (equal_without_case(key.name, name)) return &key;
    return nullptr;
}

/// Removes a word from the beginning of `text` and returns it as a number; std::nullopt if the word is not a number.
std::optional<double> take_number_word(std::string_view& text) {
    std::string_view word = consume_word(text);
    const std::optional<double> value = consume_number(word);
    return word.empty() ? value : std::nullopt;
}

/// Counter of lines with the same error: a warning states the first line and the number of others.
struct LineCount {
    std::size_t count = 0;
    std::size_t first = 0;  ///< number of the first line

    void add(std::size_t line) {
        if (count++ == 0) first = line;
    }
    /// Returns ", nor 3 others" for the conjunction "nor"; empty if there is only one line.
    std::string others(const std::string& conjunction) const {
        return count > 1 ? ", " + conjunction + ' ' + std::to_string(count - 1) + " others" : "";
    }
};

/// Returns the names, separated by commas.
template <class Text>
std::string joined(const std::set<Text>& names) {
    std::string out;
    for (const std::string_view name : names) out += (out.empty() ? "" : ", ") + std::string(name);
    return out;
}

/// Implementation of read_mtl.
class MtlReader {
public:
    MtlReader(FileScene& scene, const std::string& path, Checkpoint& checkpoint)
        : scene_(scene), path_(path), checkpoint_(checkpoint), lines_(path, checkpoint) {}

    void read() {
        const std::size_t first = scene_.materials.size();
        std::string_view line;
        while (lines_.next(line)) {
            checkpoint_.pass();
            line = trimmed(line);
            if (!line.empty() && line[0] != '#') read_statement(line);
        }
        add_warnings();
        resolve_transparencies();
        replace_black_textured_colours(first);
    }

private:
    /// Adds one warning to the scene for each kind of problem.
    void add_warnings() {
        const auto warn = [&](const std::string& text) { scene_.warnings.push_back(printable(path_) + ": " + text); };
        const auto line = [](const LineCount& lines) { return "line " + std::to_string(lines.first); };
        if (unread_.count > 0) warn(line(unread_) + " cannot be read" + unread_.others("nor") + "; they are left out");
        if (out_of_range_.count > 0)
            warn(line(out_of_range_) + " has a number out of its range" + out_of_range_.others("as have") +
                 "; the nearest number in the range is used");
        if (before_newmtl_ > 0)
            warn(std::to_string(before_newmtl_) + " lines precede the first \"newmtl\"; they are left out");
        if (!not_modelled_.empty())
            warn(joined(not_modelled_) + (not_modelled_.size() > 1 ? " are" : " is") + " not modelled");
        if (!unknown_.empty())
            warn(joined(unknown_) + (unknown_.size() > 1 ? " are unknown statements" : " is an unknown statement"));
        if (skipped_options_ > 0)
            warn(std::to_string(skipped_options_) + " options of pictures are skipped (" + joined(option_names_) + ")");
    }

    /// Reads a line, without blanks around it. Unknown statements are collected for one warning.
    void read_statement(std::string_view line) {
        std::string_view arguments = line;
        const std::string_view keyword = consume_word(arguments);
        if (equal_without_case(keyword, "newmtl")) return begin_material(arguments);
        const ColourKey* colour = find_key(kColours, keyword);
        const NumberKey* number = find_key(kNumbers, keyword);
        const PictureKey* picture = find_key(kPictures, keyword);
        const OtherKey* other = find_key(kNotModelled, keyword);
        const bool is_d = equal_without_case(keyword, "d"), is_dissolve = is_d || equal_without_case(keyword, "Tr"),
                   is_illum = equal_without_case(keyword, "illum");
        if (!colour && !number && !picture && !other && !is_dissolve && !is_illum) {
            // Limits of the warning: number of keywords, and characters of each.
            constexpr std::size_t kMaxShown = 10, kMaxLength = 40;
            if (!find_key(kNotNeeded, keyword) && unknown_.size() < kMaxShown)
                unknown_.insert(in_quotes(std::string(keyword.substr(0, kMaxLength))));
            return;
        }
        if (!material_) {
            ++before_newmtl_;
            return;
        }
        if (colour) read_colour(*colour, arguments);
        if (number) read_number(*number, arguments);
        if (picture) read_picture(*picture, arguments);
        if (other && take_number_word(arguments) != 0) not_modelled_.insert(other->name);
        if (is_dissolve) read_dissolve(is_d, keyword, arguments);
        if (is_illum) read_illum(arguments);
    }

    /// Decides the meaning of Tr for materials without `d`. As a transparency, a Tr near 1 would make a surface
    /// invisible: in a file that has one, Tr is an opacity. For the same reason, a Tr of 0 stays opaque.
    void resolve_transparencies() {
        constexpr float kInvisible = 0.95f;
        const bool is_opacity =
            std::ranges::any_of(transparencies_, [](const auto& t) { return t.second > kInvisible; });
        if (!is_opacity) return;
        for (const auto& [material, value] : transparencies_)
            if (value > 0) std::get<MtlMaterial>(scene_.materials[material].content).d = value;
        scene_.warnings.push_back(
            printable(path_) +
            ": Tr without d is near 1, which as a transparency would make the surface invisible; Tr is read as an "
            "opacity, as MeshLab writes it");
    }

    /// Replaces a black Kd beside a texture, which Maya and other programs write, by white. `first`: index of the
    /// file's first material.
    void replace_black_textured_colours(std::size_t first) {
        std::size_t count = 0;
        for (std::size_t i = first; i < scene_.materials.size(); ++i) {
            auto& material = std::get<MtlMaterial>(scene_.materials[i].content);
            if (!material.map_Kd || material.Kd != Vec3f{0, 0, 0}) continue;
            material.Kd = {1, 1, 1};
            ++count;
        }
        if (count > 0)
            scene_.warnings.push_back(printable(path_) + ": Kd is 0 0 0 beside a map_Kd in " + std::to_string(count) +
                                      (count == 1 ? " material" : " materials") + "; the texture's colours are used");
    }

    void begin_material(std::string_view name) {
        scene_.materials.push_back({std::string(name), MtlMaterial{}});
        material_ = &std::get<MtlMaterial>(scene_.materials.back().content);
        has_illum_ = has_d_ = false;
    }

    /// Reads red, green and blue, or one number for all of them.
    void read_colour(const ColourKey& key, std::string_view arguments) {
        std::array<double, 3> values{};
        std::size_t count = 0;
        for (; count < 3 && !arguments.empty(); ++count) {
            const std::optional<double> value = take_number_word(arguments);
            if (!value) break;
            values[count] = checked(*value, key.name);
        }
        if (count == 1 && arguments.empty()) values[1] = values[2] = values[0], count = 3;
        if (count < 3) return unread_.add(lines_.number());
        material_->*key.member = {static_cast<float>(values[0]), static_cast<float>(values[1]),
                                  static_cast<float>(values[2])};
        if (key.member == &MtlMaterial::Ks && !has_illum_) material_->illum = 2;
    }

    void read_number(const NumberKey& key, std::string_view arguments) {
        const std::optional<float> value = number_of(key.name, arguments, key.range);
        if (value) std::visit([&](auto member) { material_->*member = *value; }, key.member);
    }

    /// Reads `d` or Tr. Programs differ in the meaning of Tr: beside a `d` it is ignored. Alone it is a transparency by
    /// the format's definition, and an opacity as MeshLab and others write it (see resolve_transparencies).
    void read_dissolve(bool is_d, std::string_view keyword, std::string_view arguments) {
        if (arguments.starts_with("-halo")) {
            consume_word(arguments);
            not_modelled_.insert("d -halo");
        }
        const std::size_t out_of_range = out_of_range_.count;
        const std::optional<float> value = number_of(keyword, arguments, kUnitRange);
        if (!value) return;
        if (is_d) {
            material_->d = *value;
            transparencies_.erase(scene_.materials.size() - 1);
        } else if (!has_d_) {
            material_->d = 1 - *value;
            if (out_of_range == out_of_range_.count) transparencies_[scene_.materials.size() - 1] = *value;
        }
        has_d_ |= is_d;
    }

    void read_illum(std::string_view arguments) {
        const std::optional<double> value = take_number_word(arguments);
        if (!value || !(*value >= 0 && *value <= 10) || *value != std::floor(*value))
            return unread_.add(lines_.number());
        material_->illum = static_cast<int>(*value);
        has_illum_ = true;
    }

    void read_picture(const PictureKey& key, std::string_view arguments) {
        const std::optional<MtlPicture> parsed = parse_mtl_picture(arguments);
        if (!parsed) return unread_.add(lines_.number());
        const bool is_bump = key.member == &MtlMaterial::bump;
        if (!parsed->transform.is_finite() || !(std::abs(parsed->bm) <= kLargestFloat))
            fail(std::string(key.name) + ": the numbers of -s, -o and -bm must be finite");
        if (is_bump) material_->bm = static_cast<float>(parsed->bm);
        for (const std::string_view option : parsed->other_options) skip_option(option);
        if (parsed->has_bm && !is_bump) skip_option("-bm");
        FileTexture& texture = material_->*key.member;
        texture.picture = picture_of(std::string(parsed->name));
        texture.transform = parsed->transform;
        // With -clamp the format has one copy of the picture, and does not define the surface outside: as in other
        // programs, the edge of the picture is continued.
        const TextureWrap wrap = parsed->clamps ? TextureWrap::clamp : TextureWrap::repeat;
        texture.sampler = {wrap, wrap, TextureFilter::linear};
    }

    /// Returns the index of a picture in the scene, adding it on first use.
    std::int32_t picture_of(const std::string& name) {
        const auto [picture, is_new] = pictures_.emplace(name, static_cast<std::int32_t>(scene_.pictures.size()));
        if (is_new) scene_.pictures.push_back({name, false, {}});
        return picture->second;
    }

    /// Counts an unsupported option.
    void skip_option(std::string_view name) {
        ++skipped_options_;
        option_names_.insert(name);
    }

    /// Returns a statement's number, clamped to its range; std::nullopt, after counting the line, if there is none.
    std::optional<float> number_of(std::string_view keyword, std::string_view arguments, NumberRange range) {
        const std::optional<double> value = take_number_word(arguments);
        if (!value) {
            unread_.add(lines_.number());
            return std::nullopt;
        }
        const double clamped = std::clamp(checked(*value, keyword), range.min, range.max);
        if (clamped != *value) out_of_range_.add(lines_.number());
        return static_cast<float>(clamped);
    }

    /// Returns a value, which must be finite and not negative.
    double checked(double value, std::string_view keyword) const {
        // The limit on the brightness of lights is checked for all formats in one function.
        if (value >= 0 && value <= kLargestFloat) return value;
        fail(std::string(keyword) + " must be finite and not negative");
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw SceneFileError(path_ + ": line " + std::to_string(lines_.number()) + ": " + message);
    }

    FileScene& scene_;
    const std::string& path_;
    Checkpoint& checkpoint_;
    TextLines lines_;
    MtlMaterial* material_ = nullptr;  // the last of scene_.materials
    bool has_illum_ = false, has_d_ = false;  // true if the material has this statement
    std::map<std::string, std::int32_t> pictures_;  // index in scene_.pictures by file name
    LineCount unread_, out_of_range_;
    std::set<std::string> unknown_;
    std::map<std::size_t, float> transparencies_;  // Tr of the materials without d, by index
    std::size_t before_newmtl_ = 0, skipped_options_ = 0;
    std::set<std::string_view> not_modelled_, option_names_;  // names in the tables above, which outlive this object
};

}  // namespace

void read_mtl(FileScene& scene, const std::string& path, Checkpoint& checkpoint) {
    MtlReader(scene, path, checkpoint).read();
}

}  // namespace realcam::io
