// Commands of a .seq file for the whole lens: aperture, fields, wavelengths, units, zoom positions.

#include "../../text/printable.hpp"
#include "lens_code_v_reader.hpp"

namespace realcam::io {

bool CodeVReader::read_specification(const std::string& word, const Words& words) {
    static const std::map<std::string, ApertureKind> apertures{{"EPD", ApertureKind::entrance_pupil_diameter},
                                                               {"FNO", ApertureKind::working_f_number},
                                                               {"NA", ApertureKind::image_aperture},
                                                               {"NAO", ApertureKind::object_aperture}};
    static const std::map<std::string, FieldKind> fields{{"AN", FieldKind::angle_deg},
                                                         {"OB", FieldKind::object_height},
                                                         {"IM", FieldKind::image_height},
                                                         {"RI", FieldKind::image_height}};
    if (const auto aperture = apertures.find(word); aperture != apertures.end()) {
        p_.aperture_kind = aperture->second;
        p_.aperture = number(words, 1, word);
        if (!(p_.aperture > 0)) lines_.fail(word + " must be positive");
    } else if (word == "RDM") {
        radius_mode_ = words.size() < 2 || upper_case(words[1].text).starts_with('Y');
    } else if (word == "DIM") {
        const std::string unit = words.size() > 1 ? upper_case(words[1].text).substr(0, 1) : "";
        if (unit != "M" && unit != "C" && unit != "I") lines_.fail("DIM: M (mm), C (cm) or I (inches) is wanted");
        const double millimetres = unit == "M" ? 1 : unit == "C" ? 10 : 25.4;
        if (!rows_.empty() && millimetres != unit_) lines_.fail("DIM has to stand in front of the surfaces");
        unit_ = millimetres;
    } else if (word == "WL") {
        wavelengths_ = numbers(words, 1, "WL");
    } else if (word == "REF") {
        if (words.size() < 2) lines_.fail("REF needs the number of the reference wavelength");
        reference_ = lines_.whole_number_of(words[1].text, "the number of the reference wavelength", 1, 1000);
    } else if (word.size() == 3 && (word[0] == 'X' || word[0] == 'Y') && fields.contains(word.substr(1))) {
        p_.field_kind = fields.at(word.substr(1));
        if (words.size() > kMostFileFields) lines_.fail(word + " has more than 1000 values");
        (word[0] == 'X' ? x_ : y_) = numbers(words, 1, word);
    } else if (word == "VUX" || word == "VLX" || word == "VUY" || word == "VLY") {
        vignetting_[word] = numbers(words, 1, word);
    } else if (word == "TEL" || word == "AFC" || word == "AFI") {
        if (words.size() < 2 || !upper_case(words[1].text).starts_with('N'))
            remark(word + " (a telecentric object or an afocal image) is left out");
    } else {
        return false;
    }
    return true;
}

void CodeVReader::read_zoom(const Words& words) {
    if (words.size() < 2) lines_.fail("ZOO needs a number of positions, or what zooming changes");
    if (is_digits(words[1].text)) {
        if (positions_ > 0) lines_.fail("the number of zoom positions is given twice");
        positions_ = lines_.whole_number_of(words[1].text, "the number of zoom positions", 1, 1000);
        for (int i = 1; i <= positions_; ++i) p_.zoom_names.push_back(std::to_string(i));
        return;
    }
    const std::string word = upper_case(words[1].text).substr(0, 3);
    static const std::set<std::string> left_out{"VUX", "VLX", "VUY", "VLY", "XAN", "YAN", "XIM", "YIM",
                                                "XRI", "YRI", "XOB", "YOB", "WTF", "THC", "WTW", "CCY"};
    const auto count = static_cast<std::size_t>(positions_);
    if (positions_ < 1) lines_.fail("ZOO and the number of positions have to stand in front of what changes");
    if (word == "TIT") {
        for (std::size_t i = 0; i < count && i + 2 < words.size(); ++i)
            p_.zoom_names[i] = std::string(words[i + 2].text);
    } else if (word == "THI") {
        const std::string which = words.size() > 2 ? upper_case(words[2].text) : "";
        const bool named = which.size() > 1 && which[0] == 'S';
        if (!named || !(which == "SO" || which == "SI" || is_digits(std::string_view(which).substr(1))))
            lines_.fail("ZOO THI needs a surface, as in ZOO THI S5");
        const int surface = which == "SO"   ? 0
                            : which == "SI" ? -1
                                            : lines_.whole_number_of(std::string_view(which).substr(1),
                                                                     "the number of the surface", 0, 1 << 20);
        zoom_[surface] = zoom_values(words, 3, "ZOO THI " + which);
        zoom_lines_[surface] = lines_.number();
    } else if (word == "EPD" || word == "FNO" || word == "NA" || word == "NAO") {
        zoom_aperture_ = zoom_values(words, 2, "ZOO " + word);
    } else if (left_out.contains(word)) {
        if (zoom_left_out_.insert(word).second)
            p_.remarks.push_back("fields and weights are taken from the first zoom position (ZOO " + word +
                                 " is left out)");
    } else {
        foreign("zoom positions that change more than thicknesses (ZOO " + printable(word) + ")");
    }
}

std::vector<double> CodeVReader::zoom_values(const Words& words, std::size_t from, const std::string& what) const {
    std::vector<double> values;
    for (std::size_t i = from; i < words.size(); ++i)
        values.push_back(number_or_infinity(words, i, "each value of " + what));
    if (values.size() != static_cast<std::size_t>(positions_))
        lines_.fail(what + " has " + std::to_string(values.size()) + " values for " + std::to_string(positions_) +
                    " positions");
    return values;
}
}  // namespace realcam::io
