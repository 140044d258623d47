// Reads OSLO's .len: commands of a word and its values, one per line or separated by ';'. "LEN NEW" begins the lens,
// NXT the next surface, END ends it; surface 0 is the object, the last one the image. Commands after END are about
// optimisation, analysis and further configurations.

#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_readers.hpp"
#include "lens_oslo_reader.hpp"

namespace realcam::io {
namespace {

/// Object distances from this number of units on are infinite in OSLO.
constexpr double kFarAway = 1e8;

/// True for commands that do not affect the path of light: names, notes, drawing, weights, and settings of OSLO's
/// computations.
bool is_harmless(const std::string& word) {
    static const std::set<std::string> words{
        "DES",  "NOT", "WW",   "DRW",  "LDP",  "CBK",  "CALLBACK", "GPRT", "ELMDF1", "ELMDF2", "BDI",  "BDD",  "VX",
        "PF",   "LMN", "LME",  "APCK", "DT",   "OPDO", "AFO",      "EVZ",  "IMS",    "IAR",    "WRSP", "SDAD", "XARM",
        "WARM", "ARM", "SASP", "DLAP", "DLRS", "DLNR", "DLFD",     "DLNF", "DLHA",   "DLVA",   "APDX", "DIAM", "OCO",
        "PRE",  "TEM", "TCE",  "ELE",  "EGR",  "DLDL", "DLRI",     "PKP",  "AMO",    "IMGNA",  "SHFL"};
    if (words.contains(word)) return true;
    const auto numbered = [&](std::string_view begin) {
        return word.starts_with(begin) && word.size() > begin.size() &&
               word.find_first_not_of("0123456789", begin.size()) == word.npos;
    };
    return numbered("SNO") || numbered("WW");
}

}  // namespace

OsloReader::OsloReader(std::string_view text, const std::string& file, LensGlasses& glasses)
    : lines_(text, file, glasses.options().keep_going), glasses_(glasses) {
    p_.file = file;
    p_.format = "OSLO";
}

Prescription OsloReader::read() {
    std::string_view line;
    while (lines_.next(line)) read_line(line);
    if (rows_.empty()) throw LensFileError("begins no lens (LEN NEW)", p_.file);
    if (!has_ended_) throw LensFileError("the file ends too early: END is wanted", p_.file);
    finish();
    return std::move(p_);
}

double OsloReader::number(const Words& words, std::size_t i, const std::string& what) const {
    if (i >= words.size()) lines_.fail(what + " is missing");
    return lines_.number_of(words[i].text, what);
}

void OsloReader::foreign(const std::string& what) {
    const int number = rows_.empty() ? 0 : rows_[current_].number;
    if (foreign_.emplace(what, number).second) p_.foreign.push_back({what, lines_.number(), number});
}

void OsloReader::read_line(std::string_view line) {
    std::size_t begin = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted = !quoted;
        if (quoted) continue;
        const bool is_remark = line.substr(i).starts_with("//");
        if (line[i] != ';' && !is_remark) continue;
        read_command(line.substr(begin, i - begin));
        if (is_remark) return;
        begin = i + 1;
    }
    read_command(line.substr(begin));
}

void OsloReader::read_command(std::string_view text) {
    text = without_blanks(text);
    const std::string word = upper_case(text.substr(0, std::min<std::size_t>(text.find_first_of(" \t,"), 20)));
    if (word.empty() || is_harmless(word)) return;
    if (has_ended_) {
        // Some programs write the wavelengths here. Later commands are about other things, with their own keywords.
        if (word.starts_with("WV") && has_late_wavelengths_)
            read_wavelengths(word, lines_.words(text));
        else
            has_late_wavelengths_ = false;
        if (word == "CFG" && !has_configurations_) {
            has_configurations_ = true;
            p_.remarks.push_back("its further configurations (CFG) are left out");
        }
        return;
    }
    const Words words = lines_.words(text);
    if (word == "LEN") return begin_lens(words);
    if (rows_.empty()) return;  // skips the beginning of files of another kind
    if (word == "NXT") return next_surface();
    if (word == "END") return end_lens(words);
    if (word == "GTO") {
        current_ = static_cast<std::size_t>(lines_.whole_number_of(words.size() > 1 ? words[1].text : "", "the surface",
                                                                   0, static_cast<int>(rows_.size()) - 1));
        return lines_.set_surface(rows_[current_].number);
    }
    if (read_system(word, words) || read_surface(word, words)) return;
    if (unknown_.size() < kMostUnknown) unknown_.insert(printable(word));
}

void OsloReader::begin_lens(const Words& words) {
    if (!rows_.empty()) lines_.fail("a second lens (LEN); one is wanted");
    if (words.size() < 2 || upper_case(words[1].text) != "NEW") lines_.fail("LEN NEW is wanted, which begins a lens");
    if (words.size() > 2) p_.title = std::string(words[2].text);
    if (words.size() > 4) stated_last_ = lines_.whole_number_of(words[4].text, "the number of surfaces", 2, 1 << 20);
    rows_.emplace_back().line = lines_.number();
}

void OsloReader::next_surface() {
    ++current_;
    if (current_ >= kMostFileSurfaces)
        lines_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
    if (current_ == rows_.size()) {
        rows_.emplace_back().line = lines_.number();
        rows_.back().number = static_cast<int>(current_);
    }
    lines_.set_surface(static_cast<int>(current_));
}

void OsloReader::end_lens(const Words& words) {
    const int last = static_cast<int>(rows_.size()) - 1;
    const int stated =
        words.size() > 1 ? lines_.whole_number_of(words[1].text, "the number of the image", 0, 1 << 20) : last;
    lines_.set_surface(0);
    for (const int number : {stated, stated_last_ < 0 ? last : stated_last_})
        if (number != last)
            lines_.fail("the image is surface " + std::to_string(last) + "; the file says that it is " +
                        std::to_string(number));
    has_ended_ = true;
    has_late_wavelengths_ = wavelengths_.empty();
}

bool OsloReader::read_system(const std::string& word, const Words& words) {
    const auto positive = [&] {
        const double value = number(words, 1, word);
        if (!(value > 0)) lines_.fail(word + " must be positive");
        return value;
    };
    if (word == "UNI") {
        unit_ = positive();
    } else if (word == "EBR") {
        beam_radius_ = positive();
    } else if (word == "FNO") {
        aperture_ = {ApertureKind::working_f_number, positive()};
    } else if (word == "NAO") {
        aperture_ = {ApertureKind::object_aperture, positive()};
    } else if (word == "NAP") {
        aperture_ = {ApertureKind::image_aperture, positive()};
    } else if (word == "PUK") {
        aperture_ = {ApertureKind::image_aperture, std::sin(std::atan(std::fabs(number(words, 1, word))))};
    } else if (word == "ANG") {
        field_ = {FieldKind::angle_deg, std::fabs(number(words, 1, word))};
    } else if (word == "OBH") {
        field_ = {FieldKind::object_height, std::fabs(number(words, 1, word))};
    } else if (word == "GIH") {
        field_ = {FieldKind::image_height, std::fabs(number(words, 1, word))};
    } else if (word == "TELE") {
        if (words.size() > 1 && upper_case(words[1].text) == "ON")
            p_.remarks.push_back("TELE (a telecentric object) is left out");
    } else {
        return read_wavelengths(word, words);
    }
    return true;
}

bool OsloReader::read_wavelengths(const std::string& word, const Words& words) {
    if (!word.starts_with("WV")) return false;
    if (word.size() > 2) {  // WV2
        const int i = lines_.whole_number_of(std::string_view(word).substr(2), "the number of the wavelength", 1, 1000);
        wavelengths_[i] = number(words, 1, "the wavelength");
    } else {
        wavelengths_.clear();
        for (std::size_t i = 1; i < words.size() && i <= kMostFileFields; ++i)
            wavelengths_[static_cast<int>(i)] = number(words, i, "each wavelength");
    }
    return true;
}

std::vector<double> OsloReader::wavelengths_um() const {
    if (wavelengths_.empty()) return {0.58756, 0.48613, 0.65627};  // OSLO's defaults
    std::vector<double> list;
    for (const auto& [i, um] : wavelengths_) list.push_back(um);
    return list;
}

void OsloReader::finish() {
    if (rows_.size() < 3) throw LensFileError("has no surface between object and image", p_.file);
    p_.wavelength_nm = 1000 * wavelengths_um().front();
    for (const auto& [i, um] : wavelengths_) p_.wavelengths_nm.push_back(1000 * um);
    if (wavelengths_.empty()) p_.remarks.push_back("it states no wavelength: that of the d line is taken");
    resolve_pickups();
    for (const OsloSurface& s : rows_) media_.push_back(medium_of(s));
    resolve_solves();
    const double object = rows_.front().thickness;
    p_.object_distance = object >= kFarAway ? kInfinity : unit_ * object;
    if (rows_.front().curvature != 0 && std::isfinite(p_.object_distance))
        p_.foreign.push_back({"a curved object", rows_.front().line, 0});
    p_.image_curvature = rows_.back().curvature;
    if (!media_.front().is_air()) p_.foreign.push_back({"an object inside a glass", rows_.front().line, 0});
    p_.defocus = unit_ * rows_.back().thickness;
    bool has_stop = false;
    for (std::size_t i = 1; i + 1 < rows_.size(); ++i) has_stop = has_stop || rows_[i].is_stop;
    for (std::size_t i = 1; i + 1 < rows_.size(); ++i) {
        const OsloSurface& s = rows_[i];
        PrescriptionSurface row;
        row.line = s.line;
        row.number = s.number;
        row.curvature = s.curvature / unit_;
        row.conic = s.conic;
        const auto term = [&](int power, double value) {
            if (value != 0) row.aspheric[power] += value * std::pow(unit_, 1 - power);
        };
        for (const auto& [power, value] : s.plain_terms) term(power, value);
        for (const auto& [index, value] : s.aspheric) {
            if (index == 0 && value != 0) throw LensFileError("AS0 moves the vertex", p_.file, s.line, s.number);
            if (index > 0) term(s.aspheric_step * index, value);
        }
        row.thickness = unit_ * s.thickness;
        row.is_mirror = s.is_mirror;
        row.is_stop = has_stop ? s.is_stop : i == 1;  // OSLO's default
        if (!s.is_mirror) row.material = media_[i];
        row.clear_semi_diameter = unit_ * s.semi_diameter;
        row.blocks = s.is_checked;
        p_.surfaces.push_back(std::move(row));
    }
    finish_aperture();
    if (!unknown_.empty()) p_.remarks.push_back("commands that are not known were left out: " + short_list(unknown_));
}

void OsloReader::finish_aperture() {
    if (field_) {
        const double scale = field_->first == FieldKind::angle_deg ? 1 : unit_;
        p_.field_kind = field_->first;
        p_.fields = {{0, 0}, {0, scale * field_->second}};
    }
    if (aperture_) {
        p_.aperture_kind = aperture_->first;
        p_.aperture = aperture_->second;
        return;
    }
    if (!beam_radius_) p_.remarks.push_back("it states no aperture: OSLO's beam radius of one unit is taken");
    const double radius = unit_ * beam_radius_.value_or(1);
    if (std::isinf(p_.object_distance)) {
        p_.aperture_kind = ApertureKind::entrance_pupil_diameter;
        p_.aperture = 2 * radius;
    } else {  // the beam has this radius at the first surface, wherever the pupil is
        p_.aperture_kind = ApertureKind::object_aperture;
        p_.aperture = std::sin(std::atan(radius / std::fabs(p_.object_distance)));
    }
}

Prescription read_oslo(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return OsloReader(text, file, glasses).read();
}

}  // namespace realcam::io
