// Glasses of a .seq file: catalogue glasses, fictitious glasses, and the file's private glasses.

#include <algorithm>
#include <cmath>

#include "../../text/printable.hpp"
#include "../../text/text_number.hpp"
#include "lens_code_v_reader.hpp"

namespace realcam::io {
namespace {

/// Returns n_d and V_d of a fictitious glass: 517642, 517.642 and 517000.642000 are n_d = 1.517, V_d = 64.2.
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

void CodeVReader::read_private(const Words& words) {
    const std::string word = upper_case(words[0].text);
    if (word == "END") {
        in_private_ = false;
    } else if (word == "PWL") {
        private_nm_.clear();
        for (std::size_t i = 1; i < words.size(); ++i) {
            std::string_view rest = words[i].text;
            private_nm_.push_back(take_number(rest).value_or(0));
        }
    } else {
        broken_private_.erase(word);
        try {
            glasses_.define(word, private_glass(words));
            private_names_.insert(word);
        } catch (const InputError& error) {
            broken_private_.emplace(word, LensReadError(error, lines_.file(), lines_.number()));
        } catch (const LensFileError& error) {
            broken_private_.emplace(word, error);
        }
    }
}

Glass CodeVReader::private_glass(const Words& words) const {
    const std::string what = "the private glass " + in_quotes(words[0].text);
    std::string label = printable(words[0].text.substr(0, 100));
    const std::string formula = words.size() > 1 ? upper_case(words[1].text.substr(0, 8)) : "";
    if (!formula.empty() && formula[0] >= 'A' && formula[0] <= 'Z') {
        if (formula != "LAU")
            throw InputError(what + " is given by the formula " + in_quotes(words[1].text) +
                             ", which is not known; LAU (Laurent) or an index for each wavelength is wanted");
        // n^2 = A0 + A1 l^2 + A2 / l^2 + A3 / l^4 + ..., l in um.
        const std::vector<double> a = numbers(words, 2, what);
        return glass_of_formula(
            [&](double um) {
                const double inverse = 1 / (um * um);
                double square = 0;
                for (std::size_t i = a.size(); i-- > 2;) square = (square + a[i]) * inverse;
                return std::sqrt(square + a[0] + (a.size() > 1 ? a[1] * um * um : 0));
            },
            label);
    }
    const std::vector<double> indices = numbers(words, 1, what);
    if (indices.size() != private_nm_.size())
        throw InputError(what + " has " + std::to_string(indices.size()) + " indices for " +
                         std::to_string(private_nm_.size()) + " wavelengths (PWL)");
    if (indices.size() > kMostFileIndices)
        throw InputError(what + " has more than " + std::to_string(kMostFileIndices) + " indices");
    std::vector<Glass::TablePoint> points;
    for (std::size_t i = 0; i < indices.size(); ++i) points.push_back({private_nm_[i], indices[i]});
    const bool same =
        std::all_of(indices.begin(), indices.end(), [&](double index) { return index == indices.front(); });
    Glass glass = same ? Glass::constant(indices.front()) : Glass::table(std::move(points));
    glass.label = std::move(label);
    return glass;
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
        if (const auto broken = broken_private_.find(name); broken != broken_private_.end() && !glasses_.is_given(name))
            lines_.fail(broken->second.detail + " (line " + std::to_string(broken->second.line) + ')');
        if (private_names_.contains(name) || glasses_.is_given(name)) {
            row.material = glasses_.find(name, {});
        } else if (const std::optional<AbbePair> pair = fictitious(name)) {
            row.material = glass_of_pair(pair->n_d, pair->v_d);
        } else {
            const std::size_t bar = name.rfind('_');
            row.material = glasses_.find(
                name.substr(0, bar), bar == name.npos ? std::vector<std::string>{} : std::vector{name.substr(bar + 1)});
        }
    } catch (const InputError& error) {
        lines_.fail(error);
    }
}
}  // namespace realcam::io
