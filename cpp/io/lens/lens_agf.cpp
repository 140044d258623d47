// Reader of Zemax's glass catalogues (.agf): "NM" begins a glass with its name and the number of its dispersion
// formula, "CD" has the coefficients, for wavelengths in um. The formulas are those of OpticStudio's manual.

#include <array>
#include <cmath>
#include <functional>

#include "../files/regular_file.hpp"
#include "lens_file.hpp"
#include "lens_glass.hpp"
#include "lens_text.hpp"

namespace realcam::io {
namespace {

/// Coefficients of a dispersion formula, for wavelengths in um.
using Coefficients = std::array<double, 12>;

/// Returns c_0 + c_1 l^p_1 + c_2 l^p_2 + ...
double power_sum(const Coefficients& c, double l, std::initializer_list<double> powers) {
    double sum = c[0];
    std::size_t i = 1;
    for (const double power : powers) sum += c[i++] * std::pow(l, power);
    return sum;
}

/// Returns the sum of c_i l^2 / (l^2 - c_(i + 1)) over pairs from `first` on.
double sellmeier_sum(const Coefficients& c, double l, std::size_t first, std::size_t pairs) {
    double sum = 0;
    for (std::size_t i = first; i < first + 2 * pairs; i += 2) sum += c[i] * l * l / (l * l - c[i + 1]);
    return sum;
}

/// Returns the squared refractive index at wavelength `l` in um, by the number of the dispersion formula; std::nullopt
/// if the formula does not exist.
std::optional<double> squared_index(int formula, const Coefficients& c, double l) {
    const double herzberger = 1 / (l * l - 0.028);
    const auto square = [](double n) { return n * n; };
    switch (formula) {
        case 1: return power_sum(c, l, {2, -2, -4, -6, -8});
        case 2: return 1 + sellmeier_sum(c, l, 0, 3);
        case 3:
            return square(c[0] + c[1] * herzberger + c[2] * herzberger * herzberger + c[3] * l * l +
                          c[4] * std::pow(l, 4) + c[5] * std::pow(l, 6));
        case 4: return 1 + c[0] + c[1] * l * l / (l * l - c[2] * c[2]) + c[3] / (l * l - c[4] * c[4]);
        case 5: return square(c[0] + c[1] / l + c[2] / std::pow(l, 3.5));
        case 6: return 1 + sellmeier_sum(c, l, 0, 4);
        case 7: return c[0] + c[1] / (l * l - c[2]) - c[3] * l * l;
        case 8: return c[0] + c[1] * l * l / (l * l - c[2]) - c[3] * l * l;
        case 9: return c[0] + c[1] * l * l / (l * l - c[2]) + c[3] * l * l / (l * l - c[4]);
        case 10: return power_sum(c, l, {2, -2, -4, -6, -8, -10, -12});
        case 11: return 1 + sellmeier_sum(c, l, 0, 5);
        case 12: return power_sum(c, l, {2, -2, -4, -6, -8, 4, 6});
        case 13: return power_sum(c, l, {2, 4, -2, -4, -6, -8, -10, -12});
        default: return std::nullopt;
    }
}

}  // namespace

void read_glass_catalogue(const std::string& path, std::map<std::string, Glass>& catalogue) {
    constexpr std::size_t kMaxBytes = 16 << 20;  // bytes
    std::string bytes;
    try {
        RegularFile file(path);
        if (file.size() > kMaxBytes) throw LensFileError("is larger than 16 MiB; expected a glass catalogue", path);
        bytes.resize(file.size());
        bytes.resize(file.read(bytes.data(), bytes.size()));
    } catch (const FileError& error) {
        throw LensFileError(error.reason, path);
    }
    const std::string text = decoded_lens_text(bytes, path);
    LensLines lines(text, path);
    std::string name;
    int formula = 0;
    std::size_t count = 0;
    std::string_view line;
    while (lines.next(line)) {
        if (line.starts_with("NM ")) {
            const std::vector<LensWord> words = lines.words(line);
            if (words.size() < 3) lines.fail("NM needs the name of the glass and the number of its formula");
            name = std::string(words[1].text);
            formula = lines.whole_number_of(words[2].text, "the number of the dispersion formula", 1, 13);
        } else if (line.starts_with("CD ")) {
            if (name.empty()) lines.fail("CD has to follow the name of a glass (NM)");
            const std::vector<LensWord> words = lines.words(line);
            Coefficients c{};
            for (std::size_t i = 1; i < words.size() && i <= c.size(); ++i)
                c[i - 1] = lines.number_of(words[i].text, "each coefficient");
            try {
                Glass glass =
                    formula == 2
                        ? Glass::sellmeier({{c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}})
                        : glass_of_formula([&](double um) { return std::sqrt(*squared_index(formula, c, um)); }, name);
                glass.label = name;
                catalogue.emplace(bare_glass_name(name), std::move(glass));
            } catch (const InputError&) {  // an infrared material, which has no visible index
            }
            ++count;
            name.clear();
        }
    }
    if (count == 0) throw LensFileError("has no glass; expected lines NM and CD of a glass catalogue (.agf)", path);
}

}  // namespace realcam::io
