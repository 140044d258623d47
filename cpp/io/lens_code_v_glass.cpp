// Glasses in a .seq file: of a catalogue, fictitious ones, and the file's own.

#include <algorithm>

#include "lens_code_v_reader.hpp"
#include "printable.hpp"

namespace realcam::io {
namespace {

/// nd and Vd of a fictitious glass: 517642, 517.642 and 517000.642000 are n_d = 1.517, V_d = 64.2.
std::optional<AbbePair> fictitious(const std::string& name) {
    const std::size_t point = name.find_first_of(".:");
    std::string index = name.substr(0, point), abbe = point == name.npos ? "" : name.substr(point + 1);
    if (point == name.npos && name.size() == 6) index = name.substr(0, 3), abbe = name.substr(3);
    if (!is_digits(index) || !is_digits(abbe) || index.size() < 3 || abbe.size() < 3 || index.size() > 15 ||
        abbe.size() > 15)
        return {};
    return AbbePair{std::stod("1." + index),
                    std::stod(abbe.substr(0, 2) + '.' + (abbe.size() > 2 ? abbe.substr(2) : "0"))};
}

}  // namespace

// Glasses of the file's own: PWL and the wavelengths, then a name and an index for each.
void CodeVReader::read_private(const Words& words) {
    const std::string word = upper_case(words[0].text);
    if (word == "END") {
        in_private_ = false;
    } else if (word == "PWL") {
        private_nm_ = numbers(words, 1, "PWL");
    } else {
        const std::vector<double> indices = numbers(words, 1, "the private glass " + in_quotes(words[0].text));
        if (indices.size() != private_nm_.size())
            lines_.fail("the private glass " + in_quotes(words[0].text) + " has " + std::to_string(indices.size()) +
                        " indices for " + std::to_string(private_nm_.size()) + " wavelengths (PWL)");
        std::vector<Glass::TablePoint> points;
        for (std::size_t i = 0; i < indices.size(); ++i) points.push_back({private_nm_[i], indices[i]});
        try {
            const bool same =
                std::all_of(indices.begin(), indices.end(), [&](double index) { return index == indices.front(); });
            Glass glass = same ? Glass::constant(indices.front()) : Glass::table(std::move(points));
            glass.label = std::string(words[0].text);
            glasses_.define(word, std::move(glass));
            private_names_.insert(word);
        } catch (const InputError& error) {
            lines_.fail(error.what());
        }
    }
}

void CodeVReader::set_glass(PrescriptionSurface& row, std::string_view text) {
    const std::string name = upper_case(text);
    if (name == "REFR" || name == "AIR") return;
    if (name == "REFL") {
        row.is_mirror = true;
        return;
    }
    if (name == "TIRO" || name == "TIR") return foreign("total internal reflection (" + name + ")");
    try {
        if (private_names_.contains(name)) {
            row.material = glasses_.find(name, {});
        } else if (const std::optional<AbbePair> pair = fictitious(name)) {
            row.material = glass_of_pair(pair->n_d, pair->v_d);
        } else {
            const std::size_t bar = name.rfind('_');
            row.material = glasses_.find(
                name.substr(0, bar), bar == name.npos ? std::vector<std::string>{} : std::vector{name.substr(bar + 1)});
        }
    } catch (const InputError& error) {
        lines_.fail(error.what());
    }
}
}  // namespace realcam::io
