// Apertures of a .seq file: CIR, REX and REY, ELX and ELY, with ADX, ADY and ARO for the preceding one. Labels (L'A')
// distinguish the apertures of a surface.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../text/printable.hpp"
#include "lens_code_v_reader.hpp"

namespace realcam::io {

void CodeVReader::read_aperture(const std::string& word, Words& words) {
    PrescriptionSurface& row = row_of(words);
    std::string kind = "CLR", label;
    for (std::size_t i = 1; i + 1 < words.size(); ++i) {
        const std::string qualifier = upper_case(words[i].text);
        if (qualifier.starts_with('L'))
            label = qualifier;
        else if (qualifier == "CLR" || qualifier == "OBS" || qualifier == "EDG" || qualifier == "HOL")
            kind = qualifier;
        else
            lines_.fail(word + ": " + in_quotes(words[i].text) + ": CLR, EDG, OBS or HOL is wanted");
    }
    const double value = number(words, words.size() > 1 ? words.size() - 1 : 1, "the aperture");
    if (kind == "EDG") return;  // the edge of the glass does not limit the light
    // The hole of a mirror blocks light. Any other hole, which passes light unrefracted, is not modelled.
    if (kind == "HOL" && !row.is_mirror) return foreign("a hole through which light passes unbent (" + word + " HOL)");
    const bool is_place = word[0] == 'A', blocks = kind == "OBS" || kind == "HOL";
    if (!is_place && !(value > 0)) lines_.fail("the size of the aperture must be positive");
    std::vector<Aperture>& list = apertures_[row.number];
    const auto is_it = [&](const Aperture& other) {
        return is_place ? label.empty() || other.label == label
                        : other.shape == word[0] && other.label == label && other.blocks == blocks;
    };
    const auto found = std::find_if(list.rbegin(), list.rend(), is_it);
    if (found == list.rend() && is_place) lines_.fail(word + " has no aperture in front of it");
    Aperture& aperture = found != list.rend() ? *found : list.emplace_back();
    if (is_place) {
        (word == "ARO"   ? aperture.angle_deg
         : word == "ADX" ? aperture.offset.x
                         : aperture.offset.y) = (word == "ARO" ? 1 : unit_) * value;
        return;
    }
    aperture.label = label;
    aperture.shape = word[0];
    aperture.blocks = blocks;
    if (word != "REY" && word != "ELY") aperture.half.x = unit_ * value;
    if (word != "REX" && word != "ELX") aperture.half.y = unit_ * value;
    row.blocks = true;
}

void CodeVReader::finish_aperture(PrescriptionSurface& row) {
    const auto found = apertures_.find(row.number);
    if (found == apertures_.end()) return;
    ApertureShape& shape = row.aperture_shape;
    double largest = 0;
    for (const Aperture& aperture : found->second) largest = std::max({largest, aperture.half.x, aperture.half.y});
    const auto fail = [&](const char* what) { p_.foreign.push_back({what, row.line, row.number}); };
    bool has_outline = false;
    for (Aperture aperture : found->second) {
        // One of the two half-widths may be absent.
        for (double* half : {&aperture.half.x, &aperture.half.y})
            if (*half == 0) *half = 10 * largest;
        const bool is_circle = aperture.shape == 'C', is_centred = aperture.offset == Vec2d{0, 0};
        if (is_circle && is_centred) {
            double& radius = aperture.blocks ? row.inner_semi_diameter : row.clear_semi_diameter;
            radius =
                radius == 0 || aperture.blocks ? std::max(radius, aperture.half.x) : std::min(radius, aperture.half.x);
            continue;
        }
        if (aperture.blocks) {
            shape.obscurations.push_back({aperture.shape == 'R', aperture.half, aperture.offset, aperture.angle_deg});
            continue;
        }
        if (has_outline) fail("several apertures that are no centred circles");
        has_outline = true;
        shape.offset = aperture.offset;
        if (aperture.shape == 'R' && aperture.angle_deg != 0) {
            const double angle = aperture.angle_deg * std::numbers::pi / 180;
            shape.kind = ApertureOutline::polygon;
            for (const auto& [x, y] : {Vec2d{1, 1}, Vec2d{-1, 1}, Vec2d{-1, -1}, Vec2d{1, -1}})
                shape.corners.push_back(
                    {x * aperture.half.x * std::cos(angle) - y * aperture.half.y * std::sin(angle),
                     x * aperture.half.x * std::sin(angle) + y * aperture.half.y * std::cos(angle)});
            continue;
        }
        shape.kind = is_circle               ? ApertureOutline::circle
                     : aperture.shape == 'R' ? ApertureOutline::rectangle
                                             : ApertureOutline::ellipse;
        shape.half = aperture.half;
        if (!is_circle && aperture.angle_deg != 0) fail("an ellipse as an aperture that is turned (ARO)");
    }
    // Several apertures pass only the light that each of them passes.
    if (const double reach = shape.reach(); reach > 0)
        row.clear_semi_diameter = row.clear_semi_diameter > 0 ? std::min(row.clear_semi_diameter, reach) : reach;
    row.is_open_outside = row.clear_semi_diameter == 0 && shape.is_plain();
}

}  // namespace realcam::io
