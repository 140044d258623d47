// Reads CODE V's .seq: commands of a word and its values, separated by ';' within a line; '!' begins a remark, and '&'
// at the end of a line continues it. S adds a surface; later commands apply to it, or to the surface that they name
// (S3).

#include <algorithm>
#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_readers.hpp"
#include "lens_code_v_reader.hpp"

namespace realcam::io {
namespace {

/// True for commands that do not affect the path of light: names, solves and their control codes, weights, display.
bool is_harmless(const std::string& word) {
    static const std::set<std::string> words{
        "LEN", "INI", "WTW", "WTF", "TEM", "PRE", "CA",  "DER", "GO",  "SLB", "POL", "COM", "UID", "CCY",
        "THC", "GLC", "KC",  "AC",  "BC",  "CC",  "DC",  "EC",  "FC",  "GC",  "HC",  "JC",  "CUC", "CCX",
        "CWL", "WTX", "WTY", "INC", "MFL", "THM", "CUM", "CLS", "SCC", "VER", "OUT", "SAV", "WRI", "FRZ",
        "TOL", "UNI", "DLF", "DLN", "DLR", "DLT", "DLA", "DLB", "DLG", "DLV", "DLX", "DLY", "CMP", "ABF",
        "CBF", "SPC", "END", "EXI", "WID", "PUI", "PUX", "PUY", "PUD", "CRF", "SSI"};
    return words.contains(word);
}

/// Lengths beyond kLongest are infinite in CODE V.
double finite_or_infinite(double distance) {
    return distance >= kLongest ? kInfinity : distance;
}

}  // namespace

CodeVReader::CodeVReader(std::string_view text, const std::string& file, LensGlasses& glasses)
    : lines_(text, file, glasses.options().keep_going), glasses_(glasses) {
    p_.file = file;
    p_.format = "CODE V";
}

Prescription CodeVReader::read() {
    std::string_view line;
    std::string joined;
    while (lines_.next(line)) {
        const std::string_view bare = without_blanks(line);
        if (bare.ends_with('&')) {
            joined += bare.substr(0, bare.size() - 1);
            joined += ' ';
            continue;
        }
        joined += line;
        read_line(joined);
        joined.clear();
    }
    if (!without_blanks(joined).empty()) read_line(joined);
    if (rows_.empty() || !has_image_) fail_file("has no image surface (SI); the file ends too early");
    finish();
    return std::move(p_);
}

void CodeVReader::fail_file(const std::string& message) const {
    throw LensFileError(message, p_.file);
}

void CodeVReader::read_line(std::string_view line) {
    std::size_t begin = 0;
    char quote = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        const char c = i < line.size() ? line[i] : ';';
        if (quote) {
            if (c == quote) quote = 0;
            if (i < line.size()) continue;
        } else if (c == '"' || c == '\'') {
            quote = c;
            continue;
        }
        if (c != ';' && c != '!') continue;
        read_command(lines_.words(line.substr(begin, i - begin)));
        if (c == '!') return;
        begin = i + 1;
    }
}

double CodeVReader::number(const Words& words, std::size_t i, const std::string& what) const {
    if (i >= words.size()) lines_.fail(what + " is missing");
    return lines_.number_of(words[i].text, what);
}

double CodeVReader::number_or_infinity(const Words& words, std::size_t i, const std::string& what) const {
    if (i < words.size() && is_infinity(words[i].text)) return words[i].text.starts_with('-') ? -kInfinity : kInfinity;
    return number(words, i, what);
}

std::vector<double> CodeVReader::numbers(const Words& words, std::size_t from, const std::string& what) const {
    std::vector<double> list;
    for (std::size_t i = from; i < words.size(); ++i) list.push_back(number(words, i, "each value of " + what));
    if (list.empty()) lines_.fail(what + " has no value");
    return list;
}

void CodeVReader::foreign(const std::string& what) {
    const int surface = rows_.empty() ? 0 : rows_[current_].number;
    if (foreign_.emplace(what, surface).second) p_.foreign.push_back({what, lines_.number(), surface});
}

void CodeVReader::remark(const std::string& what) {
    if (remarks_.insert(what).second) p_.remarks.push_back(what);
}

bool CodeVReader::changes_lens(const std::string& command, const Words& words) {
    // Commands of CODE V that change the lens defined so far. Each is rejected by its name: without its effect, the
    // file would be read as a wrong lens.
    static const std::set<std::string> changes{"DEL", "INS", "SCA", "FLY", "COP", "CPY", "MOV",
                                               "MER", "REP", "EXC", "SWA", "INV", "FLI", "MIR",
                                               "AUT", "RES", "RUN", "SPL", "ADD", "DZO", "DEZ"};
    const std::string word = command.substr(0, 3);
    // REV without a range of surfaces is a decentre type; with a range it reverses surfaces.
    const bool reverses = word == "REV" && words.size() > 1 && words[1].text.find("..") != words[1].text.npos;
    const bool is_second_lens = word == "LEN" && !rows_.empty();
    // SET VIG and SET APE compute values from rays; SET THI and others change the lens.
    const std::string second = words.size() > 1 ? upper_case(words[1].text.substr(0, 3)) : "";
    const bool sets = word == "SET" && second != "VIG" && second != "APE";
    if (!is_second_lens && !sets && !reverses && command != "IN" && !changes.contains(word)) return false;
    std::string text = printable(command.substr(0, 20));
    for (std::size_t i = 1; i < words.size() && i < 4; ++i) text += ' ' + printable(words[i].text.substr(0, 20));
    const std::string what = "the command " + text + ", which makes another lens";
    if (foreign_.emplace(what, 0).second) p_.foreign.push_back({what, lines_.number(), 0});
    return true;
}

bool CodeVReader::names_surfaces(const Words& words) {
    if (words.size() < 2 || words[1].is_quoted) return false;
    const std::string word = upper_case(words[1].text.substr(0, 8));
    static const std::set<std::string> names{"SO", "SI", "SS", "SA"};
    return names.contains(word) ||
           (word.size() > 1 && word[0] == 'S' && word.find_first_not_of("0123456789.", 1) == word.npos);
}

void CodeVReader::read_command(Words words) {
    if (words.empty()) return;
    if (in_private_) return read_private(words);
    const std::string command = upper_case(words[0].text);
    if (command == "S" || command == "SO" || command == "SI" || command == "S0") return add_surface(command, words);
    if (command.size() > 1 && command[0] == 'S' && is_digits(std::string_view(command).substr(1)))
        return change_surface(command, words);
    if (command.size() > 1 && command[0] == 'S' && command.find_first_not_of("0123456789.AIO", 1) == command.npos)
        lines_.fail("a range of surfaces (" + in_quotes(command) + "); one surface is wanted");
    if (changes_lens(command, words)) return;
    const std::string word = command.substr(0, 3);
    if (word == "TIT") {
        if (words.size() > 1) p_.title = std::string(words[1].text);
    } else if (word == "ZOO") {
        read_zoom(words);
    } else if (word == "PRV") {
        in_private_ = true;
    } else if (!read_specification(word, words) && !read_surface_command(word, words) && !is_harmless(word)) {
        // An unknown command that names surfaces changes them.
        if (names_surfaces(words))
            foreign("the command " + printable(command.substr(0, 20)) + ", which is not known");
        else if (unknown_.size() < kMostUnknown)
            unknown_.insert(printable(command.substr(0, 20)));
    }
}

void CodeVReader::finish() {
    const PrescriptionSurface& object = rows_.front();
    PrescriptionSurface& image = rows_.back();
    p_.object_distance = finite_or_infinite(object.thickness);
    p_.defocus = image.thickness;
    if (object.curvature != 0 && std::isfinite(p_.object_distance))
        p_.foreign.push_back({"a curved object", object.line, 0});
    p_.image_semi_diameter = image.clear_semi_diameter;
    for (std::size_t i = 1; i < rows_.size(); ++i)
        if (std::isinf(rows_[i].thickness))
            throw LensFileError("the thickness is infinite; only the object may be as far away", p_.file, rows_[i].line,
                                rows_[i].number);
    for (PrescriptionSurface& row : rows_) {
        finish_aperture(row);
        finish_shape(row);
    }
    finish_image(image);
    p_.surfaces.assign(rows_.begin() + 1, rows_.end() - 1);
    if (rows_.size() < 3) fail_file("has no surface between object and image");
    if (p_.aperture_kind == ApertureKind::entrance_pupil_diameter) p_.aperture *= unit_;
    finish_fields();
    finish_wavelength();
    finish_zoom();
    if (!unknown_.empty()) p_.remarks.push_back("commands that are not known were left out: " + short_list(unknown_));
}

void CodeVReader::finish_image(PrescriptionSurface& image) {
    const SurfaceForm& form = image.form;
    if (image.conic != 0 || !image.aspheric.empty() || !form.is_none())
        p_.foreign.push_back({"an image surface that is no sphere", image.line, image.number});
    p_.image_curvature = image.curvature;
    p_.image_placement = SurfacePlacement::of(image.before);
}

void CodeVReader::finish_fields() {
    const std::size_t count = std::max(x_.size(), y_.size());
    const auto at = [](const std::vector<double>& list, std::size_t i) { return i < list.size() ? list[i] : 0.0; };
    const auto cut = [&](const char* word, std::size_t i) {
        const auto found = vignetting_.find(word);
        return found == vignetting_.end() ? 0.0 : std::clamp(at(found->second, i), 0.0, 0.999);
    };
    const double scale = p_.field_kind == FieldKind::angle_deg ? 1 : unit_;
    for (std::size_t i = 0; i < count; ++i)
        p_.fields.push_back(
            {scale * at(x_, i), scale * at(y_, i), cut("VUX", i), cut("VLX", i), cut("VUY", i), cut("VLY", i)});
}

void CodeVReader::finish_wavelength() {
    if (wavelengths_.empty()) {
        p_.remarks.push_back("it states no wavelength: that of the d line is taken");
    } else {
        const std::size_t number = reference_ > 0 ? static_cast<std::size_t>(reference_) : wavelengths_.size() / 2 + 1;
        if (number > wavelengths_.size())
            fail_file("the reference wavelength (REF) is number " + std::to_string(number) + " of " +
                      std::to_string(wavelengths_.size()));
        p_.wavelength_nm = wavelengths_[number - 1];
        p_.wavelengths_nm = wavelengths_;
    }
}

void CodeVReader::finish_zoom() {
    const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
    for (const auto& [surface, values] : zoom_) {
        if (surface == -1 || surface + 1 >= static_cast<int>(rows_.size()))
            throw LensFileError("ZOO THI changes the thickness of a surface that is none of the lens", p_.file,
                                zoom_lines_[surface], surface);
        std::vector<double>& list = p_.zoom_thicknesses[surface - 1];
        for (const double value : values)
            if (surface > 0 && !std::isfinite(value))
                throw LensFileError("ZOO THI makes the thickness infinite; only the object may be as far away", p_.file,
                                    zoom_lines_[surface], surface);
        for (const double value : values)
            list.push_back(surface == 0 ? finite_or_infinite(unit_ * value) : unit_ * value);
    }
    for (const double value : zoom_aperture_)
        if (!std::isfinite(value)) fail_file("ZOO: an aperture of a zoom position is infinite");
    for (const double value : zoom_aperture_) p_.zoom_apertures.push_back(is_length ? unit_ * value : value);
}

bool is_digits(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
}

Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return CodeVReader(text, file, glasses).read();
}

}  // namespace realcam::io
