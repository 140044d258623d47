#include "mtl_picture.hpp"

#include <algorithm>
#include <array>

#include "../text/text_lines.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

/// Option of a picture statement: the greatest number of its words and its default. Words after the first are numbers
/// and optional. With its default, an option has no effect.
struct Option {
    std::string_view name;
    std::size_t words;
    std::string_view by_default;
};
constexpr Option kOptions[] = {{"-blendu", 1, "on"}, {"-blendv", 1, "on"}, {"-boost", 1, ""},   {"-bm", 1, ""},
                               {"-cc", 1, "off"},    {"-clamp", 1, "off"}, {"-imfchan", 1, ""}, {"-mm", 2, ""},
                               {"-o", 3, ""},        {"-s", 3, ""},        {"-t", 3, ""},       {"-texres", 1, ""},
                               {"-type", 1, ""}};

const Option* find_option(std::string_view name) {
    for (const Option& option : kOptions)
        if (option.name == name) return &option;
    return nullptr;
}

std::optional<double> number_of(std::string_view word) {
    const std::optional<double> number = take_number(word);
    return word.empty() ? number : std::nullopt;
}

/// Takes the words of an option from the beginning of `rest`.
std::vector<std::string_view> take_arguments(std::string_view& rest, const Option& option) {
    std::vector<std::string_view> words;
    while (words.size() < option.words) {
        std::string_view behind = rest;
        const std::string_view word = take_word(behind);
        if (!words.empty() && !number_of(word)) break;
        words.push_back(word);
        rest = behind;
    }
    return words;
}

class PictureParser {
public:
    std::optional<MtlPicture> parse(std::string_view rest) {
        while (rest.starts_with('-')) {
            std::string_view after = rest;
            const Option* option = find_option(take_word(after));
            if (!option) break;  // a file name may begin with - as well
            if (!apply(*option, take_arguments(after, *option))) return std::nullopt;
            rest = after;
        }
        out_.name = rest;
        out_.transform = TextureTransform::of_mtl(scale_[0], scale_[1], offset_[0], offset_[1]);
        return rest.empty() ? std::nullopt : std::optional(out_);
    }

private:
    bool apply(const Option& option, const std::vector<std::string_view>& words) {
        if (option.name == "-s") return read(words, scale_);
        if (option.name == "-o") return read(words, offset_);
        if (option.name == "-bm") return read_bm(words[0]);
        if (option.name == "-clamp" && (words[0] == "on" || words[0] == "off")) {
            out_.clamps = words[0] == "on";
            return true;
        }
        if (words[0] != option.by_default) out_.other_options.push_back(option.name);
        return true;
    }

    static bool read(const std::vector<std::string_view>& words, std::array<double, 3>& numbers) {
        for (std::size_t i = 0; i < std::min(words.size(), numbers.size()); ++i) {
            const std::optional<double> number = number_of(words[i]);
            if (!number) return false;
            numbers[i] = *number;
        }
        return true;
    }

    bool read_bm(std::string_view word) {
        const std::optional<double> factor = number_of(word);
        out_.has_bm = factor.has_value();
        out_.bm = factor.value_or(1);
        return out_.has_bm;
    }

    MtlPicture out_;
    std::array<double, 3> scale_{1, 1, 1}, offset_{0, 0, 0};
};

}  // namespace

std::optional<MtlPicture> parse_mtl_picture(std::string_view text) {
    return PictureParser().parse(text);
}

}  // namespace realcam::io
