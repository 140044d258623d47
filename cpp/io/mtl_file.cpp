#include "mtl_file.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "../error.hpp"
#include "printable.hpp"
#include "text_lines.hpp"
#include "text_number.hpp"

namespace realcam::io {
namespace {

struct ColourKey {
    std::string_view name;
    Vec3f MtlMaterial::* member;
};
constexpr ColourKey kColours[] = {{"Kd", &MtlMaterial::Kd}, {"Ks", &MtlMaterial::Ks}, {"Ke", &MtlMaterial::Ke}};

struct NumberKey {
    std::string_view name;
    float MtlMaterial::* member;
};
constexpr NumberKey kNumbers[] = {{"Ns", &MtlMaterial::Ns}, {"d", &MtlMaterial::d}};

struct PictureKey {
    std::string_view name;
    FileTexture MtlMaterial::* member;
};
constexpr PictureKey kPictures[] = {
    {"map_Kd", &MtlMaterial::map_Kd}, {"map_Ke", &MtlMaterial::map_Ke}, {"map_emissive", &MtlMaterial::map_Ke}};

/// How many words follow an option of a picture at most; beyond the first they are numbers, and may be absent.
constexpr std::pair<std::string_view, int> kOptions[] = {
    {"-blendu", 1}, {"-blendv", 1}, {"-boost", 1}, {"-bm", 1}, {"-cc", 1},     {"-clamp", 1}, {"-imfchan", 1},
    {"-mm", 2},     {"-o", 3},      {"-s", 3},     {"-t", 3},  {"-texres", 1}, {"-type", 1}};

template <class Keys>
auto find_key(const Keys& keys, std::string_view name) -> decltype(&keys[0]) {
    for (const auto& key : keys)
        if (key.name == name) return &key;
    return nullptr;
}

bool is_number(std::string_view word) {
    return take_number(word) && word.empty();
}

/// What is left of a line "map_Kd -s 2 2 wood.png" without its options.
std::string_view without_options(std::string_view rest) {
    while (rest.starts_with('-')) {
        std::string_view after = rest;
        const std::string_view name = take_word(after);
        int words = -1;
        for (const auto& [option, most] : kOptions)
            if (option == name) words = most;
        if (words < 0) return rest;
        for (int i = 0; i < words; ++i) {
            std::string_view behind = after;
            const std::string_view word = take_word(behind);
            if (i > 0 && !is_number(word)) break;
            after = behind;
        }
        rest = after;
    }
    return rest;
}

class MtlReader {
public:
    MtlReader(FileScene& scene, const std::string& path, Checkpoint& checkpoint)
        : scene_(scene), path_(path), checkpoint_(checkpoint), lines_(path, checkpoint) {}

    void read() {
        std::string_view line;
        while (lines_.next(line)) {
            checkpoint_.pass();
            line = trimmed(line);
            if (!line.empty() && line[0] != '#') read_statement(line);
        }
        if (unread_ > 0)
            scene_.warnings.push_back(printable(path_) + ": line " + std::to_string(first_unread_) + " cannot be read" +
                                      (unread_ > 1 ? ", nor " + std::to_string(unread_ - 1) + " others" : "") +
                                      "; they are left out");
        if (homeless_ > 0)
            scene_.warnings.push_back(printable(path_) + ": " + std::to_string(homeless_) +
                                      " lines stand before the first \"newmtl\"; they are left out");
    }

private:
    /// What else an MTL may say is left out.
    void read_statement(std::string_view rest) {
        const std::string_view keyword = take_word(rest);
        if (keyword == "newmtl") {
            scene_.materials.push_back({std::string(rest), MtlMaterial{}});
            material_ = &std::get<MtlMaterial>(scene_.materials.back().content);
            return;
        }
        const ColourKey* colour = find_key(kColours, keyword);
        const NumberKey* number = find_key(kNumbers, keyword);
        const PictureKey* picture = find_key(kPictures, keyword);
        const bool is_tr = keyword == "Tr";
        if (!colour && !number && !picture && !is_tr) return;
        if (!material_) {
            ++homeless_;
            return;
        }
        if (colour) read_colour(material_->*colour->member, keyword, rest);
        if (number) read_number(material_->*number->member, keyword, rest);
        if (picture) read_picture(material_->*picture->member, rest);
        float transparency = 1 - material_->d;
        if (is_tr && read_number(transparency, keyword, rest)) material_->d = 1 - transparency;
    }

    /// Red, green and blue, or one number for all of them.
    void read_colour(Vec3f& colour, std::string_view keyword, std::string_view rest) {
        std::array<double, 3> values{};
        std::size_t count = 0;
        for (; count < 3 && !rest.empty(); ++count) {
            std::string_view word = take_word(rest);
            const std::optional<double> value = take_number(word);
            if (!value || !word.empty()) break;
            values[count] = checked(*value, keyword);
        }
        if (count == 1 && rest.empty()) values[1] = values[2] = values[0], count = 3;
        if (count < 3) return leave_out();
        colour = {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
    }

    bool read_number(float& number, std::string_view keyword, std::string_view rest) {
        if (keyword == "d" && rest.starts_with("-halo")) take_word(rest);
        std::string_view word = take_word(rest);
        const std::optional<double> value = take_number(word);
        if (!value || !word.empty()) {
            leave_out();
            return false;
        }
        number = static_cast<float>(checked(*value, keyword));
        return true;
    }

    void read_picture(FileTexture& texture, std::string_view rest) {
        const std::string name(without_options(rest));
        if (name.empty()) return leave_out();
        const auto [picture, is_new] = pictures_.emplace(name, static_cast<std::int32_t>(scene_.pictures.size()));
        if (is_new) scene_.pictures.push_back({name, false, {}});
        texture.picture = picture->second;
    }

    double checked(double value, std::string_view keyword) const {
        // The largest that a float holds; how bright a light may be is checked with those of all formats.
        if (value >= 0 && value <= 3.4e38) return value;
        throw SceneFileError(path_ + ": line " + std::to_string(lines_.number()) + ": " + std::string(keyword) +
                             " must be finite and not negative");
    }

    void leave_out() {
        if (unread_++ == 0) first_unread_ = lines_.number();
    }

    FileScene& scene_;
    const std::string& path_;
    Checkpoint& checkpoint_;
    TextLines lines_;
    MtlMaterial* material_ = nullptr;  // the last of scene_.materials
    std::map<std::string, std::int32_t> pictures_;
    std::size_t unread_ = 0, first_unread_ = 0, homeless_ = 0;
};

}  // namespace

void read_mtl(FileScene& scene, const std::string& path, Checkpoint& checkpoint) {
    MtlReader(scene, path, checkpoint).read();
}

}  // namespace realcam::io
