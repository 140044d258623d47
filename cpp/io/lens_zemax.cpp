// Zemax OpticStudio's .zmx: a line is a keyword of four letters and its values; "SURF n" begins a surface, whose lines
// are indented. Surface 0 is the object, the last one the image.

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "lens_readers.hpp"
#include "lens_text.hpp"
#include "printable.hpp"

namespace realcam::io {
namespace {

/// Keywords that say nothing about where light goes, or repeat what others say: names, solves, tolerances, drawing.
bool is_harmless(const std::string& word, bool in_surface) {
    static const std::set<std::string> of_surface{
        "HIDE", "MIRR", "SLAB", "POPS", "MEMA", "COMM", "FIMP", "VDSZ", "PPAR", "VPAR", "PZUP", "PKUP",
        "MAZH", "BRDF", "EDGE", "VCON", "VCUR", "DMFS", "SCAT", "RLIN", "GOPT", "LSEL", "TCED", "TRAC",
        "TOLE", "CRIX", "WCBK", "HDEN", "COFN", "VGLA", "CUPD", "ISNA", "PCUR", "MACH", "PTHI"};
    static const std::set<std::string> of_system{
        "VERS", "PFIL", "LANG", "ENVD", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "PICB", "HYPR", "FWGN", "FWGT",
        "WWGT", "WWGN", "ZVAN", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "NOTE", "BLNK", "TOL",  "MOFF", "DBDT", "OPDX",
        "CONF", "PUPD", "EFFL", "MNCA", "MNEA", "MNCG", "MNEG", "MXCA", "MXCG", "RGLA", "TCMM", "TOTR", "XDFL", "CHCO",
        "FCHR", "TCNT", "ANGC", "COMN", "WFNO", "PMAG", "DMFS", "ANON", "MCOM", "VANN", "VDXN", "VCXN", "UDFL", "LOCK"};
    return (in_surface ? of_surface : of_system).contains(word);
}

struct RawSurface {
    PrescriptionSurface row;
    std::string type = "STANDARD";  // files without TYPE lines mean that
    std::map<int, double> parameters, extra;
    std::map<int, int> parameter_lines;
    std::string glass, hint;
    int glass_line = 0, glass_kind = 0;
    double n_d = 0, v_d = 0, partial = 0;
    double diameter = 0;
    bool has_thickness = false, at_infinity = false;
};

class Reader {
public:
    Reader(std::string_view text, const std::string& file, LensGlasses& glasses)
        : lines_(text, file), glasses_(glasses) {
        p_.file = file;
        p_.format = "Zemax";
    }

    Prescription read() {
        std::string_view line;
        while (lines_.next(line)) read_line(line);
        if (surfaces_.size() < 3)
            throw LensFileError("has " + std::to_string(surfaces_.size()) +
                                    " surfaces (SURF); an object, a lens and an image are wanted",
                                p_.file);
        check_image();
        for (std::size_t i = 0; i < surfaces_.size(); ++i) convert(surfaces_[i], i);
        set_object();
        set_fields();
        set_wavelength();
        set_zoom();
        if (!unknown_.empty()) {
            std::string names;
            for (const std::string& name : unknown_) names += (names.empty() ? "" : ", ") + name;
            p_.remarks.push_back("lines of keywords that are not known were left out: " + names);
        }
        return std::move(p_);
    }

private:
    using Words = std::vector<LensWord>;

    double number(const Words& words, std::size_t i, const char* what) const {
        if (i >= words.size()) lines_.fail(std::string(what) + " is missing");
        return lines_.number_of(words[i].text, what);
    }
    double number_or(const Words& words, std::size_t i, const char* what, double otherwise) const {
        return i < words.size() && !words[i].is_quoted ? lines_.number_of(words[i].text, what) : otherwise;
    }
    double length(const Words& words, std::size_t i, const char* what) const { return unit_ * number(words, i, what); }
    void foreign(const std::string& what) { p_.foreign.push_back({what, lines_.number(), current_number()}); }
    int current_number() const { return surfaces_.empty() || !in_surface_ ? 0 : surfaces_.back().row.number; }

    void read_line(std::string_view line) {
        std::string_view rest = without_blanks(line);
        if (rest.empty()) return;
        const bool indented = line[0] == ' ' || line[0] == '\t';
        const std::string word = upper_case(rest.substr(0, rest.find_first_of(" \t")));
        rest = without_blanks(rest.substr(std::min(rest.size(), word.size())));
        if (word == "NAME" || word == "NOTE" || word == "COMM" || word == "COFN") {  // free text
            if (word == "NAME") p_.title = std::string(rest);
            if (p_.title.size() > 1 && p_.title.front() == '"' && p_.title.back() == '"')
                p_.title = p_.title.substr(1, p_.title.size() - 2);
            return;
        }
        if (word == "SURF") return begin_surface(lines_.words(rest));
        if (!indented) in_surface_ = false, lines_.set_surface(0);
        if (in_surface_ && is_harmless(word, true)) return;
        if (in_surface_ ? read_surface_line(word, rest) : read_system_line(word, rest)) return;
        // Behind the surfaces stand the operands of the merit function, and there are hundreds.
        if (in_surface_ || surfaces_.empty())
            if (!is_harmless(word, in_surface_)) unknown_.insert(printable(word).substr(0, 40));
    }

    void begin_surface(const Words& words) {
        if (words.empty()) lines_.fail("SURF needs the surface's number");
        const int number = lines_.whole_number_of(words[0].text, "the number of the surface", 0, 1 << 30);
        if (surfaces_.size() >= kMostFileSurfaces)
            lines_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
        if (number != static_cast<int>(surfaces_.size()))
            lines_.fail("surface " + std::to_string(number) + " follows " +
                        (surfaces_.empty() ? std::string("nothing; surface 0, the object,")
                                           : "surface " + std::to_string(surfaces_.size() - 1) + "; surface " +
                                                 std::to_string(surfaces_.size())) +
                        " is wanted");
        surfaces_.emplace_back();
        surfaces_.back().row.number = number;
        surfaces_.back().row.line = lines_.number();
        in_surface_ = true;
        lines_.set_surface(number);
    }

    /// False where the keyword is not known.
    bool read_surface_line(const std::string& word, std::string_view rest) {
        RawSurface& s = surfaces_.back();
        if (word == "STOP") return s.row.is_stop = true;
        const Words words = lines_.words(rest);
        if (word == "TYPE") {
            if (words.empty()) lines_.fail("TYPE needs the type of the surface");
            s.type = upper_case(words[0].text);
        } else if (word == "CURV") {
            s.row.curvature = number(words, 0, "the curvature") / unit_;
        } else if (word == "CONI") {
            s.row.conic = number(words, 0, "the conic");
        } else if (word == "DISZ") {
            if (words.empty()) lines_.fail("DISZ needs the thickness");
            s.has_thickness = true;
            s.at_infinity = upper_case(words[0].text) == "INFINITY";
            s.row.thickness = s.at_infinity ? 0 : length(words, 0, "the thickness");
        } else if (word == "DIAM") {
            s.diameter = length(words, 0, "the semi-diameter");
        } else if (word == "CLAP" || word == "FLAP") {
            s.row.blocks = true;
            // A floating aperture is as large as the semi-diameter.
            const double inner = length(words, 0, "the inner radius"), outer = length(words, 1, "the outer radius");
            s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, inner);
            if (word == "CLAP") s.row.clear_semi_diameter = outer;
        } else if (word == "OBSC") {
            s.row.blocks = true;
            if (length(words, 0, "the inner radius") != 0)
                foreign("an obscuration with a hole");
            else
                s.row.inner_semi_diameter = std::max(s.row.inner_semi_diameter, length(words, 1, "the outer radius"));
        } else if (word == "OBDC") {
            if (number(words, 0, "the decentre") != 0 || number(words, 1, "the decentre") != 0)
                foreign("a decentred aperture");
        } else if (word == "SQAP" || word == "ELAP" || word == "SPID" || word == "SQOB" || word == "ELOB" ||
                   word == "UDAD" || word == "USAP" || word == "UDOB") {
            foreign("an aperture that is no circle (" + word + ")");
        } else if (word == "SCBD" || word == "TILT" || word == "SDEC") {
            foreign("a tilted or decentred surface (" + word + ")");
        } else if (word == "GLAS") {
            read_glass(s, words);
        } else if (word == "PARM") {
            const int i = whole(words, "the number of the parameter", 0, 300);
            s.parameters[i] = number(words, 1, "the parameter");
            s.parameter_lines[i] = lines_.number();
        } else if (word == "XDAT") {
            s.extra[whole(words, "the number of the extra datum", 1, 1000)] = number(words, 1, "the extra datum");
        } else if (word == "COAT") {
            coatings_.insert(words.empty() ? std::string() : printable(words[0].text));
        } else {
            return false;
        }
        return true;
    }

    int whole(const Words& words, const char* what, int least, int most) const {
        if (words.empty()) lines_.fail(std::string(what) + " is missing");
        return lines_.whole_number_of(words[0].text, what, least, most);
    }

    void read_glass(RawSurface& s, const Words& words) {
        if (words.empty()) lines_.fail("GLAS needs the name of the glass");
        s.glass = std::string(words[0].text);
        s.glass_line = lines_.number();
        s.glass_kind = words.size() > 1 ? lines_.whole_number_of(words[1].text, "the kind of the glass", 0, 100) : 0;
        s.n_d = number_or(words, 3, "the glass's n_d", 0);
        s.v_d = number_or(words, 4, "the glass's V_d", 0);
        s.partial = number_or(words, 5, "the glass's partial dispersion", 0);
        // Of a glass of a catalogue these are what the program had there before: 1.5 and 40 in new files.
        if (s.n_d > 1 && s.v_d > 0 && !(s.n_d == 1.5 && s.v_d == 40))
            s.hint = "n_d = " + std::string(words[3].text) + ", V_d = " + std::string(words[4].text);
    }

    /// False where the keyword is not known.
    bool read_system_line(const std::string& word, std::string_view rest) {
        if (is_harmless(word, false)) return true;
        static const std::set<std::string> ours{"MODE", "UNIT", "ENPD", "FNUM", "OBNA", "FLOA", "GCAT",
                                                "FTYP", "XFLN", "YFLN", "XFLD", "YFLD", "VDYN", "VCYN",
                                                "WAVM", "WAVL", "PWAV", "MNUM", "AFOC"};
        if (!ours.contains(word)) return read_zoom_line(word, rest);
        const Words words = lines_.words(rest);
        const auto list = [&](std::vector<double>& values) {
            values.clear();
            for (const LensWord& w : words) values.push_back(lines_.number_of(w.text, "each value of " + word));
        };
        if (word == "MODE") {
            if (!words.empty() && upper_case(words[0].text) != "SEQ")
                lines_.fail("the mode is " + in_quotes(words[0].text) + "; a sequential lens (MODE SEQ) is wanted");
        } else if (word == "UNIT") {
            set_unit(words);
        } else if (word == "ENPD") {
            set_aperture(ApertureKind::entrance_pupil_diameter, length(words, 0, "the entrance pupil diameter"));
        } else if (word == "FNUM") {
            const bool working = number_or(words, 1, "the kind of f-number", 0) == 1;
            set_aperture(working ? ApertureKind::working_f_number : ApertureKind::f_number,
                         number(words, 0, "the f-number"));
        } else if (word == "OBNA") {
            if (number_or(words, 1, "the kind of aperture", 0) != 0)
                lines_.fail(
                    "the aperture is a cone angle; "
                    "an entrance pupil diameter, an f-number or a numerical aperture is wanted");
            set_aperture(ApertureKind::object_aperture, number(words, 0, "the numerical aperture"));
        } else if (word == "FLOA") {
            p_.aperture_kind = ApertureKind::stop_size;
        } else if (word == "GCAT") {
            for (const LensWord& w : words) catalogues_.emplace_back(w.text);
        } else if (word == "FTYP") {
            field_type_ = whole(words, "the type of the fields", 0, 10);
            field_count_ = static_cast<std::size_t>(number_or(words, 2, "the number of fields", 0));
        } else if (word == "XFLN" || word == "XFLD") {
            list(x_);
        } else if (word == "YFLN" || word == "YFLD") {
            list(y_);
        } else if (word == "VDYN") {
            list(decentre_y_);
        } else if (word == "VCYN") {
            list(compress_y_);
        } else if (word == "WAVM") {
            wavelengths_[whole(words, "the number of the wavelength", 1, 1000)] = number(words, 1, "the wavelength");
        } else if (word == "WAVL") {
            for (std::size_t i = 0; i < words.size(); ++i)
                wavelengths_[static_cast<int>(i) + 1] = number(words, i, "each wavelength");
        } else if (word == "PWAV") {
            primary_ = whole(words, "the number of the primary wavelength", 1, 1000);
        } else if (word == "AFOC") {
            p_.remarks.push_back("its image is afocal, which is left out");
        } else {
            positions_ = whole(words, "the number of configurations", 1, 1000);
            current_ =
                words.size() > 1 ? lines_.whole_number_of(words[1].text, "the current configuration", 1, 1000) : 1;
        }
        return true;
    }

    void set_unit(const Words& words) {
        const std::string unit = words.empty() ? "MM" : upper_case(words[0].text);
        if (!surfaces_.empty()) lines_.fail("UNIT has to stand in front of the surfaces");
        if (unit == "MM")
            unit_ = 1;
        else if (unit == "CM")
            unit_ = 10;
        else if (unit == "IN" || unit == "INCH")
            unit_ = 25.4;
        else if (unit == "METER" || unit == "M")
            unit_ = 1000;
        else
            lines_.fail("the unit is " + in_quotes(unit) + "; MM, CM, IN or METER is wanted");
    }

    void set_aperture(ApertureKind kind, double value) {
        if (!(value > 0)) lines_.fail("the aperture must be positive");
        p_.aperture_kind = kind;
        p_.aperture = value;
    }

    /// An operand of the multi-configuration editor: NAME what configuration value.
    bool read_zoom_line(const std::string& word, std::string_view rest) {
        if (positions_ <= 1) return false;
        static const std::set<std::string> left_out{"FVCX", "FVCY", "FVDX", "FVDY", "FVAN", "YFIE", "XFIE",
                                                    "FLWT", "WLWT", "FLTP", "MCOM", "LTTL", "HOLD", "RAIM"};
        static const std::set<std::string> others{"CRVT", "CONN", "PRAM", "PAR1", "PAR2", "PAR3", "PAR4", "GLSS",
                                                  "STPS", "SDIA", "CSP1", "IGNR", "IGNM", "WAVE", "PRWV", "TEMP",
                                                  "PRES", "MIND", "MABB", "MDPG", "NPAR", "NPOS", "CATN", "APDX",
                                                  "APDY", "APMN", "APMX", "APTP", "AFOC", "EDVA", "PSCX", "PSCY"};
        const bool thickness = word == "THIC", aperture = word == "APER";
        if (!thickness && !aperture) {
            if (others.contains(word) && zoom_foreign_.insert(word).second)
                foreign("configurations that change more than thicknesses (" + word + ")");
            else if (left_out.contains(word) && zoom_foreign_.insert(word).second)
                p_.remarks.push_back("fields and their vignetting are taken from the first configuration (" + word +
                                     " is left out)");
            return others.contains(word) || left_out.contains(word);
        }
        const Words words = lines_.words(rest);
        if (words.size() < 3) lines_.fail(word + " needs a surface, a configuration and a value");
        const int position = lines_.whole_number_of(words[1].text, "the configuration", 1, positions_);
        const double value = upper_case(words[2].text) == "INFINITY" ? kInfinity : number(words, 2, "the value");
        const auto set = [&](std::vector<double>& values) {
            values.resize(static_cast<std::size_t>(positions_), std::nan(""));
            values[static_cast<std::size_t>(position) - 1] = value;
        };
        if (aperture) {
            set(zoom_apertures_);
        } else {
            set(zoom_[lines_.whole_number_of(words[0].text, "the surface", 0, 1 << 20)]);
        }
        return true;
    }

    /// The image is the last surface. One that has a glass or a thickness is the last of a file that ends too early.
    void check_image() const {
        const RawSurface& image = surfaces_.back();
        if (!image.has_thickness || image.row.thickness != 0 || !image.glass.empty())
            throw LensFileError("the file ends with a surface that is no image: it " +
                                    std::string(!image.glass.empty()  ? "has a glass"
                                                : image.has_thickness ? "has a thickness"
                                                                      : "has no thickness (DISZ)"),
                                p_.file, image.row.line, image.row.number);
    }

    void convert(RawSurface& s, std::size_t i) {
        const bool is_object = i == 0, is_image = i + 1 == surfaces_.size();
        const auto fail = [&](const std::string& message, int line = 0) {
            throw LensFileError(message, p_.file, line > 0 ? line : s.row.line, s.row.number);
        };
        const auto add_foreign = [&](const std::string& what) {
            p_.foreign.push_back({what, s.row.line, s.row.number});
        };
        if (!s.has_thickness) fail("the surface has no thickness (DISZ)");
        if (s.at_infinity && !is_object) fail("the thickness is infinite; only the object may be as far away");
        if (is_image) {
            if (s.row.curvature != 0) add_foreign("a curved image surface");
            if (s.row.is_stop) fail("the image is the aperture stop");
            if (s.type == "COORDBRK") fail("the image is a coordinate break");
            p_.image_semi_diameter = s.diameter;
            return;
        }
        if (is_object) return;
        if (s.row.clear_semi_diameter == 0) s.row.clear_semi_diameter = s.diameter;
        convert_shape(s, add_foreign);
        convert_glass(s, fail, add_foreign);
        p_.surfaces.push_back(s.row);
    }

    template <class Foreign>
    void convert_shape(RawSurface& s, const Foreign& add_foreign) {
        const auto any_parameter = [&](int first, int last) {
            return std::any_of(s.parameters.begin(), s.parameters.end(),
                               [&](const auto& p) { return p.first >= first && p.first <= last && p.second != 0; });
        };
        const auto term = [&](int power, double value) {
            if (value != 0) s.row.aspheric[power] = value * std::pow(unit_, 1 - power);
        };
        if (s.type == "STANDARD") {
            // Its parameters mean nothing.
        } else if (s.type == "EVENASPH" || s.type == "ODDASPHE") {
            const int step = s.type == "EVENASPH" ? 2 : 1;
            for (const auto& [number, value] : s.parameters)
                if (number > 0) term(step * number, value);
        } else if (s.type == "XASPHERE") {
            const auto extra = [&](int number) {
                const auto found = s.extra.find(number);
                return found == s.extra.end() ? 0.0 : found->second;
            };
            const double radius = extra(2) > 0 ? extra(2) : 1;
            for (const auto& [number, value] : s.extra)
                if (number >= 3 && number < 3 + static_cast<int>(std::min(extra(1), 300.0)))
                    term(2 * (number - 2), value / std::pow(radius, 2 * (number - 2)));
        } else if (s.type == "COORDBRK") {
            if (any_parameter(1, 5)) add_foreign("a tilt or decentre (coordinate break)");
            s.row.curvature = 0;
            s.glass.clear();
        } else {
            add_foreign("a surface of type " + printable(s.type).substr(0, 40));
        }
    }

    template <class Fail, class Foreign>
    void convert_glass(RawSurface& s, const Fail& fail, const Foreign& add_foreign) {
        s.row.is_mirror = upper_case(s.glass) == "MIRROR";
        if (s.row.is_mirror) return;
        if (s.glass.empty()) {
            // A coordinate break is no surface: the medium goes on behind it.
            if (s.type == "COORDBRK") s.row.material = medium_;
            medium_ = s.row.material;
            return;
        }
        try {
            if (s.glass_kind == 1) {
                s.row.material = glass_of_pair(s.n_d, s.v_d);
                if (s.partial != 0)
                    p_.remarks.push_back("the partial dispersion of the model glass of surface " +
                                         std::to_string(s.row.number) + " is left out");
            } else {
                if (s.glass_kind == 4) add_foreign("a glass with an offset");
                s.row.material = glasses_.find(s.glass, catalogues_, s.hint);
            }
        } catch (const InputError& error) {
            fail(error.what(), s.glass_line);
        }
        medium_ = s.row.material;
    }

    void set_object() {
        const RawSurface& object = surfaces_.front();
        p_.object_distance = object.at_infinity || object.row.thickness >= kLongest ? kInfinity : object.row.thickness;
        if (object.row.curvature != 0 && !object.at_infinity)
            p_.foreign.push_back({"a curved object", object.row.line, 0});
        if (!object.glass.empty()) p_.foreign.push_back({"an object inside a glass", object.glass_line, 0});
        if (object.row.is_stop) throw LensFileError("the object is the aperture stop", p_.file, object.row.line, 0);
        if (!coatings_.empty()) {
            std::string names;
            for (const std::string& name : coatings_) names += (names.empty() ? "" : ", ") + name;
            p_.remarks.push_back("coatings are left out: " + names);
        }
    }

    void set_fields() {
        const std::size_t given = std::max(x_.size(), y_.size());
        const std::size_t count = field_count_ > 0 ? std::min(field_count_, given) : given;
        const auto at = [](const std::vector<double>& list, std::size_t i) { return i < list.size() ? list[i] : 0.0; };
        p_.field_kind = field_type_ == 0   ? FieldKind::angle_deg
                        : field_type_ == 1 ? FieldKind::object_height
                                           : FieldKind::image_height;
        if (field_type_ > 3) p_.remarks.push_back("its fields are of a kind that is not known");
        const double scale = field_type_ == 0 ? 1 : unit_;
        for (std::size_t i = 0; i < count && field_type_ <= 3; ++i) {
            // The pupil's edge moves to decentre + (1 - compression).
            const double shift = at(decentre_y_, i), narrow = at(compress_y_, i);
            p_.fields.push_back({scale * at(x_, i), scale * at(y_, i), 0, 0, std::clamp(narrow - shift, 0.0, 0.999),
                                 std::clamp(narrow + shift, 0.0, 0.999)});
        }
    }

    void set_wavelength() {
        if (wavelengths_.empty()) {
            p_.remarks.push_back("it states no wavelength: that of the d line is taken");
            return;
        }
        const auto found = wavelengths_.find(primary_);
        if (found == wavelengths_.end())
            throw LensFileError("the primary wavelength (PWAV) is number " + std::to_string(primary_) +
                                    ", which the file does not have",
                                p_.file);
        p_.wavelength_nm = 1000 * found->second;
    }

    void set_zoom() {
        if (zoom_.empty() && zoom_apertures_.empty()) return;
        const auto count = static_cast<std::size_t>(positions_);
        const auto filled = [&](std::vector<double> values, double otherwise) {
            values.resize(count, std::nan(""));
            for (double& value : values)
                if (std::isnan(value)) value = otherwise;
            return values;
        };
        for (std::size_t i = 0; i < count; ++i) p_.zoom_names.push_back(std::to_string(i + 1));
        p_.zoom_current = std::min(current_, positions_) - 1;
        const int last = static_cast<int>(p_.surfaces.size());
        for (const auto& [surface, values] : zoom_) {
            if (surface > last)
                throw LensFileError("a configuration changes the thickness of surface " + std::to_string(surface) +
                                        ", which the lens does not have",
                                    p_.file);
            std::vector<double> list = values;
            for (double& value : list) value = unit_ * value >= kLongest ? kInfinity : unit_ * value;
            const double otherwise =
                surface == 0 ? p_.object_distance : p_.surfaces[static_cast<std::size_t>(surface) - 1].thickness;
            p_.zoom_thicknesses[surface - 1] = filled(list, otherwise);
            for (const double value : p_.zoom_thicknesses[surface - 1])
                if (surface > 0 && !std::isfinite(value))
                    throw LensFileError(
                        "a configuration makes the thickness of surface " + std::to_string(surface) + " infinite",
                        p_.file);
        }
        if (!zoom_apertures_.empty()) {
            const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
            for (double& value : zoom_apertures_) value *= is_length ? unit_ : 1;
            p_.zoom_apertures = filled(zoom_apertures_, p_.aperture);
        }
    }

    LensLines lines_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<RawSurface> surfaces_;
    bool in_surface_ = false;
    double unit_ = 1;
    std::vector<std::string> catalogues_;
    int field_type_ = 0;
    std::size_t field_count_ = 0;
    std::vector<double> x_, y_, decentre_y_, compress_y_;
    std::map<int, double> wavelengths_;
    int primary_ = 1, positions_ = 1, current_ = 1;
    std::map<int, std::vector<double>> zoom_;
    std::vector<double> zoom_apertures_;
    std::set<std::string> zoom_foreign_, coatings_, unknown_;
    Glass medium_ = Glass::air();
};

}  // namespace

Prescription read_zemax(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Reader(text, file, glasses).read();
}

}  // namespace realcam::io
