// CODE V's .seq: commands of a word and its values, several on a line where ';' separates them; '!' begins a remark and
// '&' at a line's end goes on in the next. S adds a surface; what follows is about it, or about the one named (S3).

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "lens_readers.hpp"
#include "lens_text.hpp"
#include "printable.hpp"

namespace realcam::io {
namespace {

using Words = std::vector<LensWord>;

/// Commands that say nothing about where light goes: names, solves and their control codes, weights, display.
bool is_harmless(const std::string& word) {
    static const std::set<std::string> words{
        "LEN", "INI", "WTW", "WTF", "TEM", "PRE", "CA",  "DER", "GO",  "SLB", "POL", "COM", "UID", "CCY", "THC", "GLC",
        "KC",  "AC",  "BC",  "CC",  "DC",  "EC",  "FC",  "GC",  "HC",  "JC",  "CUC", "CCX", "CWL", "WTX", "WTY", "INC",
        "MFL", "DEL", "VER", "OUT", "SAV", "RES", "FRZ", "TOL", "UNI", "DLF", "DLN", "DLR", "DLT", "DLA", "DLB", "DLG",
        "DLV", "DLX", "DLY", "CMP", "ABF", "CBF", "SPC", "END", "EXI", "WID", "PUI", "PUX", "PUY", "PUD", "CRF", "SSI"};
    return words.contains(word);
}

bool is_number(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == word.npos;
}

/// nd and Vd of a fictitious glass: 517642, 517.642 and 517000.642000 are n_d = 1.517, V_d = 64.2.
std::optional<AbbePair> fictitious(const std::string& name) {
    const std::size_t point = name.find_first_of(".:");
    std::string index = name.substr(0, point), abbe = point == name.npos ? "" : name.substr(point + 1);
    if (point == name.npos && name.size() == 6) index = name.substr(0, 3), abbe = name.substr(3);
    if (!is_number(index) || !is_number(abbe) || index.size() < 3 || abbe.size() < 3 || index.size() > 15 ||
        abbe.size() > 15)
        return {};
    return AbbePair{std::stod("1." + index),
                    std::stod(abbe.substr(0, 2) + '.' + (abbe.size() > 2 ? abbe.substr(2) : "0"))};
}

class Reader {
public:
    Reader(std::string_view text, const std::string& file, LensGlasses& glasses)
        : lines_(text, file), glasses_(glasses) {
        p_.file = file;
        p_.format = "CODE V";
    }

    Prescription read() {
        std::string_view line;
        std::string joined;
        while (lines_.next(line)) {
            joined += line;
            const std::string_view bare = without_blanks(joined);
            if (bare.ends_with('&')) {
                joined = std::string(bare.substr(0, bare.size() - 1)) + ' ';
                continue;
            }
            read_line(joined);
            joined.clear();
        }
        if (!without_blanks(joined).empty()) read_line(joined);
        if (rows_.empty() || !has_image_) fail_file("has no image surface (SI); the file ends too early");
        finish();
        return std::move(p_);
    }

private:
    [[noreturn]] void fail_file(const std::string& message) const { throw LensFileError(message, p_.file); }

    void read_line(std::string_view line) {
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

    double number(const Words& words, std::size_t i, const std::string& what) const {
        if (i >= words.size()) lines_.fail(what + " is missing");
        return lines_.number_of(words[i].text, what);
    }
    std::vector<double> numbers(const Words& words, std::size_t from, const std::string& what) const {
        std::vector<double> list;
        for (std::size_t i = from; i < words.size(); ++i) list.push_back(number(words, i, "each value of " + what));
        if (list.empty()) lines_.fail(what + " has no value");
        return list;
    }
    void foreign(const std::string& what) {
        p_.foreign.push_back({what, lines_.number(), rows_.empty() ? 0 : rows_[current_].number});
    }

    void read_command(Words words) {
        if (words.empty()) return;
        if (in_private_) return read_private(words);
        const std::string command = upper_case(words[0].text);
        if (command == "S" || command == "SO" || command == "SI" || command == "S0") return add_surface(command, words);
        if (command.size() > 1 && command[0] == 'S' && is_number(std::string_view(command).substr(1)))
            return change_surface(command, words);
        const std::string word = command.substr(0, 3);
        if (word == "TIT") {
            if (words.size() > 1) p_.title = std::string(words[1].text);
        } else if (word == "ZOO") {
            read_zoom(words);
        } else if (word == "PRV") {
            in_private_ = true;
        } else if (!read_specification(word, words) && !read_surface_command(word, words) && !is_harmless(word)) {
            unknown_.insert(printable(command).substr(0, 20));
        }
    }

    // Glasses of the file's own: PWL and the wavelengths, then a name and an index for each.
    void read_private(const Words& words) {
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

    bool read_specification(const std::string& word, const Words& words) {
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
            unit_ = unit == "M" ? 1 : unit == "C" ? 10 : 25.4;
        } else if (word == "WL") {
            wavelengths_ = numbers(words, 1, "WL");
        } else if (word == "REF") {
            if (words.size() < 2) lines_.fail("REF needs the number of the reference wavelength");
            reference_ = lines_.whole_number_of(words[1].text, "the number of the reference wavelength", 1, 1000);
        } else if (word.size() == 3 && (word[0] == 'X' || word[0] == 'Y') && fields.contains(word.substr(1))) {
            p_.field_kind = fields.at(word.substr(1));
            (word[0] == 'X' ? x_ : y_) = numbers(words, 1, word);
        } else if (word == "VUX" || word == "VLX" || word == "VUY" || word == "VLY") {
            vignetting_[word] = numbers(words, 1, word);
        } else if (word == "TEL" || word == "AFC" || word == "AFI") {
            if (words.size() < 2 || !upper_case(words[1].text).starts_with('N'))
                p_.remarks.push_back(word + " (a telecentric object or an afocal image) is left out");
        } else {
            return false;
        }
        return true;
    }

    void add_surface(const std::string& command, const Words& words) {
        const bool is_object = command == "SO" || command == "S0", is_image = command == "SI";
        if (!radius_mode_)
            lines_.fail("neither RDM (radii) nor RDM N (curvatures) stands in front of the first surface");
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

    void change_surface(const std::string& command, const Words& words) {
        select(lines_.whole_number_of(std::string_view(command).substr(1), "the number of the surface", 0, 1 << 20));
        read_row(words);
    }

    void select(int surface) {
        if (surface < 0 || surface >= static_cast<int>(rows_.size()))
            lines_.fail("there is no surface " + std::to_string(surface) + " yet");
        current_ = static_cast<std::size_t>(surface);
        lines_.set_surface(surface);
    }

    /// Radius or curvature, thickness, glass.
    void read_row(const Words& words) {
        PrescriptionSurface& row = rows_[current_];
        set_curvature(row, number(words, 1, *radius_mode_ ? "the radius" : "the curvature"), *radius_mode_);
        row.thickness = unit_ * number(words, 2, "the thickness");
        for (std::size_t i = 3; i < words.size(); ++i) set_glass(row, words[i].text);
    }

    void set_curvature(PrescriptionSurface& row, double value, bool is_radius) const {
        row.curvature = is_radius ? (value == 0 ? 0.0 : 1 / (unit_ * value)) : value / unit_;
        // Radii of 1e18 are planes too.
        if (std::fabs(row.curvature) < 1e-17) row.curvature = 0;
    }

    void set_glass(PrescriptionSurface& row, std::string_view text) {
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
                row.material = glasses_.find(name.substr(0, bar), bar == name.npos ? std::vector<std::string>{}
                                                                                   : std::vector{name.substr(bar + 1)});
            }
        } catch (const InputError& error) {
            lines_.fail(error.what());
        }
    }

    /// The surface that a qualifier names, S3, SS (stop) or SI; takes it from the words. Others: the current one.
    PrescriptionSurface& row_of(Words& words) {
        if (rows_.empty()) lines_.fail("stands in front of the first surface");
        if (words.size() > 1 && !words[1].is_quoted) {
            const std::string word = upper_case(words[1].text);
            if (word.size() > 1 && word[0] == 'S') {
                const std::string which = word.substr(1);
                if (which.find("..") != which.npos || which == "A")
                    lines_.fail("a range of surfaces (" + in_quotes(word) + "); one surface is wanted");
                if (which == "O" || which == "I" || is_number(which)) {
                    select(which == "O"   ? 0
                           : which == "I" ? static_cast<int>(rows_.size()) - 1
                                          : lines_.whole_number_of(which, "the number of the surface", 0, 1 << 20));
                    words.erase(words.begin() + 1);
                }
            }
        }
        return rows_[current_];
    }

    bool read_surface_command(const std::string& word, Words words) {
        static const std::set<std::string> shapes{"CYL", "XTO", "YTO", "AAS", "SPS", "DIF", "GRT", "DOE", "HOE", "HWL",
                                                  "HOR", "HCT", "HCO", "GRO", "GRS", "TOR", "ANA", "UD1", "SCO", "THM",
                                                  "LNS", "MOD", "NSS", "INT", "ARR", "GRI", "CUX", "RDX", "KX",  "AR"};
        static const std::set<std::string> tilts{"XDE", "YDE", "ZDE", "ADE", "BDE", "CDE", "XOD", "YOD", "ZOD", "ADX",
                                                 "ADY", "ARO", "GLB", "XGR", "YGR", "ZGR", "AGR", "BGR", "CGR"};
        static const std::set<std::string> returns{"DAR", "BEN", "RET", "REV"};
        static const std::set<std::string> rectangles{"REX", "REY", "ELX", "ELY", "REC",
                                                      "ELL", "POL", "CIG", "REG", "ELG"};
        if (word == "STO") {
            row_of(words).is_stop = true;
        } else if (word == "ASP" || word == "SPH" || word == "CON") {
            row_of(words);
        } else if (word == "K") {
            row_of(words).conic = number(words, 1, "the conic");
        } else if (word.size() == 1 && std::string_view("ABCDEFGHJ").find(word[0]) != std::string_view::npos) {
            const int power = 4 + 2 * static_cast<int>(std::string_view("ABCDEFGHJ").find(word[0]));
            PrescriptionSurface& row = row_of(words);
            row.aspheric[power] = number(words, 1, "the coefficient " + word) * std::pow(unit_, 1 - power);
        } else if (word == "CUF") {
            row_of(words);
            if (number(words, 1, "CUF") != 0) foreign("a Fresnel surface (CUF)");
        } else if (word == "CIR") {
            read_circle(words);
        } else if (word == "THI") {
            PrescriptionSurface& row = row_of(words);
            row.thickness = unit_ * number(words, 1, "the thickness");
        } else if (word == "RDY" || word == "CUY" || word == "RAD") {
            PrescriptionSurface& row = row_of(words);
            set_curvature(row, number(words, 1, "the curvature"), word != "CUY");
        } else if (word == "GLA" || word == "RMD") {
            PrescriptionSurface& row = row_of(words);
            if (words.size() < 2) lines_.fail(word + " needs a value");
            set_glass(row, words[1].text);
        } else if (word == "PIM") {
            p_.paraxial_image = true;
        } else if (word == "PIK" || word == "UMY" || word == "UMR" || word == "HMY" || word == "CUS") {
            p_.remarks.push_back("the values in the file are taken for those of its solves and pickups (" + word + ")");
        } else if (word == "COA" || word == "MLT") {
            p_.remarks.push_back("coatings are left out (" + word + ")");
        } else if (shapes.contains(word)) {
            row_of(words);
            if (shaped_.insert({word, rows_[current_].number}).second)
                foreign("a surface that is no sphere, conic or asphere (" + word + ")");
        } else if (tilts.contains(word)) {
            row_of(words);
            const bool is_zero = words.size() == 2 && lines_.number_of(words[1].text, word) == 0;
            if (!is_zero) foreign("a tilt or decentre (" + word + ")");
        } else if (returns.contains(word)) {
            row_of(words);
            if (word == "RET") foreign("a return to another surface's axes (RET)");
        } else if (rectangles.contains(word)) {
            row_of(words);
            const bool is_edge = words.size() > 1 && upper_case(words[1].text) == "EDG";
            if (!is_edge) foreign("an aperture that is no circle (" + word + ")");
        } else {
            return false;
        }
        return true;
    }

    void read_circle(Words& words) {
        PrescriptionSurface& row = row_of(words);
        const std::string kind = words.size() > 2 ? upper_case(words[1].text) : "CLR";
        if (kind != "CLR" && kind != "EDG" && kind != "OBS" && kind != "HOL" && kind[0] != 'L')
            lines_.fail("CIR: " + in_quotes(words[1].text) + ": CLR, EDG, OBS or HOL is wanted");
        const double radius = unit_ * number(words, words.size() - 1, "the radius of the aperture");
        if (!(radius > 0)) lines_.fail("the radius of the aperture must be positive");
        if (kind == "EDG") return;  // where the glass ends, and not the light
        if (kind == "HOL") return foreign("a hole through which light passes unbent (CIR HOL)");
        row.blocks = true;
        (kind == "OBS" ? row.inner_semi_diameter : row.clear_semi_diameter) = radius;
    }

    void read_zoom(const Words& words) {
        if (words.size() < 2) lines_.fail("ZOO needs a number of positions, or what zooming changes");
        if (is_number(words[1].text)) {
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
            if (!named || !(which == "SO" || which == "SI" || is_number(std::string_view(which).substr(1))))
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

    std::vector<double> zoom_values(const Words& words, std::size_t from, const std::string& what) const {
        std::vector<double> values = numbers(words, from, what);
        if (values.size() != static_cast<std::size_t>(positions_))
            lines_.fail(what + " has " + std::to_string(values.size()) + " values for " + std::to_string(positions_) +
                        " positions");
        return values;
    }

    void finish() {
        const PrescriptionSurface& object = rows_.front();
        PrescriptionSurface& image = rows_.back();
        const auto distance = [](double value) { return value >= kLongest ? kInfinity : value; };
        p_.object_distance = distance(object.thickness);
        p_.defocus = image.thickness;
        if (image.curvature != 0) p_.foreign.push_back({"a curved image surface", image.line, image.number});
        if (object.curvature != 0 && std::isfinite(p_.object_distance))
            p_.foreign.push_back({"a curved object", object.line, 0});
        p_.image_semi_diameter = image.clear_semi_diameter;
        p_.surfaces.assign(rows_.begin() + 1, rows_.end() - 1);
        if (rows_.size() < 3) fail_file("has no surface between object and image");
        const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
        if (is_length) p_.aperture *= unit_;
        finish_fields();
        if (wavelengths_.empty()) {
            p_.remarks.push_back("it states no wavelength: that of the d line is taken");
        } else {
            const std::size_t number =
                reference_ > 0 ? static_cast<std::size_t>(reference_) : wavelengths_.size() / 2 + 1;
            if (number > wavelengths_.size())
                fail_file("the reference wavelength (REF) is number " + std::to_string(number) + " of " +
                          std::to_string(wavelengths_.size()));
            p_.wavelength_nm = wavelengths_[number - 1];
        }
        for (const auto& [surface, values] : zoom_) {
            if (surface == -1 || surface + 1 >= static_cast<int>(rows_.size()))
                throw LensFileError("ZOO THI changes the thickness of a surface that is none of the lens", p_.file,
                                    zoom_lines_[surface], surface);
            std::vector<double>& list = p_.zoom_thicknesses[surface - 1];
            for (const double value : values) list.push_back(surface == 0 ? distance(unit_ * value) : unit_ * value);
        }
        for (const double value : zoom_aperture_) p_.zoom_apertures.push_back(is_length ? unit_ * value : value);
        if (!unknown_.empty()) {
            std::string names;
            for (const std::string& name : unknown_) names += (names.empty() ? "" : ", ") + name;
            p_.remarks.push_back("commands that are not known were left out: " + names);
        }
    }

    void finish_fields() {
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

    LensLines lines_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<PrescriptionSurface> rows_;  ///< object and image too
    std::size_t current_ = 0;
    bool has_image_ = false, in_private_ = false;
    std::optional<bool> radius_mode_;
    double unit_ = 1;
    std::vector<double> wavelengths_, private_nm_, x_, y_;
    int reference_ = 0, positions_ = 0;
    std::map<std::string, std::vector<double>> vignetting_;
    std::map<int, std::vector<double>> zoom_;
    std::map<int, int> zoom_lines_;
    std::vector<double> zoom_aperture_;
    std::set<std::string> private_names_, zoom_left_out_, unknown_;
    std::set<std::pair<std::string, int>> shaped_;
};

}  // namespace

Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Reader(text, file, glasses).read();
}

}  // namespace realcam::io
