// Reads CODE V's .seq: commands of a word and its values, separated by ';' within a line; '!' begins a remark, and '&'
// at the end of a line continues it. S adds a surface; later commands apply to it, or to the surface that they name
// (S3). Of a keyword the first three letters count.

#include <array>
#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../../text/text_number.hpp"
#include "../lens_format.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {
namespace {

/// Aperture or obscuration of a surface.
struct CodeVAperture {
    std::string label;
    char shape = 'C';  ///< C, R or E: circle, rectangle, ellipse
    bool blocks = false;
    Vec2d half = {0, 0}, offset = {0, 0};
    double angle_deg = 0;
};

/// Surface as stated in a .seq file: what follows is converted to its row at the end of the file.
struct CodeVSurface {
    PrescriptionSurface row;
    SurfacePlacement place;
    DecentreKind decentre = DecentreKind::ordinary;
    std::vector<CodeVAperture> apertures;
    std::string toroid;                       ///< CYL, XTO, YTO or AAS; empty for surfaces of revolution
    std::map<std::string, double> anamorphic;  ///< AR to DR and AP to DP of AAS
    std::string special;                      ///< kind of a special surface: XYP or ODD
    double special_radius = 1;                ///< its normalization radius, in the file's unit
    std::map<int, double> special_terms;      ///< its coefficients by number, except the conic constant
};

/// Returns n_d and V_d of a fictitious glass: 517642, 517.642 and 517000.642000 are n_d = 1.517, V_d = 64.2.
std::optional<AbbePair> fictitious(const std::string& name) {
    const std::size_t point = name.find_first_of(".:");
    std::string index = name.substr(0, point), abbe = point == name.npos ? "" : name.substr(point + 1);
    if (point == name.npos && name.size() == 6) index = name.substr(0, 3), abbe = name.substr(3);
    if (!is_digits(index) || !is_digits(abbe) || index.size() < 3 || abbe.size() < 3 || index.size() > 15 ||
        abbe.size() > 15)
        return {};
    return AbbePair{std::stod("1." + index), std::stod(abbe.substr(0, 2) + '.' + abbe.substr(2))};
}

class CodeVReader : PrescriptionText {
public:
    using PrescriptionText::PrescriptionText;

    Prescription read() {
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
        if (surfaces_.empty() || !has_image_) fail_at("has no image surface (SI); the file ends too early");
        finish();
        return std::move(p_);
    }

private:
    using R = CodeVReader;
    using C = LensCommand;
    using Words = std::vector<LensWord>;

    static void add(R& r, C& c) {
        r.row_of(c);
        r.foreign(c);
    }
    static void add_unless_0(R& r, C& c) {
        r.row_of(c);
        if (c.size() != 1 || c.number(0, c.word) != 0) r.foreign(c);
    }
    static void leave_out(R& r, C& c) { r.left_out(c); }

    /// Commands that are ignored do not affect the path of light: names, solves and their control codes, weights,
    /// display.
    static const Keywords<R>& commands() {
        static const Keywords<R> table{
            {"LEN INI WTW WTF TEM PRE CA DER GO SLB POL COM UID CCY THC GLC KC AC BC CC DC EC FC GC HC JC CUC CCX CWL "
             "WTX WTY INC MFL THM CUM CLS SCC VER OUT SAV WRI FRZ TOL UNI DLF DLN DLR DLT DLA DLB DLG DLV DLX DLY CMP "
             "ABF CBF SPC END EXI WID PUI PUX PUY PUD CRF SSI"},
            // The whole lens
            {"TIT",
             [](R& r, C& c) {
                 if (c.size() > 0) r.p_.title = std::string(c[0].text);
             }},
            {"EPD FNO NA NAO", [](R& r, C& c) { r.read_size(c); }},
            {"RDM", [](R& r, C& c) { r.radius_mode_ = c.size() == 0 || c.capital(0).starts_with('Y'); }},
            {"DIM", [](R& r, C& c) { r.set_unit(c.capital(0, 1)); }},
            {"WL", [](R& r, C& c) { r.wavelengths_ = r.values(c, 0, c.word); }},
            {"REF",
             [](R& r, C& c) {
                 if (c.size() == 0) r.lines_.fail("REF needs the number of the reference wavelength");
                 r.reference_ = c.whole(0, "the number of the reference wavelength", 1, 1000);
             }},
            {"XAN YAN XOB YOB XIM YIM XRI YRI", [](R& r, C& c) { r.read_fields(c); }},
            {"VUX VLX VUY VLY", [](R& r, C& c) { r.vignetting_[c.word] = r.values(c, 0, c.word); }},
            {"TEL AFC AFI",
             [](R& r, C& c) {
                 if (!c.capital(0).starts_with('N'))
                     r.remark(c.word + " (a telecentric object or an afocal image) is left out");
             }},
            {"ZOO", [](R& r, C& c) { r.read_zoom(c); }},
            {"PRV", [](R& r, C&) { r.in_private_ = true; }},
            // Profiles
            {"STO",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 for (CodeVSurface& other : r.surfaces_) other.row.is_stop = false;  // a lens has one stop
                 row.is_stop = true;
             }},
            {"ASP", [](R& r, C& c) { r.row_of(c); }},
            {"SPH CON",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 row.aspheric.clear();
                 if (c.word == "SPH") row.conic = 0;
             }},
            {"K", [](R& r, C& c) { r.row_of(c).conic = c.number(0, "the conic"); }},
            {"A B C D E F G H J",
             [](R& r, C& c) {
                 const int power = 4 + 2 * static_cast<int>(std::string_view("ABCDEFGHJ").find(c.word));
                 PrescriptionSurface& row = r.row_of(c);
                 row.aspheric[power] = c.number(0, "the coefficient " + c.word) * std::pow(r.unit_, 1 - power);
             }},
            {"CUF", add_unless_0, "a Fresnel surface"},
            {"THI",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 row.thickness = r.unit_ * c.number_or_infinity(0, "the thickness");
             }},
            {"RDY CUY RAD",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 row.curvature = r.curvature(c, c.word != "CUY");
             }},
            {"GLA RMD",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 if (c.size() == 0) r.lines_.fail(c.word + " needs a value");
                 r.set_glass(row, c[0].text);
             }},
            {"PIM", [](R& r, C&) { r.p_.paraxial_image = true; }},
            {"PIK UMY UMR HMY CUS", leave_out, "the values in the file are taken for those of its solves and pickups"},
            {"COA MLT", leave_out, "coatings are left out"},
            // Other forms
            {"YTO XTO CYL AAS", [](R& r, C& c) { r.surface_of(c).toroid = c.word; }},
            {"RDX CUX",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.row_of(c);
                 row.form.curvature_x = c.word == "RDX" ? curvature_of(c.number_or_infinity(0, "the radius"), r.unit_)
                                                        : c.number(0, "the curvature") / r.unit_;
             }},
            {"KX", [](R& r, C& c) { r.row_of(c).form.conic_x = c.number(0, "the conic"); }},
            {"SPS", [](R& r, C& c) { r.read_special_kind(c); }},
            {"SCO", [](R& r, C& c) { r.read_special_term(c); }},
            {"AR BR CR DR AP BP CP DP",
             [](R& r, C& c) { r.surface_of(c).anamorphic[c.word] = c.number(0, "the coefficient " + c.word); }},
            // Tilts, decentres and apertures
            {"XDE YDE ZDE ADE BDE CDE", [](R& r, C& c) { r.read_place(c); }},
            {"DAR", [](R& r, C& c) { r.surface_of(c).decentre = DecentreKind::and_return; }},
            {"BEN", [](R& r, C& c) { r.surface_of(c).decentre = DecentreKind::bend; }},
            {"REV", [](R& r, C& c) { r.surface_of(c).decentre = DecentreKind::reverse; }},
            {"CIR REX REY ELX ELY ADX ADY ARO", [](R& r, C& c) { r.read_aperture(c); }},
            // Features that are not modelled
            {"DIF GRT DOE HOE HWL HOR HCT HCO GRO GRS TOR ANA UD1 LNS MOD NSS INT ARR GRI", add,
             "a surface that is no sphere, conic or asphere"},
            {"XOD YOD ZOD GLB XGR YGR ZGR AGR BGR CGR", add_unless_0, "a tilt or decentre"},
            {"RET", add, "a return to another surface's axes"},
            {"REC ELL CIG REG ELG",
             [](R& r, C& c) {
                 r.row_of(c);
                 if (c.capital(0) != "EDG") r.foreign(c);
             },
             "an aperture that is no circle"},
        };
        return table;
    }

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

    void read_command(Words words) {
        if (words.empty()) return;
        if (in_private_) return read_private(words);
        const std::string command = upper_case(words[0].text);
        const std::string_view number = std::string_view(command).substr(command.empty() ? 0 : 1);
        C c(lines_, command.substr(0, 3), {words.begin() + 1, words.end()});
        if (command == "S" || command == "SO" || command == "SI" || command == "S0") return add_surface(command, c);
        if (command[0] == 'S' && is_digits(number)) {
            select(lines_.whole_number_of(number, "the number of the surface", 0, 1 << 20));
            return read_row(c);
        }
        if (command.size() > 1 && command[0] == 'S' && number.find_first_not_of("0123456789.AIO") == number.npos)
            lines_.fail("a range of surfaces (" + in_quotes(command) + "); expected one surface");
        if (changes_lens(command, c) || commands().read(*this, c)) return;
        // An unknown command that names surfaces changes them.
        const std::string name = printable(command.substr(0, 20));
        if (names_surfaces(c))
            foreign("the command " + name + ", which is not known");
        else
            add_unknown(name);
    }

    /// True if the command changes the lens defined so far, which is recorded as not supported.
    bool changes_lens(const std::string& command, const C& c) {
        // Each is rejected by its name: without its effect, the file would be read as a wrong lens.
        static const Keywords<R> changes{
            {"DEL INS SCA FLY COP CPY MOV MER REP EXC SWA INV FLI MIR AUT RES RUN SPL ADD DZO DEZ"}};
        // REV without a range of surfaces is a decentre type; with a range it reverses surfaces.
        const bool reverses = c.word == "REV" && c.size() > 0 && c[0].text.find("..") != std::string_view::npos;
        const bool is_second_lens = c.word == "LEN" && !surfaces_.empty();
        // SET VIG and SET APE compute values from rays; SET THI and others change the lens.
        const bool sets = c.word == "SET" && c.capital(0, 3) != "VIG" && c.capital(0, 3) != "APE";
        if (!is_second_lens && !sets && !reverses && command != "IN" && !changes.find(c.word)) return false;
        std::string text = printable(command.substr(0, 20));
        for (std::size_t i = 0; i < c.size() && i < 3; ++i) text += ' ' + printable(c[i].text.substr(0, 20));
        add_foreign("the command " + text + ", which makes another lens", lines_.number(), 0);
        return true;
    }

    /// True if the first value of a command names surfaces: S3, S2..5, SA.
    static bool names_surfaces(const C& c) {
        if (c.size() == 0 || c[0].is_quoted) return false;
        const std::string word = c.capital(0, 8);
        return word == "SO" || word == "SI" || word == "SS" || word == "SA" ||
               (word.size() > 1 && word[0] == 'S' && word.find_first_not_of("0123456789.", 1) == word.npos);
    }

    std::vector<double> values(const C& c, std::size_t from, const std::string& name) const {
        std::vector<double> list = c.numbers(from, name);
        if (list.empty()) lines_.fail(name + " has no value");
        return list;
    }

    void read_size(const C& c) {
        static const std::map<std::string, ApertureKind> kinds{{"EPD", ApertureKind::entrance_pupil_diameter},
                                                               {"FNO", ApertureKind::working_f_number},
                                                               {"NA", ApertureKind::image_aperture},
                                                               {"NAO", ApertureKind::object_aperture}};
        p_.aperture_kind = kinds.at(c.word);
        p_.aperture = c.number(0, c.word);
        if (!(p_.aperture > 0)) lines_.fail(c.word + " must be positive");
    }

    void set_unit(const std::string& unit) {
        if (unit != "M" && unit != "C" && unit != "I") lines_.fail("DIM: expected M (mm), C (cm) or I (inches)");
        const double millimetres = unit == "M" ? 1 : unit == "C" ? 10 : 25.4;
        if (!surfaces_.empty() && millimetres != unit_) lines_.fail("DIM has to stand in front of the surfaces");
        unit_ = millimetres;
    }

    void read_fields(const C& c) {
        const std::string kind = c.word.substr(1);
        p_.field_kind = kind == "AN"   ? FieldKind::angle_deg
                        : kind == "OB" ? FieldKind::object_height
                                       : FieldKind::image_height;
        std::vector<double>& list = c.word[0] == 'X' ? x_ : y_;
        list = field_values(c);
        if (list.empty()) lines_.fail(c.word + " has no value");
    }

    void read_zoom(const C& c) {
        if (c.size() == 0) lines_.fail("ZOO needs a number of positions, or what zooming changes");
        if (is_digits(c[0].text)) {
            if (positions_ > 0) lines_.fail("the number of zoom positions is given twice");
            positions_ = c.whole(0, "the number of zoom positions", 1, kMostFileZoomPositions);
            for (int i = 1; i <= positions_; ++i) p_.zoom_names.push_back(std::to_string(i));
            return;
        }
        const std::string word = c.capital(0).substr(0, 3);
        static const Keywords<R> left_out{{"VUX VLX VUY VLY XAN YAN XIM YIM XRI YRI XOB YOB WTF THC WTW CCY"}};
        if (positions_ < 1) lines_.fail("ZOO and the number of positions have to stand in front of what changes");
        if (word == "TIT") {
            for (std::size_t i = 0; i < p_.zoom_names.size() && i + 1 < c.size(); ++i)
                p_.zoom_names[i] = std::string(c[i + 1].text);
        } else if (word == "THI") {
            const std::string which = c.capital(1);
            const std::string number = which == "SO" ? "0" : which.substr(std::min<std::size_t>(1, which.size()));
            if (!which.starts_with('S') || !(which == "SI" || is_digits(number)))
                lines_.fail("ZOO THI needs a surface, as in ZOO THI S5");
            const int surface =
                which == "SI" ? -1 : lines_.whole_number_of(number, "the number of the surface", 0, 1 << 20);
            zoom_[surface] = {zoom_values(c, 2, "ZOO THI " + which), lines_.number()};
        } else if (word == "EPD" || word == "FNO" || word == "NA" || word == "NAO") {
            zoom_aperture_ = zoom_values(c, 1, "ZOO " + word);
        } else if (left_out.find(word)) {
            remark("fields and weights are taken from the first zoom position (ZOO " + word + " is left out)");
        } else {
            foreign("zoom positions that change more than thicknesses (ZOO " + printable(word) + ")");
        }
    }

    std::vector<double> zoom_values(const C& c, std::size_t from, const std::string& what) const {
        std::vector<double> list;
        for (std::size_t i = from; i < c.size(); ++i) list.push_back(c.number_or_infinity(i, "each value of " + what));
        if (list.size() != p_.zoom_names.size())
            lines_.fail(what + " has " + std::to_string(list.size()) + " values for " + std::to_string(positions_) +
                        " positions");
        return list;
    }

    void add_surface(const std::string& command, const C& c) {
        const bool is_object = command == "SO" || command == "S0";
        if (!radius_mode_)
            lines_.fail("neither RDM (radii) nor RDM N (curvatures) stands in front of the first surface");
        if (is_object != surfaces_.empty())
            lines_.fail(is_object ? "a second object surface (SO)" : "expected SO, the object, first");
        if (has_image_) lines_.fail("a surface follows the image (SI)");
        check_count(surfaces_.size());
        surfaces_.emplace_back();
        select(static_cast<int>(surfaces_.size()) - 1);
        PrescriptionSurface& row = surfaces_.back().row;
        row.line = lines_.number();
        row.number = static_cast<int>(current_);
        row.thickness = std::nan("");
        has_image_ = command == "SI";
        read_row(c);
    }

    void select(int surface) {
        if (surface < 0 || surface >= static_cast<int>(surfaces_.size()))
            lines_.fail("there is no surface " + std::to_string(surface) + " yet");
        current_ = static_cast<std::size_t>(surface);
        lines_.set_surface(surface);
    }

    /// Reads radius or curvature, thickness and glass.
    void read_row(const C& c) {
        PrescriptionSurface& row = surfaces_[current_].row;
        row.curvature = curvature(c, *radius_mode_);
        row.thickness = unit_ * c.number_or_infinity(1, "the thickness");
        for (std::size_t i = 2; i < c.size(); ++i) set_glass(row, c[i].text);
    }

    /// Returns the curvature of the first value. Radii from 1e17 on are planes.
    double curvature(const C& c, bool is_radius) const {
        const double value = is_radius ? curvature_of(c.number_or_infinity(0, "the radius"), unit_)
                                       : c.number(0, "the curvature") / unit_;
        return std::fabs(value) < 1e-17 ? 0 : value;
    }

    /// Returns the surface that a qualifier names, S3, SO (object) or SI (image), and removes the qualifier; without
    /// one, the current surface.
    CodeVSurface& surface_of(C& c) {
        if (surfaces_.empty()) lines_.fail("stands in front of the first surface");
        const std::string word = c.size() > 0 && !c[0].is_quoted ? c.capital(0) : "";
        if (!word.starts_with('S') || word.size() == 1) return surfaces_[current_];
        const std::string which = word.substr(1);
        if (which.find("..") != which.npos || which == "A")
            lines_.fail("a range of surfaces (" + in_quotes(word) + "); expected one surface");
        if (which != "O" && which != "I" && !is_digits(which)) return surfaces_[current_];
        select(which == "O"   ? 0
               : which == "I" ? static_cast<int>(surfaces_.size()) - 1
                              : lines_.whole_number_of(which, "the number of the surface", 0, 1 << 20));
        c.remove_first();
        return surfaces_[current_];
    }
    PrescriptionSurface& row_of(C& c) { return surface_of(c).row; }

    /// Reads decentres and tilts. CODE V counts the first two tilts positive clockwise.
    void read_place(C& c) {
        SurfacePlacement& place = surface_of(c).place;
        const double value = c.number(0, "the decentre or tilt");
        const bool is_tilt = c.word[0] < 'X';
        Vec3d& to = is_tilt ? place.tilt_deg : place.decentre;
        const int axis = c.word[0] - (is_tilt ? 'A' : 'X');
        (axis == 0 ? to.x : axis == 1 ? to.y : to.z) = (!is_tilt ? unit_ : axis == 2 ? 1 : -1) * value;
    }

    void read_special_kind(C& c) {
        CodeVSurface& s = surface_of(c);
        const std::string kind = c.capital(0, 10);
        if (kind != "XYP" && kind != "ODD")
            return foreign("a special surface (SPS" + (kind.empty() ? "" : ' ' + printable(kind)) + ')');
        s.special = kind;
        if (c.size() > 1) s.special_radius = c.number(1, "the normalization radius");
    }

    /// Reads a coefficient of a special surface.
    void read_special_term(C& c) {
        CodeVSurface& s = surface_of(c);
        if (c.size() < 2) lines_.fail("SCO needs the coefficient's name and its value");
        const std::string name = c.capital(0, 20);
        const double value = c.number(1, "the coefficient");
        if (s.special.empty()) return;  // of an unsupported kind, which is recorded
        const bool is_odd = s.special == "ODD";
        const auto digits = [&](std::size_t letters) { return std::string_view(name).substr(letters); };
        if (name == "K" || name == "C1") {
            s.row.conic = value;
        } else if (name == "NRADIUS" || (is_odd && name == "C33")) {
            s.special_radius = value;
        } else if (is_odd && name.starts_with("AR") && is_digits(digits(2))) {
            s.special_terms[lines_.whole_number_of(digits(2), "the power of r", 1, 30)] = value;
        } else if (name.starts_with('C') && is_digits(digits(1))) {
            // C2 is the first term: that of r, or of x.
            const int last = is_odd ? 31 : (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;
            s.special_terms[lines_.whole_number_of(digits(1), "the number of the coefficient", 2, last) - 1] = value;
        } else {
            foreign("a coefficient of a special surface (SCO " + printable(name) + ')');
        }
    }

    /// Reads a circle, one half-width of a rectangle or an ellipse, or the offset or rotation of the preceding one.
    /// Labels (L'A') distinguish the apertures of a surface.
    void read_aperture(C& c) {
        CodeVSurface& s = surface_of(c);
        std::string kind = "CLR", label;
        for (std::size_t i = 0; i + 1 < c.size(); ++i) {
            const std::string qualifier = c.capital(i);
            if (qualifier.starts_with('L'))
                label = qualifier;
            else if (qualifier == "CLR" || qualifier == "OBS" || qualifier == "EDG" || qualifier == "HOL")
                kind = qualifier;
            else
                lines_.fail(c.word + ": " + in_quotes(c[i].text) + ": expected CLR, EDG, OBS or HOL");
        }
        const double value = c.number(c.size() > 0 ? c.size() - 1 : 0, "the aperture");
        if (kind == "EDG") return;  // the edge of the glass does not limit the light
        // The hole of a mirror blocks light. Any other hole, which passes light unrefracted, is not modelled.
        if (kind == "HOL" && !s.row.is_mirror)
            return foreign("a hole through which light passes unbent (" + c.word + " HOL)");
        const bool is_place = c.word[0] == 'A', blocks = kind == "OBS" || kind == "HOL";
        if (!is_place && !(value > 0)) lines_.fail("the size of the aperture must be positive");
        const auto is_it = [&](const CodeVAperture& other) {
            return is_place ? label.empty() || other.label == label
                            : other.shape == c.word[0] && other.label == label && other.blocks == blocks;
        };
        const auto found = std::find_if(s.apertures.rbegin(), s.apertures.rend(), is_it);
        if (found == s.apertures.rend() && is_place) lines_.fail(c.word + " has no aperture in front of it");
        CodeVAperture& aperture = found != s.apertures.rend() ? *found : s.apertures.emplace_back();
        if (c.word == "ARO") {
            aperture.angle_deg = value;
        } else if (is_place) {
            (c.word == "ADX" ? aperture.offset.x : aperture.offset.y) = unit_ * value;
        } else {
            aperture.label = label;
            aperture.shape = c.word[0];
            aperture.blocks = blocks;
            if (!c.word.ends_with('Y')) aperture.half.x = unit_ * value;
            if (!c.word.ends_with('X')) aperture.half.y = unit_ * value;
            s.row.blocks = true;
        }
    }

    /// Reads private glasses: PWL and the wavelengths, then a name and an index for each, or a name, a formula and its
    /// coefficients. Errors are reported only if a surface uses the glass: makers' files contain unused ones.
    void read_private(const Words& words) {
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
                glasses_.define(word, private_glass(words[0].text, {lines_, word, {words.begin() + 1, words.end()}}));
                private_names_.insert(word);
            } catch (const InputError& error) {
                broken_private_.emplace(word, LensReadError(error, lines_.file(), lines_.number()));
            } catch (const LensFileError& error) {
                broken_private_.emplace(word, error);
            }
        }
    }

    Glass private_glass(std::string_view name, const C& c) const {
        const std::string what = "the private glass " + in_quotes(name), label = printable(name.substr(0, 100));
        const std::string formula = c.capital(0, 8);
        if (!formula.empty() && formula[0] >= 'A' && formula[0] <= 'Z') {
            if (formula != "LAU")
                throw InputError(what + " is given by the formula " + in_quotes(c[0].text) +
                                 ", which is not known; expected LAU (Laurent) or an index for each wavelength");
            // n^2 = A0 + A1 l^2 + A2 / l^2 + A3 / l^4 + ..., l in um.
            const std::vector<double> a = values(c, 1, what);
            return glass_of_formula(
                [&](double um) {
                    const double inverse = 1 / (um * um);
                    double square = 0;
                    for (std::size_t i = a.size(); i-- > 2;) square = (square + a[i]) * inverse;
                    return std::sqrt(square + a[0] + (a.size() > 1 ? a[1] * um * um : 0));
                },
                label);
        }
        const std::vector<double> indices = values(c, 0, what);
        if (indices.size() != private_nm_.size())
            throw InputError(what + " has " + std::to_string(indices.size()) + " indices for " +
                             std::to_string(private_nm_.size()) + " wavelengths (PWL)");
        if (indices.size() > kMostFileIndices)
            throw InputError(what + " has more than " + std::to_string(kMostFileIndices) + " indices");
        if (!is_constant(indices)) return glass_of_indices(private_nm_, indices, label);
        Glass glass = Glass::constant(indices.front());
        glass.label = label;
        return glass;
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
            if (const auto broken = broken_private_.find(name);
                broken != broken_private_.end() && !glasses_.is_given(name))
                lines_.fail(broken->second.detail + " (line " + std::to_string(broken->second.line) + ')');
            if (private_names_.contains(name) || glasses_.is_given(name)) {
                row.material = glasses_.find(name, {});
            } else if (const std::optional<AbbePair> pair = fictitious(name)) {
                row.material = glass_of_pair(pair->n_d, pair->v_d);
            } else {
                const std::size_t bar = name.rfind('_');
                std::vector<std::string> catalogues;
                if (bar != name.npos) catalogues.push_back(name.substr(bar + 1));
                row.material = glasses_.find(name.substr(0, bar), catalogues);
            }
        } catch (const InputError& error) {
            lines_.fail(error);
        }
    }

    void finish() {
        const PrescriptionSurface& object = surfaces_.front().row;
        set_object(object.thickness, object.curvature, object.line);
        for (CodeVSurface& s : surfaces_) {
            if (&s != &surfaces_.front() && std::isinf(s.row.thickness))
                fail_at("the thickness is infinite; only the object may be as far away", s.row.line, s.row.number);
            set_decentre(s.place, s.decentre, s.row);
            finish_aperture(s);
            finish_shape(s);
            p_.surfaces.push_back(s.row);
        }
        const PrescriptionSurface image = p_.surfaces.back();
        p_.surfaces.erase(p_.surfaces.begin());
        p_.surfaces.pop_back();
        if (image.conic != 0 || !image.aspheric.empty() || !image.form.is_none())
            add_foreign("an image surface that is no sphere", image.line, image.number);
        p_.defocus = image.thickness;
        p_.image_semi_diameter = image.clear_semi_diameter;
        p_.image_curvature = image.curvature;
        p_.image_placement = SurfacePlacement::of(image.before);
        if (p_.surfaces.empty()) fail_at("has no surface between object and image");
        if (p_.aperture_kind == ApertureKind::entrance_pupil_diameter) p_.aperture *= unit_;
        finish_fields();
        const std::size_t main = reference_ > 0 ? static_cast<std::size_t>(reference_) : wavelengths_.size() / 2 + 1;
        if (!wavelengths_.empty() && main > wavelengths_.size())
            fail_at("the reference wavelength (REF) is number " + std::to_string(main) + " of " +
                    std::to_string(wavelengths_.size()));
        set_wavelengths(wavelengths_, main - 1);
        finish_zoom();
        tell_unknown("commands");
    }

    void finish_aperture(CodeVSurface& s) {
        if (s.apertures.empty()) return;
        PrescriptionSurface& row = s.row;
        ApertureShape& shape = row.aperture_shape;
        double largest = 0;
        for (const CodeVAperture& aperture : s.apertures)
            largest = std::max({largest, aperture.half.x, aperture.half.y});
        bool has_outline = false;
        for (CodeVAperture& aperture : s.apertures) {
            // One of the two half-widths may be absent.
            for (double* half : {&aperture.half.x, &aperture.half.y})
                if (*half == 0) *half = 10 * largest;
            const bool is_circle = aperture.shape == 'C', is_turned = aperture.angle_deg != 0;
            if (is_circle && aperture.offset == Vec2d{0, 0}) {
                double& radius = aperture.blocks ? row.inner_semi_diameter : row.clear_semi_diameter;
                radius = radius == 0 || aperture.blocks ? std::max(radius, aperture.half.x)
                                                        : std::min(radius, aperture.half.x);
                continue;
            }
            if (aperture.blocks) {
                shape.obscurations.push_back(
                    {aperture.shape == 'R', aperture.half, aperture.offset, aperture.angle_deg});
                continue;
            }
            if (has_outline) add_foreign("several apertures that are no centred circles", row.line, row.number);
            has_outline = true;
            if (aperture.shape == 'R' && is_turned) {
                shape.offset = aperture.offset;
                shape.kind = ApertureOutline::polygon;
                const std::vector<Vec2d> corners = rotated_rectangle(aperture.half, aperture.angle_deg);
                shape.corners.insert(shape.corners.end(), corners.begin(), corners.end());
                continue;
            }
            set_outline(shape, is_circle, aperture.shape == 'R', aperture.half, aperture.offset);
            if (!is_circle && is_turned)
                add_foreign("an ellipse as an aperture that is turned (ARO)", row.line, row.number);
        }
        // Several apertures pass only the light that each of them passes.
        limit_to_outline(row);
        row.is_open_outside = row.clear_semi_diameter == 0 && shape.is_plain();
    }

    void finish_shape(CodeVSurface& s) const {
        SurfaceForm& form = s.row.form;
        const double radius = unit_ * (s.special_radius == 0 ? 1 : s.special_radius);
        for (const auto& [number, value] : s.special_terms) {
            if (value == 0) continue;
            const auto [x, y] = xy_powers(number);
            if (s.special == "ODD")
                s.row.aspheric[number] += unit_ * value / std::pow(radius, number);
            else
                form.xy.push_back({x, y, unit_ * value / std::pow(radius, x + y)});
        }
        if (s.toroid == "AAS") return finish_anamorphic(s);
        form.conic_x = 0;
        if (s.toroid.empty()) form.curvature_x = 0;  // CUX has no effect on surfaces of revolution
        if (s.toroid.empty()) return;
        form.base = BaseForm::toroid;
        if (s.toroid == "YTO" || (s.toroid == "CYL" && form.curvature_x == 0)) return;
        std::swap(s.row.curvature, form.curvature_x);
        turn_about_axis(s.row);
    }

    void finish_anamorphic(CodeVSurface& s) const {
        s.row.form.base = BaseForm::biconic;
        for (int n = 2; n <= 5; ++n) {
            const char letter = "ABCD"[n - 2];
            const double r = s.anamorphic[{letter, 'R'}] * std::pow(unit_, 1 - 2 * n), p = s.anamorphic[{letter, 'P'}];
            if (r == 0) continue;
            if (p == 0) {
                s.row.aspheric[2 * n] += r;
                continue;
            }
            // r ((1 - p) x^2 + (1 + p) y^2)^n
            double binomial = 1;
            for (int k = 0; k <= n; ++k) {
                s.row.form.xy.push_back(
                    {2 * (n - k), 2 * k, r * binomial * std::pow(1 - p, n - k) * std::pow(1 + p, k)});
                binomial *= static_cast<double>(n - k) / (k + 1);
            }
        }
    }

    void finish_fields() {
        const double scale = p_.field_kind == FieldKind::angle_deg ? 1 : unit_;
        const auto cut = [&](const char* word, std::size_t i) { return vignetting(at_or_0(vignetting_[word], i)); };
        for (std::size_t i = 0; i < std::max(x_.size(), y_.size()); ++i)
            p_.fields.push_back({scale * at_or_0(x_, i), scale * at_or_0(y_, i), cut("VUX", i), cut("VLX", i),
                                 cut("VUY", i), cut("VLY", i)});
    }

    void finish_zoom() {
        const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
        for (const auto& [surface, zoomed] : zoom_) {
            const auto& [values, line] = zoomed;
            if (surface == -1 || surface + 1 >= static_cast<int>(surfaces_.size()))
                fail_at("ZOO THI changes the thickness of a surface that is none of the lens", line, surface);
            for (const double value : values) {
                if (surface > 0 && !std::isfinite(value))
                    fail_at("ZOO THI makes the thickness infinite; only the object may be as far away", line, surface);
                const bool is_infinite = surface == 0 && unit_ * value >= kLongest;
                p_.zoom_thicknesses[surface - 1].push_back(is_infinite ? kInfinity : unit_ * value);
            }
        }
        for (const double value : zoom_aperture_) {
            if (!std::isfinite(value)) fail_at("ZOO: an aperture of a zoom position is infinite");
            p_.zoom_apertures.push_back(is_length ? unit_ * value : value);
        }
    }

    std::vector<CodeVSurface> surfaces_;  ///< including object and image
    std::size_t current_ = 0;
    bool has_image_ = false, in_private_ = false;
    std::optional<bool> radius_mode_;
    double unit_ = 1;  ///< mm
    std::vector<double> wavelengths_, x_, y_;
    int reference_ = 0, positions_ = 0;
    std::map<std::string, std::vector<double>> vignetting_;
    std::map<int, std::pair<std::vector<double>, int>> zoom_;  ///< thicknesses by surface, and their line
    std::vector<double> zoom_aperture_;
    std::vector<double> private_nm_;
    std::set<std::string> private_names_;
    std::map<std::string, LensFileError> broken_private_;
};

}  // namespace

Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return CodeVReader("CODE V", text, file, glasses).read();
}

}  // namespace realcam::io
