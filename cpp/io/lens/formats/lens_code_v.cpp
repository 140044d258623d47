// Reader of CODE V's sequence files (.seq). A command is a keyword with its values; ';' separates commands within a
// line,
// '!' begins a comment, and '&' at the end of a line continues it. S adds a surface; later commands apply to it, or to
// the surface that they name (S3). Only the first three letters of a keyword are significant.

#include <array>
#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../../text/text_number.hpp"
#include "../lens_format.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {
namespace {

/// Aperture or obscuration of a surface. Lengths in mm.
struct CodeVAperture {
    std::string label;  ///< distinguishes the apertures of a surface; may be empty
    char shape = 'C';  ///< C, R or E: circle, rectangle, ellipse
    bool is_obscuration = false;
    Vec2d half = {0, 0}, offset = {0, 0};  ///< half-widths (0: not specified) and centre
    double angle_deg = 0;
};

/// Surface as specified in a .seq file. The members after `row` are converted into it at the end of the file.
struct CodeVSurface {
    PrescriptionSurface row;
    SurfacePlacement placement;  ///< XDE to CDE
    DecentreKind decentre = DecentreKind::ordinary;
    std::vector<CodeVAperture> apertures;
    std::string toroid;                       ///< CYL, XTO, YTO or AAS; empty for surfaces of revolution
    std::map<std::string, double> anamorphic;  ///< AR to DR and AP to DP of AAS
    std::string special;                      ///< kind of a special surface: XYP or ODD
    double special_radius = 1;                ///< its normalization radius, in the file's unit
    std::map<int, double> special_terms;      ///< its coefficients by number, except the conic constant
};

/// Parses the glass code of a fictitious glass: 517642, 517.642 and 517000.642000 mean n_d = 1.517, V_d = 64.2. Returns
/// std::nullopt if the name is not a glass code.
std::optional<AbbePair> fictitious_glass(const std::string& name) {
    const std::size_t point = name.find_first_of(".:");
    std::string index = name.substr(0, point), abbe = point == name.npos ? "" : name.substr(point + 1);
    if (point == name.npos && name.size() == 6) index = name.substr(0, 3), abbe = name.substr(3);
    if (!is_digits(index) || !is_digits(abbe) || index.size() < 3 || abbe.size() < 3 || index.size() > 15 ||
        abbe.size() > 15)
        return {};
    return AbbePair{std::stod("1." + index), std::stod(abbe.substr(0, 2) + '.' + abbe.substr(2))};
}

/// Reads all commands first, and converts the surfaces at the end of the file.
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
    // Short names for the tables of keywords.
    using R = CodeVReader;
    using C = LensCommand;
    using WordList = std::vector<LensWord>;

    /// Records a command as unsupported.
    static void reject(R& r, C& c) {
        r.selected_row(c);
        r.unsupported(c);
    }
    /// Records a command as unsupported, unless its only value is 0.
    static void reject_unless_0(R& r, C& c) {
        r.selected_row(c);
        if (c.size() != 1 || c.number(0, c.word) != 0) r.unsupported(c);
    }
    /// Leaves a command out, with a warning.
    static void omit(R& r, C& c) { r.remark_omission(c); }

    /// Table of all commands. Those that are ignored do not affect the path of light: names, solves and their control
    /// codes, weights, display.
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
            {"RDM", [](R& r, C& c) { r.radius_mode_ = c.size() == 0 || c.upper(0).starts_with('Y'); }},
            {"DIM", [](R& r, C& c) { r.read_unit(c.upper(0, 1)); }},
            {"WL", [](R& r, C& c) { r.wavelengths_ = r.values(c, 0, c.word); }},
            {"REF",
             [](R& r, C& c) {
                 if (c.size() == 0) r.lines_.fail("REF needs the number of the reference wavelength");
                 r.reference_wavelength_ = c.whole(0, "the number of the reference wavelength", 1, kMaxWavelengths);
             }},
            {"XAN YAN XOB YOB XIM YIM XRI YRI", [](R& r, C& c) { r.read_fields(c); }},
            {"VUX VLX VUY VLY", [](R& r, C& c) { r.vignetting_[c.word] = r.values(c, 0, c.word); }},
            {"TEL AFC AFI",
             [](R& r, C& c) {
                 if (!c.upper(0).starts_with('N'))
                     r.remark(c.word + " (a telecentric object or an afocal image) is left out");
             }},
            {"ZOO", [](R& r, C& c) { r.read_zoom(c); }},
            {"PRV", [](R& r, C&) { r.is_in_private_catalogue_ = true; }},
            // Profiles
            {"STO",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 for (CodeVSurface& other : r.surfaces_) other.row.is_stop = false;  // a lens has one stop
                 row.is_stop = true;
             }},
            {"ASP", [](R& r, C& c) { r.selected_row(c); }},
            {"SPH CON",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 row.aspheric.clear();
                 if (c.word == "SPH") row.conic = 0;
             }},
            {"K", [](R& r, C& c) { r.selected_row(c).conic = c.number(0, "the conic"); }},
            {"A B C D E F G H J",
             [](R& r, C& c) {
                 const int power = 4 + 2 * static_cast<int>(std::string_view("ABCDEFGHJ").find(c.word));
                 PrescriptionSurface& row = r.selected_row(c);
                 row.aspheric[power] = c.number(0, "the coefficient " + c.word) * std::pow(r.unit_, 1 - power);
             }},
            {"CUF", reject_unless_0, "a Fresnel surface"},
            {"THI",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 row.thickness = r.unit_ * c.number_or_infinity(0, "the thickness");
             }},
            {"RDY CUY RAD",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 row.curvature = r.curvature(c, c.word != "CUY");
             }},
            {"GLA RMD",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 if (c.size() == 0) r.lines_.fail(c.word + " needs a value");
                 r.set_glass(row, c[0].text);
             }},
            {"PIM", [](R& r, C&) { r.p_.paraxial_image = true; }},
            {"PIK UMY UMR HMY CUS", omit, "the values in the file are used for its solves and pickups"},
            {"COA MLT", omit, "coatings are left out"},
            // Other forms
            {"YTO XTO CYL AAS", [](R& r, C& c) { r.selected_surface(c).toroid = c.word; }},
            {"RDX CUX",
             [](R& r, C& c) {
                 PrescriptionSurface& row = r.selected_row(c);
                 row.form.curvature_x = c.word == "RDX" ? curvature_of(c.number_or_infinity(0, "the radius"), r.unit_)
                                                        : c.number(0, "the curvature") / r.unit_;
             }},
            {"KX", [](R& r, C& c) { r.selected_row(c).form.conic_x = c.number(0, "the conic"); }},
            {"SPS", [](R& r, C& c) { r.read_special_kind(c); }},
            {"SCO", [](R& r, C& c) { r.read_special_term(c); }},
            {"AR BR CR DR AP BP CP DP",
             [](R& r, C& c) { r.selected_surface(c).anamorphic[c.word] = c.number(0, "the coefficient " + c.word); }},
            // Tilts, decentres and apertures
            {"XDE YDE ZDE ADE BDE CDE", [](R& r, C& c) { r.read_placement(c); }},
            {"DAR", [](R& r, C& c) { r.selected_surface(c).decentre = DecentreKind::and_return; }},
            {"BEN", [](R& r, C& c) { r.selected_surface(c).decentre = DecentreKind::bend; }},
            {"REV", [](R& r, C& c) { r.selected_surface(c).decentre = DecentreKind::reverse; }},
            {"CIR REX REY ELX ELY ADX ADY ARO", [](R& r, C& c) { r.read_aperture(c); }},
            // Features that are not modelled
            {"DIF GRT DOE HOE HWL HOR HCT HCO GRO GRS TOR ANA UD1 LNS MOD NSS INT ARR GRI", reject,
             "a surface that is not a sphere, conic or asphere"},
            {"XOD YOD ZOD GLB XGR YGR ZGR AGR BGR CGR", reject_unless_0, "a tilt or decentre"},
            {"RET", reject, "a return to another surface's axes"},
            {"REC ELL CIG REG ELG",
             [](R& r, C& c) {
                 r.selected_row(c);
                 if (c.upper(0) != "EDG") r.unsupported(c);
             },
             "an aperture that is not a circle"},
        };
        return table;
    }

    /// Reads the commands of a line, up to a comment. Separators within quotes do not count.
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

    /// Reads a command from its words.
    void read_command(WordList words) {
        if (words.empty()) return;
        if (is_in_private_catalogue_) return read_private(words);
        const std::string command = upper_case(words[0].text);
        const std::string_view number = std::string_view(command).substr(command.empty() ? 0 : 1);
        C c(lines_, command.substr(0, 3), {words.begin() + 1, words.end()});
        if (command == "S" || command == "SO" || command == "SI" || command == "S0") return add_surface(command, c);
        if (command[0] == 'S' && is_digits(number)) {
            select(lines_.whole_number_of(number, "the number of the surface", 0, kMaxSurfaceNumber));
            return read_row(c);
        }
        if (command.size() > 1 && command[0] == 'S' && number.find_first_not_of("0123456789.AIO") == number.npos)
            lines_.fail("a range of surfaces (" + in_quotes(command) + "); expected one surface");
        if (changes_lens(command, c) || commands().read(*this, c)) return;
        // An unknown command that names surfaces may change them; any other one is assumed not to affect the light.
        const std::string name = printable(command.substr(0, 20));
        if (names_surfaces(c))
            unsupported("the unknown command " + name);
        else
            add_unknown_keyword(name);
    }

    /// Records a command that edits the lens defined so far as unsupported. Returns false for other commands.
    bool changes_lens(const std::string& command, const C& c) {
        // These must not be ignored: without their effect, the file would be read as a wrong lens.
        static const Keywords<R> changes{
            {"DEL INS SCA FLY COP CPY MOV MER REP EXC SWA INV FLI MIR AUT RES RUN SPL ADD DZO DEZ"}};
        // REV without a range of surfaces is a decentre type; with a range it reverses surfaces.
        const bool reverses = c.word == "REV" && c.size() > 0 && c[0].text.find("..") != std::string_view::npos;
        const bool is_second_lens = c.word == "LEN" && !surfaces_.empty();
        // SET VIG and SET APE compute values from rays; SET THI and others change the lens.
        const bool sets = c.word == "SET" && c.upper(0, 3) != "VIG" && c.upper(0, 3) != "APE";
        if (!is_second_lens && !sets && !reverses && command != "IN" && !changes.find(c.word)) return false;
        std::string text = printable(command.substr(0, 20));
        for (std::size_t i = 0; i < c.size() && i < 3; ++i) text += ' ' + printable(c[i].text.substr(0, 20));
        add_unsupported("the command " + text + ", which makes another lens", lines_.number(), 0);
        return true;
    }

    /// True if the first value of a command names surfaces: S3, S2..5, SA.
    static bool names_surfaces(const C& c) {
        if (c.size() == 0 || c[0].is_quoted) return false;
        const std::string word = c.upper(0, 8);
        return word == "SO" || word == "SI" || word == "SS" || word == "SA" ||
               (word.size() > 1 && word[0] == 'S' && word.find_first_not_of("0123456789.", 1) == word.npos);
    }

    /// Returns the values of a command from index `from` on; at least one.
    std::vector<double> values(const C& c, std::size_t from, const std::string& name) const {
        std::vector<double> list = c.numbers(from, name);
        if (list.empty()) lines_.fail(name + " has no value");
        return list;
    }

    /// Reads the aperture of the lens: EPD, FNO, NA or NAO.
    void read_size(const C& c) {
        static const std::map<std::string, ApertureKind> kinds{{"EPD", ApertureKind::entrance_pupil_diameter},
                                                               {"FNO", ApertureKind::working_f_number},
                                                               {"NA", ApertureKind::image_aperture},
                                                               {"NAO", ApertureKind::object_aperture}};
        p_.aperture_kind = kinds.at(c.word);
        p_.aperture = c.number(0, c.word);
        if (!(p_.aperture > 0)) lines_.fail(c.word + " must be positive");
    }

    void read_unit(const std::string& unit) {
        if (unit != "M" && unit != "C" && unit != "I") lines_.fail("DIM: expected M (mm), C (cm) or I (inches)");
        const double millimetres = unit == "M" ? 1 : unit == "C" ? 10 : 25.4;
        if (!surfaces_.empty() && millimetres != unit_) lines_.fail("DIM must precede the surfaces");
        unit_ = millimetres;
    }

    /// Reads the x or y of all field points. The second letters of the keyword name the kind of field.
    void read_fields(const C& c) {
        const std::string kind = c.word.substr(1);
        p_.field_kind = kind == "AN"   ? FieldKind::angle_deg
                        : kind == "OB" ? FieldKind::object_height
                                       : FieldKind::image_height;
        std::vector<double>& list = c.word[0] == 'X' ? fields_x_ : fields_y_;
        list = field_values(c);
        if (list.empty()) lines_.fail(c.word + " has no value");
    }

    /// Reads ZOO: the number of zoom positions, or the values of a parameter in all of them.
    void read_zoom(const C& c) {
        if (c.size() == 0) lines_.fail("ZOO needs a number of positions, or a parameter that zooming changes");
        if (is_digits(c[0].text)) {
            if (position_count_ > 0) lines_.fail("the number of zoom positions is specified twice");
            position_count_ = c.whole(0, "the number of zoom positions", 1, kMaxFileZoomPositions);
            for (int i = 1; i <= position_count_; ++i) p_.zoom_names.push_back(std::to_string(i));
            return;
        }
        const std::string word = c.upper(0).substr(0, 3);
        static const Keywords<R> remark_omission{{"VUX VLX VUY VLY XAN YAN XIM YIM XRI YRI XOB YOB WTF THC WTW CCY"}};
        if (position_count_ < 1)
            lines_.fail("ZOO with the number of positions must precede the parameters that zooming changes");
        if (word == "TIT") {
            for (std::size_t i = 0; i < p_.zoom_names.size() && i + 1 < c.size(); ++i)
                p_.zoom_names[i] = std::string(c[i + 1].text);
        } else if (word == "THI") {
            const std::string qualifier = c.upper(1);
            const std::string number =
                qualifier == "SO" ? "0" : qualifier.substr(std::min<std::size_t>(1, qualifier.size()));
            if (!qualifier.starts_with('S') || !(qualifier == "SI" || is_digits(number)))
                lines_.fail("ZOO THI needs a surface, as in ZOO THI S5");
            const int surface = qualifier == "SI"
                                    ? -1
                                    : lines_.whole_number_of(number, "the number of the surface", 0, kMaxSurfaceNumber);
            zoom_thicknesses_[surface] = {zoom_values(c, 2, "ZOO THI " + qualifier), lines_.number()};
        } else if (word == "EPD" || word == "FNO" || word == "NA" || word == "NAO") {
            zoom_apertures_ = zoom_values(c, 1, "ZOO " + word);
        } else if (remark_omission.find(word)) {
            remark("fields and weights are taken from the first zoom position (ZOO " + word + " is left out)");
        } else {
            unsupported("zoom positions that change more than thicknesses (ZOO " + printable(word) + ")");
        }
    }

    /// Returns the values of a parameter, one per zoom position, from index `from` on.
    std::vector<double> zoom_values(const C& c, std::size_t from, const std::string& what) const {
        std::vector<double> list;
        for (std::size_t i = from; i < c.size(); ++i) list.push_back(c.number_or_infinity(i, "each value of " + what));
        if (list.size() != p_.zoom_names.size())
            lines_.fail(what + " has " + std::to_string(list.size()) + " values for " +
                        std::to_string(position_count_) + " positions");
        return list;
    }

    /// Adds the object (SO), a surface (S) or the image (SI), and makes it the current surface.
    void add_surface(const std::string& command, const C& c) {
        const bool is_object = command == "SO" || command == "S0";
        if (!radius_mode_) lines_.fail("RDM (radii) or RDM N (curvatures) must precede the first surface");
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

    /// Makes a surface the current one, to which later commands apply.
    void select(int surface) {
        if (surface < 0 || surface >= static_cast<int>(surfaces_.size()))
            lines_.fail("there is no surface " + std::to_string(surface) + " yet");
        current_ = static_cast<std::size_t>(surface);
        lines_.set_surface(surface);
    }

    /// Reads radius or curvature, thickness and glass of the current surface.
    void read_row(const C& c) {
        PrescriptionSurface& row = surfaces_[current_].row;
        row.curvature = curvature(c, *radius_mode_);
        row.thickness = unit_ * c.number_or_infinity(1, "the thickness");
        for (std::size_t i = 2; i < c.size(); ++i) set_glass(row, c[i].text);
    }

    /// Returns the curvature in 1/mm from the first value. Radii from 1e17 mm on mean planes.
    double curvature(const C& c, bool is_radius) const {
        const double value = is_radius ? curvature_of(c.number_or_infinity(0, "the radius"), unit_)
                                       : c.number(0, "the curvature") / unit_;
        return std::fabs(value) < 1e-17 ? 0 : value;
    }

    /// Returns the surface that a qualifier names, S3, SO (object) or SI (image), and removes the qualifier; without
    /// one, the current surface.
    CodeVSurface& selected_surface(C& c) {
        if (surfaces_.empty()) lines_.fail("precedes the first surface");
        const std::string word = c.size() > 0 && !c[0].is_quoted ? c.upper(0) : "";
        if (!word.starts_with('S') || word.size() == 1) return surfaces_[current_];
        const std::string qualifier = word.substr(1);
        if (qualifier.find("..") != qualifier.npos || qualifier == "A")
            lines_.fail("a range of surfaces (" + in_quotes(word) + "); expected one surface");
        if (qualifier != "O" && qualifier != "I" && !is_digits(qualifier)) return surfaces_[current_];
        select(qualifier == "O" ? 0
               : qualifier == "I"
                   ? static_cast<int>(surfaces_.size()) - 1
                   : lines_.whole_number_of(qualifier, "the number of the surface", 0, kMaxSurfaceNumber));
        c.remove_first();
        return surfaces_[current_];
    }
    PrescriptionSurface& selected_row(C& c) { return selected_surface(c).row; }

    /// Reads a decentre or tilt. CODE V's tilts ADE and BDE have the opposite sign.
    void read_placement(C& c) {
        SurfacePlacement& placement = selected_surface(c).placement;
        const double value = c.number(0, "the decentre or tilt");
        const bool is_tilt = c.word[0] < 'X';
        Vec3d& vector = is_tilt ? placement.tilt_deg : placement.decentre;
        const int axis = c.word[0] - (is_tilt ? 'A' : 'X');
        (axis == 0 ? vector.x : axis == 1 ? vector.y : vector.z) = (!is_tilt ? unit_ : axis == 2 ? 1 : -1) * value;
    }

    /// Reads the kind of a special surface (SPS) and its normalisation radius.
    void read_special_kind(C& c) {
        CodeVSurface& s = selected_surface(c);
        const std::string kind = c.upper(0, 10);
        if (kind != "XYP" && kind != "ODD")
            return unsupported("a special surface (SPS" + (kind.empty() ? "" : ' ' + printable(kind)) + ')');
        s.special = kind;
        if (c.size() > 1) s.special_radius = c.number(1, "the normalization radius");
    }

    /// Reads a coefficient of a special surface (SCO), by name or number.
    void read_special_term(C& c) {
        CodeVSurface& s = selected_surface(c);
        if (c.size() < 2) lines_.fail("SCO needs the coefficient's name and its value");
        const std::string name = c.upper(0, 20);
        const double value = c.number(1, "the coefficient");
        if (s.special.empty()) return;  // the kind is unsupported, which is recorded already
        const bool is_odd = s.special == "ODD";
        const auto digits = [&](std::size_t letters) { return std::string_view(name).substr(letters); };
        if (name == "K" || name == "C1") {
            s.row.conic = value;
        } else if (name == "NRADIUS" || (is_odd && name == "C33")) {
            s.special_radius = value;
        } else if (is_odd && name.starts_with("AR") && is_digits(digits(2))) {
            s.special_terms[lines_.whole_number_of(digits(2), "the power of r", 1, 30)] = value;
        } else if (name.starts_with('C') && is_digits(digits(1))) {
            // C2 is the coefficient of the first term: r, or x.
            const int last = is_odd ? 31 : (kMaxXyDegree + 1) * (kMaxXyDegree + 2) / 2;
            s.special_terms[lines_.whole_number_of(digits(1), "the number of the coefficient", 2, last) - 1] = value;
        } else {
            unsupported("a coefficient of a special surface (SCO " + printable(name) + ')');
        }
    }

    /// Reads a circle, one half-width of a rectangle or an ellipse, or a modifier: the offset or rotation of the
    /// preceding aperture. Labels (L'A') distinguish the apertures of a surface.
    void read_aperture(C& c) {
        CodeVSurface& s = selected_surface(c);
        std::string kind = "CLR", label;
        for (std::size_t i = 0; i + 1 < c.size(); ++i) {
            const std::string qualifier = c.upper(i);
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
            return unsupported("a hole through which light passes unrefracted (" + c.word + " HOL)");
        const bool is_modifier = c.word[0] == 'A', is_obscuration = kind == "OBS" || kind == "HOL";
        if (!is_modifier && !(value > 0)) lines_.fail("the size of the aperture must be positive");
        const auto matches = [&](const CodeVAperture& other) {
            return is_modifier
                       ? label.empty() || other.label == label
                       : other.shape == c.word[0] && other.label == label && other.is_obscuration == is_obscuration;
        };
        const auto found = std::find_if(s.apertures.rbegin(), s.apertures.rend(), matches);
        if (found == s.apertures.rend() && is_modifier) lines_.fail(c.word + " has no preceding aperture");
        CodeVAperture& aperture = found != s.apertures.rend() ? *found : s.apertures.emplace_back();
        if (c.word == "ARO") {
            aperture.angle_deg = value;
        } else if (is_modifier) {
            (c.word == "ADX" ? aperture.offset.x : aperture.offset.y) = unit_ * value;
        } else {
            aperture.label = label;
            aperture.shape = c.word[0];
            aperture.is_obscuration = is_obscuration;
            if (!c.word.ends_with('Y')) aperture.half.x = unit_ * value;
            if (!c.word.ends_with('X')) aperture.half.y = unit_ * value;
            s.row.has_aperture = true;
        }
    }

    /// Reads private glasses: PWL and the wavelengths, then a name and an index for each, or a name, a formula and its
    /// coefficients. Errors are reported only if a surface uses the glass: makers' files contain unused ones.
    void read_private(const WordList& words) {
        const std::string word = upper_case(words[0].text);
        if (word == "END") {
            is_in_private_catalogue_ = false;
        } else if (word == "PWL") {
            private_wavelengths_nm_.clear();
            for (std::size_t i = 1; i < words.size(); ++i) {
                std::string_view rest = words[i].text;
                private_wavelengths_nm_.push_back(consume_number(rest).value_or(0));
            }
        } else {
            private_glass_errors_.erase(word);
            try {
                glasses_.define(word, private_glass(words[0].text, {lines_, word, {words.begin() + 1, words.end()}}));
                private_names_.insert(word);
            } catch (const InputError& error) {
                private_glass_errors_.emplace(word, LensReadError(error, lines_.file(), lines_.number()));
            } catch (const LensFileError& error) {
                private_glass_errors_.emplace(word, error);
            }
        }
    }

    /// Returns a private glass: a formula with its coefficients, or an index for each wavelength of PWL. Throws
    /// InputError and LensFileError.
    Glass private_glass(std::string_view name, const C& c) const {
        const std::string what = "the private glass " + in_quotes(name), label = printable(name.substr(0, 100));
        const std::string formula = c.upper(0, 8);
        if (!formula.empty() && formula[0] >= 'A' && formula[0] <= 'Z') {
            if (formula != "LAU")
                throw InputError(what + " is specified by the unknown formula " + in_quotes(c[0].text) +
                                 "; expected LAU (Laurent) or an index for each wavelength");
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
        if (indices.size() != private_wavelengths_nm_.size())
            throw InputError(what + " has " + std::to_string(indices.size()) + " indices for " +
                             std::to_string(private_wavelengths_nm_.size()) + " wavelengths (PWL)");
        if (indices.size() > kMaxFileIndices)
            throw InputError(what + " has more than " + std::to_string(kMaxFileIndices) + " indices");
        if (!is_constant(indices)) return glass_of_indices(private_wavelengths_nm_, indices, label);
        Glass glass = Glass::constant(indices.front());
        glass.label = label;
        return glass;
    }

    /// Sets the medium behind a surface, or makes it a mirror. `text`: REFL, AIR, a glass code or the name of a glass.
    void set_glass(PrescriptionSurface& row, std::string_view text) {
        const std::string name = upper_case(text);
        row.is_mirror = name == "REFL";
        if (name == "REFR" || row.is_mirror) return;
        if (name == "AIR") {
            row.material = Glass::air();
            return;
        }
        if (name == "TIRO" || name == "TIR") return unsupported("total internal reflection (" + name + ")");
        try {
            if (const auto error = private_glass_errors_.find(name);
                error != private_glass_errors_.end() && !glasses_.has_user_glass(name))
                lines_.fail(error->second.detail + " (line " + std::to_string(error->second.line) + ')');
            if (private_names_.contains(name) || glasses_.has_user_glass(name)) {
                row.material = glasses_.find(name, {});
            } else if (const std::optional<AbbePair> pair = fictitious_glass(name)) {
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

    /// Converts the stored surfaces, fields, wavelengths and zoom positions to the prescription.
    void finish() {
        const PrescriptionSurface& object = surfaces_.front().row;
        set_object(object.thickness, object.curvature, object.line);
        for (CodeVSurface& s : surfaces_) {
            if (&s != &surfaces_.front() && std::isinf(s.row.thickness))
                fail_at("the thickness is infinite; only the object may be as far away", s.row.line, s.row.number);
            set_decentre(s.placement, s.decentre, s.row);
            finish_aperture(s);
            finish_shape(s);
            p_.surfaces.push_back(s.row);
        }
        const PrescriptionSurface image = p_.surfaces.back();
        p_.surfaces.erase(p_.surfaces.begin());
        p_.surfaces.pop_back();
        if (image.conic != 0 || !image.aspheric.empty() || !image.form.adds_nothing())
            add_unsupported("an image surface that is not a sphere", image.line, image.number);
        p_.defocus = image.thickness;
        p_.image_semi_diameter = image.clear_semi_diameter;
        p_.image_curvature = image.curvature;
        p_.image_placement = SurfacePlacement::from_frame(image.before);
        if (p_.surfaces.empty()) fail_at("has no surface between object and image");
        if (p_.aperture_kind == ApertureKind::entrance_pupil_diameter) p_.aperture *= unit_;
        finish_fields();
        const std::size_t main =
            reference_wavelength_ > 0 ? static_cast<std::size_t>(reference_wavelength_) : wavelengths_.size() / 2 + 1;
        if (!wavelengths_.empty() && main > wavelengths_.size())
            fail_at("the reference wavelength (REF) is number " + std::to_string(main) + " of " +
                    std::to_string(wavelengths_.size()));
        set_wavelengths(wavelengths_, main - 1);
        finish_zoom();
        remark_unknown_keywords("commands");
    }

    /// Combines the apertures of a surface: the smallest centred circle, one other outline, and obscurations.
    void finish_aperture(CodeVSurface& s) {
        if (s.apertures.empty()) return;
        PrescriptionSurface& row = s.row;
        ApertureShape& shape = row.aperture_shape;
        double largest = 0;
        for (const CodeVAperture& aperture : s.apertures)
            largest = std::max({largest, aperture.half.x, aperture.half.y});
        bool has_outline = false;
        for (CodeVAperture& aperture : s.apertures) {
            // A half-width that is not specified does not limit the light.
            constexpr double kUnlimited = 10;  // times the largest half-width of the surface
            for (double* half : {&aperture.half.x, &aperture.half.y})
                if (*half == 0) *half = kUnlimited * largest;
            const bool is_circle = aperture.shape == 'C', is_rotated = aperture.angle_deg != 0;
            if (is_circle && aperture.offset == Vec2d{0, 0}) {
                double& radius = aperture.is_obscuration ? row.inner_semi_diameter : row.clear_semi_diameter;
                radius = radius == 0 || aperture.is_obscuration ? std::max(radius, aperture.half.x)
                                                                : std::min(radius, aperture.half.x);
                continue;
            }
            if (aperture.is_obscuration) {
                shape.obscurations.push_back(
                    {aperture.shape == 'R', aperture.half, aperture.offset, aperture.angle_deg});
                continue;
            }
            if (has_outline) add_unsupported("several apertures that are not centred circles", row.line, row.number);
            has_outline = true;
            if (aperture.shape == 'R' && is_rotated) {
                shape.offset = aperture.offset;
                shape.kind = ApertureOutline::polygon;
                const std::vector<Vec2d> corners = rotated_rectangle(aperture.half, aperture.angle_deg);
                shape.corners.insert(shape.corners.end(), corners.begin(), corners.end());
                continue;
            }
            set_outline(shape, is_circle, aperture.shape == 'R', aperture.half, aperture.offset);
            if (!is_circle && is_rotated) add_unsupported("a rotated elliptical aperture (ARO)", row.line, row.number);
        }
        // Several apertures pass only the light that each of them passes.
        limit_to_outline(row);
        row.is_open_outside = row.clear_semi_diameter == 0 && shape.is_plain();
    }

    /// Converts special terms, toroid and anamorphic asphere to the form of the row.
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
        swap_toroid_axes(s.row);
    }

    /// Converts an anamorphic asphere (AAS): a biconic with terms A to D, expanded to powers of x and y.
    void finish_anamorphic(CodeVSurface& s) const {
        s.row.form.base = BaseForm::biconic;
        for (int n = 2; n <= 5; ++n) {
            const char letter = "ABCD"[n - 2];
            const double r = s.anamorphic[{letter, 'R'}] * std::pow(unit_, 1 - 2 * n),
                         ratio = s.anamorphic[{letter, 'P'}];
            if (r == 0) continue;
            if (ratio == 0) {
                s.row.aspheric[2 * n] += r;
                continue;
            }
            // The term r ((1 - ratio) x^2 + (1 + ratio) y^2)^n, expanded by the binomial theorem.
            double binomial = 1;
            for (int k = 0; k <= n; ++k) {
                s.row.form.xy.push_back(
                    {2 * (n - k), 2 * k, r * binomial * std::pow(1 - ratio, n - k) * std::pow(1 + ratio, k)});
                binomial *= static_cast<double>(n - k) / (k + 1);
            }
        }
    }

    void finish_fields() {
        const double scale = p_.field_kind == FieldKind::angle_deg ? 1 : unit_;
        const auto factor = [&](const char* word, std::size_t i) {
            return vignetting(element_or_0(vignetting_[word], i));
        };
        for (std::size_t i = 0; i < std::max(fields_x_.size(), fields_y_.size()); ++i)
            p_.fields.push_back({scale * element_or_0(fields_x_, i), scale * element_or_0(fields_y_, i),
                                 factor("VUX", i), factor("VLX", i), factor("VUY", i), factor("VLY", i)});
    }

    void finish_zoom() {
        const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
        for (const auto& [surface, zoomed] : zoom_thicknesses_) {
            const auto& [values, line] = zoomed;
            if (surface == -1 || surface + 1 >= static_cast<int>(surfaces_.size()))
                fail_at("ZOO THI changes the thickness of a surface that the lens does not have", line, surface);
            for (const double value : values) {
                if (surface > 0 && !std::isfinite(value))
                    fail_at("ZOO THI makes the thickness infinite; only the object may be as far away", line, surface);
                const bool is_infinite = surface == 0 && unit_ * value >= kLongest;
                p_.zoom_thicknesses[surface - 1].push_back(is_infinite ? kInfinity : unit_ * value);
            }
        }
        for (const double value : zoom_apertures_) {
            if (!std::isfinite(value)) fail_at("ZOO: an aperture of a zoom position is infinite");
            p_.zoom_apertures.push_back(is_length ? unit_ * value : value);
        }
    }

    std::vector<CodeVSurface> surfaces_;  ///< including object and image
    std::size_t current_ = 0;  ///< index of the surface to which commands apply
    bool has_image_ = false, is_in_private_catalogue_ = false;
    std::optional<bool> radius_mode_;  ///< RDM: true for radii, false for curvatures
    double unit_ = 1;  ///< length of the file's unit, mm
    std::vector<double> wavelengths_, fields_x_, fields_y_;  ///< wavelengths in nm, fields in the file's unit
    int reference_wavelength_ = 0, position_count_ = 0;
    std::map<std::string, std::vector<double>> vignetting_;  ///< factors of all fields by keyword: VUX, VLX, VUY, VLY
    std::map<int, std::pair<std::vector<double>, int>>
        zoom_thicknesses_;  ///< by surface (-1: image): thicknesses in the file's unit, and the line
    std::vector<double> zoom_apertures_;
    std::vector<double> private_wavelengths_nm_;
    std::set<std::string> private_names_;
    std::map<std::string, LensFileError> private_glass_errors_;  ///< error of each invalid private glass, by name
};

}  // namespace

Prescription read_code_v(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return CodeVReader("CODE V", text, file, glasses).read();
}

}  // namespace realcam::io
