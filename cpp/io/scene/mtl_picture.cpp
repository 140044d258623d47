#include "mtl_picture.hpp"

#include <algorithm>
#include <array>

#include "../text/text_lines.hpp"
#include "../text/text_number.hpp"

namespace realcam::io {
namespace {

/// Option of a texture statement. With its default argument, an option has no effect.
struct Option {
    std::string_view name;
    std::size_t max_arguments;  ///< arguments after the first are numbers and optional
    std::string_view default_argument;  ///< empty: the option has no default
};
constexpr Option kOptions[] = {{"-blendu", 1, "on"}, {"-blendv", 1, "on"}, {"-boost", 1, ""},   {"-bm", 1, ""},
                               {"-cc", 1, "off"},    {"-clamp", 1, "off"}, {"-imfchan", 1, ""}, {"-mm", 2, ""},
                               {"-o", 3, ""},        {"-s", 3, ""},        {"-t", 3, ""},       {"-texres", 1, ""},
                               {"-type", 1, ""}};

/// Returns null if there is no option of this name.
const Option* find_option(std::string_view name) {
    for (const Option& option : kOptions)
        if (option.name == name) return &option;
    return nullptr;
}

/// Parses a word that must be a number as a whole.
std::optional<double> number_of(std::string_view word) {
    const std::optional<double> number = consume_number(word);
    return word.empty() ? number : std::nullopt;
}

/// Removes the arguments of an option from the beginning of `text` and returns them: at least one.
std::vector<std::string_view> take_arguments(std::string_view& text, const Option& option) {
    std::vector<std::string_view> arguments;
    while (arguments.size() < option.max_arguments) {
        std::string_view after_word = text;
        const std::string_view word = consume_word(after_word);
        if (!arguments.empty() && !number_of(word)) break;
        arguments.push_back(word);
        text = after_word;
    }
    return arguments;
}

/// Parser of one statement's arguments.
class PictureParser {
public:
    /// See parse_mtl_picture.
    std::optional<MtlPicture> parse(std::string_view text) {
        while (text.starts_with('-')) {
            std::string_view after_option = text;
            const Option* option = find_option(consume_word(after_option));
            if (!option) break;  // a file name may begin with - as well
            if (!apply(*option, take_arguments(after_option, *option))) return std::nullopt;
            text = after_option;
        }
        out_.name = text;
        out_.transform = TextureTransform::of_mtl(scale_[0], scale_[1], offset_[0], offset_[1]);
        return text.empty() ? std::nullopt : std::optional(out_);
    }

private:
    /// Stores an option's arguments. Returns false if a number is missing.
    bool apply(const Option& option, const std::vector<std::string_view>& arguments) {
        if (option.name == "-s") return read_numbers(arguments, scale_);
        if (option.name == "-o") return read_numbers(arguments, offset_);
        if (option.name == "-bm") return read_bm(arguments[0]);
        if (option.name == "-clamp" && (arguments[0] == "on" || arguments[0] == "off")) {
            out_.clamps = arguments[0] == "on";
            return true;
        }
        if (arguments[0] != option.default_argument) out_.other_options.push_back(option.name);
        return true;
    }

    /// Overwrites the first elements of `numbers`. Returns false if an argument is not a number.
    static bool read_numbers(const std::vector<std::string_view>& arguments, std::array<double, 3>& numbers) {
        for (std::size_t i = 0; i < std::min(arguments.size(), numbers.size()); ++i) {
            const std::optional<double> number = number_of(arguments[i]);
            if (!number) return false;
            numbers[i] = *number;
        }
        return true;
    }

    /// Reads the argument of -bm. Returns false if it is not a number.
    bool read_bm(std::string_view word) {
        const std::optional<double> factor = number_of(word);
        out_.has_bm = factor.has_value();
        out_.bm = factor.value_or(1);
        return out_.has_bm;
    }

    MtlPicture out_;  ///< result of parse()
    std::array<double, 3> scale_{1, 1, 1}, offset_{0, 0, 0};
};

}  // namespace

std::optional<MtlPicture> parse_mtl_picture(std::string_view text) {
    return PictureParser().parse(text);
}

}  // namespace realcam::io
