// Fuzz target: a lens file, mutated from one that can be read, becomes a lens that validate() accepts or a
// LensFileError whose message is one line; nothing else.

#include <cstring>
#include <string>
#include <vector>

#include "../../cpp/io/bundled_lenses.hpp"
#include "../../cpp/io/lens_file.hpp"
#include "../../cpp/optics/lens_checks.hpp"
#include "bytes.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

/// Every key and every kind of glass of the format.
constexpr const char* kEveryKey = R"(format = 1
name = "probe"
title = "every key"
source = "none"
wavelength_nm = 550.0
film_mm = [36.0, 24.0]
film_distance_mm = 60.0
[iris]
blades = 7
rounding = 0.3
rotation_deg = 12.5
[focus]
nearest_m = 0.5
group = [2, 3]
[glass.a]
n_d = 1.6
V_d = 40.0
[glass.b]
sellmeier = {B = [1.04, 0.23, 1.01], C = [0.006, 0.02, 103.56]}
[glass.c]
cauchy = [1.5, 0.004]
[glass.d]
table = [[400.0, 1.53], [550.0, 1.52], [700.0, 1.51], [380.0, 1.54], [780.0, 1.505]]
[[surface]]
type = "aperture"
thickness_mm = 1.0
clear_semi_diameter_mm = 20.0
inner_semi_diameter_mm = 3.0
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 4.0
material = "a"
clear_semi_diameter_mm = 15.0
conic = -0.5
aspheric_coefficients = {4 = 1e-6, 6 = -1e-9, 18 = 1e-24}
[[surface]]
radius_of_curvature_mm = -80.0
thickness_mm = 2.0
material = [1.7, 30.0]
clear_semi_diameter_mm = 15.0
[[surface]]
type = "stop"
thickness_mm = 30.0
clear_semi_diameter_mm = 6.0
[[surface]]
type = "mirror"
radius_of_curvature_mm = -300.0
thickness_mm = -20.0
clear_semi_diameter_mm = 20.0
[[surface]]
type = "mirror"
thickness_mm = 25.0
clear_semi_diameter_mm = 10.0
[[surface]]
thickness_mm = 2.0
material = "d"
clear_semi_diameter_mm = 15.0
[[surface]]
material = "N-BK7"
clear_semi_diameter_mm = 15.0
)";

struct Span {
    std::size_t begin, end;
};

Span pick(Bytes& in, const std::vector<Span>& spans) {
    return spans[in.word() % spans.size()];
}

/// Runs of what a number is written with.
std::vector<Span> numbers_of(const std::string& text) {
    std::vector<Span> found;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t begin = i;
        while (i < text.size() && std::strchr("0123456789.+-e", text[i]) && text[i]) ++i;
        if (i > begin && text.substr(begin, i - begin).find_first_of("0123456789") != std::string::npos)
            found.push_back({begin, i});
    }
    return found;
}

std::vector<Span> lines_of(const std::string& text) {
    std::vector<Span> found;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        found.push_back({begin, end});
        begin = end;
    }
    return found;
}

std::string number_or_not(Bytes& in) {
    static constexpr const char* odd[] = {"nan",
                                          "-nan",
                                          "inf",
                                          "-inf",
                                          "0",
                                          "-0.0",
                                          "1e400",
                                          "-1e-400",
                                          "0x10",
                                          "0b1",
                                          "1_000",
                                          "1__0",
                                          "true",
                                          "''",
                                          "\"1\"",
                                          "[]",
                                          "[1]",
                                          "[[1.0, 2.0]]",
                                          "{}",
                                          "1979-05-27",
                                          "9223372036854775807",
                                          "9223372036854775808",
                                          "1e18",
                                          "."};
    if (in.chance(128)) return odd[in.below(static_cast<int>(sizeof odd / sizeof *odd))];
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", in.chance(128) ? in.any() : in.sign() * in.decades(-3, 3));
    return text;
}

void mutate(Bytes& in, std::string& text) {
    if (text.empty()) text = "\n";
    switch (in.below(12)) {
        case 0:
        case 1:
        case 2:
        case 3: {
            const std::vector<Span> numbers = numbers_of(text);
            if (numbers.empty()) return;
            const Span at = pick(in, numbers);
            text.replace(at.begin, at.end - at.begin, number_or_not(in));
            return;
        }
        case 4: {
            const Span line = pick(in, lines_of(text));
            text.erase(line.begin, line.end - line.begin);
            return;
        }
        case 5: {
            const std::vector<Span> lines = lines_of(text);
            const Span from = pick(in, lines), to = pick(in, lines);
            text.insert(to.begin, text.substr(from.begin, from.end - from.begin));
            return;
        }
        case 6: {  // a block of lines many times: the same surface, the same table
            const std::vector<Span> lines = lines_of(text);
            const std::size_t first = in.word() % lines.size(),
                              last = std::min(first + static_cast<std::size_t>(in.below(8)), lines.size() - 1);
            const std::string block = text.substr(lines[first].begin, lines[last].end - lines[first].begin);
            for (int i = in.below(256); i > 0 && text.size() < 100000; --i) text.insert(lines[last].end, block);
            return;
        }
        case 7: text[in.word() % text.size()] = static_cast<char>(in.byte()); return;
        case 8: {
            std::string some;
            for (int i = 1 + in.below(16); i > 0; --i) some += static_cast<char>(in.byte());
            text.insert(in.word() % text.size(), some);
            return;
        }
        case 9: text.resize(in.word() % text.size()); return;
        case 10: {  // nesting
            const char open = in.chance(128) ? '[' : '{';
            text.insert(in.word() % text.size(), std::string(static_cast<std::size_t>(in.below(256)) * 40, open));
            return;
        }
        default: {  // a key in another's place
            const std::vector<Span> lines = lines_of(text);
            const Span from = pick(in, lines), to = pick(in, lines);
            const std::string key = text.substr(from.begin, text.find('=', from.begin) - from.begin);
            const std::size_t equals = text.find('=', to.begin);
            if (key.size() < 40 && equals < to.end) text.replace(to.begin, equals - to.begin, key);
        }
    }
}

std::string start_of(std::string text) {
    for (char& c : text)
        if (c == '\n') c = '|';
    return text.substr(0, 700);
}

}  // namespace

int fuzz_lens_file(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    std::string text;
    const std::span<const io::BundledFile> files = io::bundled_lens_files();
    const auto choice = static_cast<std::size_t>(in.byte());
    if (choice == 255) {
        text.assign(reinterpret_cast<const char*>(data) + (size > 0), size - (size > 0));
    } else {
        text = choice % 2 ? std::string(kEveryKey) : std::string(files[choice / 2 % files.size()].text);
        for (int i = in.below(5); i >= 0; --i) mutate(in, text);
    }
    ++findings().files;
    try {
        const LensSystem lens = io::parse_lens(text, "fuzz.toml");
        ++findings().files_read;
        validate(lens);
        const bool sound = lens.film_distance > 0 && std::isfinite(lens.film_distance) && !lens.name.empty() &&
                           lens.wavelength_nm >= 100 && lens.stop_semi_diameter > 0 && lens.focusing.nearest_mm >= 0;
        if (!sound) report("a lens file becomes a lens that is none", "%s", start_of(text).c_str());
    } catch (const LensFileError& error) {
        if (std::strchr(error.what(), '\n'))
            report("a message of several lines", "%s: %s", error.what(), start_of(text).c_str());
    } catch (const std::exception& error) {
        report("a lens file raises something else", "%s: %s", error.what(), start_of(text).c_str());
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_lens_file)
