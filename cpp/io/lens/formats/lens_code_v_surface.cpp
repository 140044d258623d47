// Commands of a .seq file for one surface.

#include "lens_code_v_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_places.hpp"

namespace realcam::io {

void CodeVReader::add_surface(const std::string& command, const Words& words) {
    const bool is_object = command == "SO" || command == "S0", is_image = command == "SI";
    if (!radius_mode_) lines_.fail("neither RDM (radii) nor RDM N (curvatures) stands in front of the first surface");
    if (is_object != rows_.empty())
        lines_.fail(is_object ? "a second object surface (SO)" : "SO, the object, is wanted first");
    if (has_image_) lines_.fail("a surface follows the image (SI)");
    if (rows_.size() >= kMostFileSurfaces)
        lines_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
    rows_.emplace_back();
    current_ = rows_.size() - 1;
    rows_[current_].line = lines_.number();
    rows_[current_].number = static_cast<int>(current_);
    rows_[current_].thickness = std::nan("");
    lines_.set_surface(static_cast<int>(current_));
    has_image_ = is_image;
    read_row(words);
}

void CodeVReader::change_surface(const std::string& command, const Words& words) {
    select(lines_.whole_number_of(std::string_view(command).substr(1), "the number of the surface", 0, 1 << 20));
    read_row(words);
}

void CodeVReader::select(int surface) {
    if (surface < 0 || surface >= static_cast<int>(rows_.size()))
        lines_.fail("there is no surface " + std::to_string(surface) + " yet");
    current_ = static_cast<std::size_t>(surface);
    lines_.set_surface(surface);
}

void CodeVReader::read_row(const Words& words) {
    PrescriptionSurface& row = rows_[current_];
    set_curvature(row, words, *radius_mode_);
    row.thickness = unit_ * number_or_infinity(words, 2, "the thickness");
    for (std::size_t i = 3; i < words.size(); ++i) set_glass(row, words[i].text);
}

void CodeVReader::set_curvature(PrescriptionSurface& row, const Words& words, bool is_radius) const {
    const double value = is_radius ? number_or_infinity(words, 1, "the radius") : number(words, 1, "the curvature");
    row.curvature = is_radius ? (value == 0 ? 0.0 : 1 / (unit_ * value)) : value / unit_;
    // Radii from 1e17 on are planes.
    if (std::fabs(row.curvature) < 1e-17) row.curvature = 0;
}

PrescriptionSurface& CodeVReader::row_of(Words& words) {
    if (rows_.empty()) lines_.fail("stands in front of the first surface");
    if (words.size() > 1 && !words[1].is_quoted) {
        const std::string word = upper_case(words[1].text);
        if (word.size() > 1 && word[0] == 'S') {
            const std::string which = word.substr(1);
            if (which.find("..") != which.npos || which == "A")
                lines_.fail("a range of surfaces (" + in_quotes(word) + "); one surface is wanted");
            if (which == "O" || which == "I" || is_digits(which)) {
                select(which == "O"   ? 0
                       : which == "I" ? static_cast<int>(rows_.size()) - 1
                                      : lines_.whole_number_of(which, "the number of the surface", 0, 1 << 20));
                words.erase(words.begin() + 1);
            }
        }
    }
    return rows_[current_];
}

bool CodeVReader::read_surface_command(const std::string& word, Words words) {
    return read_profile(word, words) || read_form_or_place(word, words) || tell_foreign_surface(word, words);
}

bool CodeVReader::read_profile(const std::string& word, Words& words) {
    if (word == "STO") {
        PrescriptionSurface& row = row_of(words);
        for (PrescriptionSurface& other : rows_) other.is_stop = false;  // a lens has one stop, which this moves
        row.is_stop = true;
    } else if (word == "ASP") {
        row_of(words);
    } else if (word == "SPH" || word == "CON") {
        PrescriptionSurface& row = row_of(words);
        row.aspheric.clear();
        if (word == "SPH") row.conic = 0;
    } else if (word == "K") {
        row_of(words).conic = number(words, 1, "the conic");
    } else if (word.size() == 1 && std::string_view("ABCDEFGHJ").find(word[0]) != std::string_view::npos) {
        const int power = 4 + 2 * static_cast<int>(std::string_view("ABCDEFGHJ").find(word[0]));
        PrescriptionSurface& row = row_of(words);
        row.aspheric[power] = number(words, 1, "the coefficient " + word) * std::pow(unit_, 1 - power);
    } else if (word == "CUF") {
        row_of(words);
        if (number(words, 1, "CUF") != 0) foreign("a Fresnel surface (CUF)");
    } else if (word == "THI") {
        PrescriptionSurface& row = row_of(words);
        row.thickness = unit_ * number_or_infinity(words, 1, "the thickness");
    } else if (word == "RDY" || word == "CUY" || word == "RAD") {
        PrescriptionSurface& row = row_of(words);
        set_curvature(row, words, word != "CUY");
    } else if (word == "GLA" || word == "RMD") {
        PrescriptionSurface& row = row_of(words);
        if (words.size() < 2) lines_.fail(word + " needs a value");
        set_glass(row, words[1].text);
    } else if (word == "PIM") {
        p_.paraxial_image = true;
    } else if (word == "PIK" || word == "UMY" || word == "UMR" || word == "HMY" || word == "CUS") {
        remark("the values in the file are taken for those of its solves and pickups (" + word + ")");
    } else if (word == "COA" || word == "MLT") {
        remark("coatings are left out (" + word + ")");
    } else {
        return false;
    }
    return true;
}

bool CodeVReader::read_form_or_place(const std::string& word, Words& words) {
    if (word == "YTO" || word == "XTO" || word == "CYL" || word == "AAS") {
        toroids_[row_of(words).number] = word;
    } else if (word == "RDX" || word == "CUX") {
        PrescriptionSurface& row = row_of(words);
        const double value =
            word == "RDX" ? number_or_infinity(words, 1, "the radius") : number(words, 1, "the curvature");
        row.form.curvature_x = word == "CUX" ? value / unit_ : value == 0 ? 0.0 : 1 / (unit_ * value);
    } else if (word == "KX") {
        row_of(words).form.conic_x = number(words, 1, "the conic");
    } else if (word == "SPS") {
        read_special_kind(words);
    } else if (word == "SCO") {
        read_special_term(words);
    } else if (word.size() == 2 && word[0] >= 'A' && word[0] <= 'D' && (word[1] == 'R' || word[1] == 'P')) {
        read_anamorphic_term(word, words);
    } else if (place_number(word) >= 0) {
        PrescriptionSurface& row = row_of(words);
        const int place = place_number(word);
        // Lengths come first. The first two angles are positive clockwise.
        const double factor = place < 3 ? unit_ : place == 5 ? 1 : -1;
        places_[row.number][place] = factor * number(words, 1, "the decentre or tilt");
        set_place(row);
    } else if (word == "DAR" || word == "BEN" || word == "REV") {
        PrescriptionSurface& row = row_of(words);
        place_kinds_[row.number] = word;
        set_place(row);
    } else if (word == "CIR" || word == "REX" || word == "REY" || word == "ELX" || word == "ELY" || word == "ADX" ||
               word == "ADY" || word == "ARO") {
        read_aperture(word, words);
    } else {
        return false;
    }
    return true;
}

bool CodeVReader::tell_foreign_surface(const std::string& word, Words& words) {
    static const std::set<std::string> shapes{"DIF", "GRT", "DOE", "HOE", "HWL", "HOR", "HCT", "HCO", "GRO", "GRS",
                                              "TOR", "ANA", "UD1", "LNS", "MOD", "NSS", "INT", "ARR", "GRI"};
    static const std::set<std::string> tilts{"XOD", "YOD", "ZOD", "GLB", "XGR", "YGR", "ZGR", "AGR", "BGR", "CGR"};
    static const std::set<std::string> rectangles{"REC", "ELL", "CIG", "REG", "ELG"};
    if (shapes.contains(word)) {
        row_of(words);
        if (shaped_.insert({word, rows_[current_].number}).second)
            foreign("a surface that is no sphere, conic or asphere (" + word + ")");
    } else if (tilts.contains(word)) {
        row_of(words);
        const bool is_zero = words.size() == 2 && lines_.number_of(words[1].text, word) == 0;
        if (!is_zero) foreign("a tilt or decentre (" + word + ")");
    } else if (word == "RET") {
        row_of(words);
        foreign("a return to another surface's axes (RET)");
    } else if (rectangles.contains(word)) {
        row_of(words);
        const bool is_edge = words.size() > 1 && upper_case(words[1].text) == "EDG";
        if (!is_edge) foreign("an aperture that is no circle (" + word + ")");
    } else {
        return false;
    }
    return true;
}

int CodeVReader::place_number(const std::string& word) {
    static const std::array<const char*, 6> kWords = {"XDE", "YDE", "ZDE", "ADE", "BDE", "CDE"};
    const auto found = std::find(kWords.begin(), kWords.end(), word);
    return found == kWords.end() ? -1 : static_cast<int>(found - kWords.begin());
}

void CodeVReader::set_place(PrescriptionSurface& row) {
    const std::array<double, 6>& v = places_[row.number];
    const SurfacePlacement placement{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, false};
    static const std::map<std::string, DecentreKind> kinds{
        {"DAR", DecentreKind::and_return}, {"BEN", DecentreKind::bend}, {"REV", DecentreKind::reverse}};
    const auto kind = place_kinds_.find(row.number);
    set_decentre(placement, kind == place_kinds_.end() ? DecentreKind::ordinary : kinds.at(kind->second), row);
}

}  // namespace realcam::io
