// Reader of Zemax OpticStudio's lens files (.zmx). A line is a keyword of four letters and its values; "SURF n" begins
// a surface, to which later lines with a surface keyword belong. Surface 0 is the object, and the last one is the
// image.

#include <algorithm>
#include <cmath>

#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../lens_format.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {
namespace {

/// Surface as specified in a .zmx file. Lengths in mm, except for parameters whose unit depends on the surface type;
/// these are in the file's unit.
struct ZemaxSurface {
    PrescriptionSurface row;
    std::string type = "STANDARD";  // the type in files without TYPE lines
    std::map<int, double> parameters, extra_data;  ///< PARM and XDAT, by number
    std::string glass;       ///< name; empty: air
    std::string index_hint;  ///< n_d and V_d as text for messages; empty if the file has none
    int glass_line = 0;
    int glass_kind = 0;  ///< 0: catalogue glass, 1: model glass, 2: pickup, 4: offset
    int pickup = 0;  ///< surface whose glass is picked up; 0: none
    /// n_d, V_d and partial dispersion of a model glass; for other glasses possibly left over from an earlier glass.
    double n_d = 0, v_d = 0, partial = 0;
    double diameter = 0;  ///< DIAM, which is the semi-diameter
    Vec2d aperture_offset = {0, 0};  ///< offset of its aperture and its obscurations, mm
    double arm_width = 0;  ///< width of the arms of a spider, mm
    int arms = 0;
    bool has_thickness = false, at_infinity = false;  ///< at_infinity: DISZ is infinite

    /// True if n_d and V_d in the line GLAS can be those of a glass: not the defaults of new files (1.5 and 40), and
    /// within the range of optical glasses.
    bool has_index_pair() const {
        const bool are_defaults = n_d == 1.5 && v_d == 40;
        return n_d >= 1.3 && n_d <= 2.4 && v_d >= 10 && v_d <= 100 && !are_defaults;
    }
};

/// Returns the frame after a coordinate break: decentre, then tilts about x, y and z; in the reverse order if
/// `is_reversed`.
Affine<double> frame_of_break(Vec2d decentre, Vec3d tilt_deg, bool is_reversed) {
    const SurfacePlacement shift{{decentre.x, decentre.y, 0}, {}, false};
    if (!is_reversed) return SurfacePlacement{shift.decentre, tilt_deg, false}.frame();
    return rotation(0, 0, tilt_deg.z) * rotation(0, tilt_deg.y, 0) * rotation(tilt_deg.x, 0, 0) * shift.frame();
}

constexpr int kLastParameter = 12;  // PARM; extra data have the following numbers in OpticStudio's editor

/// Returns the value of a number; 0 if the map does not have it.
double value_or_0(const std::map<int, double>& values, int number) {
    const auto found = values.find(number);
    return found == values.end() ? 0.0 : found->second;
}

/// Reads the surfaces in the file's order first; their conversion needs all of them.
class ZemaxReader : PrescriptionText {
public:
    using PrescriptionText::PrescriptionText;

    Prescription read() {
        std::string_view line;
        while (lines_.next(line)) read_line(line);
        const bool begins_with_face = has_only_faces_ || (!surfaces_.empty() && !surfaces_.front().glass.empty());
        if (surfaces_.size() < (begins_with_face ? 2 : 3))
            fail_at("has " + std::to_string(surfaces_.size()) +
                    " surfaces (SURF); expected an object, a lens and an image");
        complete_ends();
        trusts_index_pairs_ = check_index_pairs();
        for (std::size_t i = 0; i < surfaces_.size(); ++i) convert(surfaces_[i], i);
        convert_object();
        convert_fields();
        convert_wavelengths();
        convert_zoom();
        remark_unknown_keywords("keywords");
        return std::move(p_);
    }

private:
    // Short names for the tables of keywords.
    using R = ZemaxReader;
    using C = LensCommand;

    /// Records a command as unsupported.
    static void reject(R& r, C& c) { r.unsupported(c); }
    /// Reads a number from `min` to `max` and a value, and stores the value under the number.
    static void set_numbered(const C& c, std::map<int, double>& values, const std::string& name, int min, int max) {
        const int number = c.whole(0, "the number of " + name, min, max);
        values[number] = c.number(1, name);
    }

    ZemaxSurface& last_surface() { return surfaces_.back(); }
    /// Row of the last surface, to which commands apply.
    PrescriptionSurface& row() { return surfaces_.back().row; }
    // Return lengths in mm. `name`: noun phrase for messages.
    double length(const C& c, std::size_t i, const char* name) const { return unit_ * c.number(i, name); }
    double length_or_infinity(const C& c, std::size_t i, const char* name) const {
        return unit_ * c.number_or_infinity(i, name);
    }
    Vec2d lengths(const C& c, const char* name) const { return {length(c, 0, name), length(c, 1, name)}; }

    /// Keywords of a surface. Those that are ignored do not affect the path of light, or repeat other keywords: names,
    /// solves, tolerances, drawing.
    static const Keywords<R>& surface_keywords() {
        static const Keywords<R> table{
            {"HIDE MIRR SLAB POPS MEMA FIMP VDSZ PPAR VPAR PZUP PKUP MAZH BRDF EDGE VCON VCUR DMFS SCAT RLIN GOPT "
             "LSEL TCED TRAC TOLE CRIX WCBK HDEN COFN VGLA CUPD ISNA PCUR MACH PTHI COMM"},
            {"STOP", [](R& r, C&) { r.row().is_stop = true; }},
            {"TYPE",
             [](R& r, C& c) {
                 if (c.size() == 0) r.lines_.fail("TYPE needs the type of the surface");
                 r.last_surface().type = c.upper(0);
             }},
            {"CURV", [](R& r, C& c) { r.row().curvature = c.number(0, "the curvature") / r.unit_; }},
            {"CONI", [](R& r, C& c) { r.row().conic = c.number(0, "the conic"); }},
            {"DISZ",
             [](R& r, C& c) {
                 if (c.size() == 0) r.lines_.fail("DISZ needs the thickness");
                 const double thickness = r.length_or_infinity(c, 0, "the thickness");
                 r.last_surface().has_thickness = true;
                 r.last_surface().at_infinity = std::isinf(thickness);
                 r.row().thickness = r.last_surface().at_infinity ? 0 : thickness;
             }},
            {"DIAM", [](R& r, C& c) { r.last_surface().diameter = r.length(c, 0, "the semi-diameter"); }},
            {"CLAP FLAP", [](R& r, C& c) { r.read_circle(c); }},
            {"OBSC", [](R& r, C& c) { r.read_obscuration(c); }},
            {"OBDC", [](R& r, C& c) { r.last_surface().aperture_offset = r.lengths(c, "the decentre"); }},
            {"SQAP ELAP",
             [](R& r, C& c) {
                 r.row().has_aperture = true;
                 r.row().aperture_shape.kind = c.word == "SQAP" ? ApertureOutline::rectangle : ApertureOutline::ellipse;
                 r.row().aperture_shape.half = r.lengths(c, "the half width");
             }},
            {"SQOB ELOB",
             [](R& r, C& c) {
                 r.row().has_aperture = true;
                 r.row().aperture_shape.obscurations.push_back(
                     {c.word == "SQOB", r.lengths(c, "the half width"), {0, 0}, 0});
             }},
            {"SPID",
             [](R& r, C& c) {
                 r.row().has_aperture = true;
                 r.last_surface().arm_width = r.length(c, 0, "the width of the arms");
                 if (c.size() < 2) r.lines_.fail("SPID needs the number of arms");
                 r.last_surface().arms = c.whole(1, "the number of arms", 1, kMaxObscurations);
             }},
            {"UDAD USAP UDOB", reject, "an aperture that is not a circle"},
            {"SCBD", [](R& r, C& c) { r.read_tilt(c); }},
            {"TILT SDEC", reject, "a tilted or decentred surface"},
            {"GLAS", [](R& r, C& c) { r.read_glass(c); }},
            {"PARM", [](R& r, C& c) { set_numbered(c, r.last_surface().parameters, "the parameter", 0, 300); }},
            {"XDAT", [](R& r, C& c) { set_numbered(c, r.last_surface().extra_data, "the extra datum", 1, 1000); }},
            {"COAT", [](R& r, C& c) { r.coatings_.insert(c.size() == 0 ? "" : printable(c[0].text.substr(0, 40))); }},
        };
        return table;
    }

    /// Keywords of the lens as a whole. Those that are ignored do not affect the path of light.
    static const Keywords<R>& system_keywords() {
        static const Keywords<R> table{
            {"VERS PFIL LANG ENVD GFAC RAIM PUSH SDMA OMMA ROPD PICB HYPR FWGN FWGT WWGT WWGN ZVAN POLS GLRS GSTD NSCD "
             "COFN NOTE BLNK TOL MOFF DBDT OPDX CONF PUPD EFFL MNCA MNEA MNCG MNEG MXCA MXCG RGLA TCMM TOTR XDFL CHCO "
             "FCHR TCNT ANGC COMN WFNO PMAG DMFS ANON MCOM VANN VDXN VCXN UDFL LOCK COMM"},
            {"MODE",
             [](R& r, C& c) {
                 if (c.size() > 0 && c.upper(0) != "SEQ")
                     r.lines_.fail("the mode is " + in_quotes(c[0].text) + "; expected a sequential lens (MODE SEQ)");
             }},
            {"UNIT", [](R& r, C& c) { r.set_unit(c.size() == 0 ? "MM" : c.upper(0)); }},
            {"ENPD",
             [](R& r, C& c) {
                 r.set_aperture(ApertureKind::entrance_pupil_diameter, r.length(c, 0, "the entrance pupil diameter"));
             }},
            {"FNUM",
             [](R& r, C& c) {
                 const bool working = c.number_or(1, "the kind of f-number", 0) == 1;
                 r.set_aperture(working ? ApertureKind::working_f_number : ApertureKind::f_number,
                                c.number(0, "the f-number"));
             }},
            {"OBNA",
             [](R& r, C& c) {
                 if (c.number_or(1, "the kind of aperture", 0) != 0)
                     r.lines_.fail(
                         "the aperture is a cone angle; expected "
                         "an entrance pupil diameter, an f-number or a numerical aperture");
                 r.set_aperture(ApertureKind::object_aperture, c.number(0, "the numerical aperture"));
             }},
            {"FLOA", [](R& r, C&) { r.p_.aperture_kind = ApertureKind::stop_size; }},
            {"GCAT",
             [](R& r, C& c) {
                 for (std::size_t i = 0; i < c.size(); ++i) r.catalogues_.emplace_back(c[i].text);
                 if (r.catalogues_.size() > 100) r.lines_.fail("GCAT lists more than 100 catalogues of glass");
             }},
            {"FTYP",
             [](R& r, C& c) {
                 r.field_type_ = c.whole(0, "the type of the fields", 0, 10);
                 const double count = c.number_or(2, "the number of fields", 0);
                 r.field_count_ = static_cast<std::size_t>(std::clamp(count, 0.0, static_cast<double>(kMaxFileFields)));
             }},
            {"XFLN XFLD", [](R& r, C& c) { r.fields_x_ = r.field_values(c); }},
            {"YFLN YFLD", [](R& r, C& c) { r.fields_y_ = r.field_values(c); }},
            {"VDYN", [](R& r, C& c) { r.pupil_shift_y_ = r.field_values(c); }},
            {"VCYN", [](R& r, C& c) { r.pupil_compression_y_ = r.field_values(c); }},
            {"WAVM", [](R& r, C& c) { set_numbered(c, r.wavelengths_, "the wavelength", 1, kMaxWavelengths); }},
            {"WAVL",
             [](R& r, C& c) {
                 for (std::size_t i = 0; i < c.size() && i < kMaxFileFields; ++i)
                     r.wavelengths_[static_cast<int>(i) + 1] = c.number(i, "each wavelength");
             }},
            {"PWAV",
             [](R& r, C& c) { r.primary_ = c.whole(0, "the number of the primary wavelength", 1, kMaxWavelengths); }},
            {"AFOC", [](R& r, C&) { r.remark("its image is afocal, which is left out"); }},
            {"MNUM",
             [](R& r, C& c) {
                 r.configuration_count_ = c.whole(0, "the number of configurations", 1, kMaxFileZoomPositions);
                 r.current_configuration_ =
                     c.size() > 1 ? c.whole(1, "the current configuration", 1, kMaxFileZoomPositions) : 1;
             }},
        };
        return table;
    }

    /// Operands of the multi-configuration editor: keyword, surface, configuration, value.
    static const Keywords<R>& zoom_keywords() {
        static const Keywords<R> table{
            {"FVCX FVCY FVDX FVDY FVAN YFIE XFIE FLWT WLWT FLTP LTTL HOLD",
             [](R& r, C& c) {
                 r.remark("the fields and vignetting of the first configuration are used (" + c.word + " is left out)");
             }},
            {"CRVT CONN PRAM PAR1 PAR2 PAR3 PAR4 GLSS STPS CSP1 IGNR IGNM WAVE PRWV TEMP PRES MIND MABB MDPG NPAR NPOS "
             "CATN APDX APDY APMN APMX APTP EDVA PSCX PSCY",
             reject, "configurations that change more than thicknesses"},
            {"THIC", [](R& r, C& c) { r.read_configuration_value(c, r.zoom_thicknesses_); }},
            {"SDIA", [](R& r, C& c) { r.read_configuration_value(c, r.zoom_semi_diameters_); }},
            {"APER", [](R& r, C& c) { r.read_configuration_value(c, r.zoom_apertures_); }},
        };
        return table;
    }

    /// Reads a line by a table of keywords. Returns false if the table does not have the keyword. `rest`: the line
    /// behind the keyword, which is split into words only for known keywords: other lines may be free text.
    bool read_keyword(const Keywords<R>& table, const std::string& word, std::string_view rest) {
        const auto* known = table.find(word);
        if (!known || !known->read) return known != nullptr;
        LensCommand command(lines_, word, lines_.words(rest));
        return table.read(*this, command);
    }

    void read_line(std::string_view line) {
        std::string_view rest = without_blanks(line);
        if (rest.empty()) return;
        const std::string word = upper_case(rest.substr(0, rest.find_first_of(" \t")));
        rest = without_blanks(rest.substr(std::min(rest.size(), word.size())));
        if (word == "NAME") return set_title(rest);
        if (word == "SURF") return begin_surface(LensCommand(lines_, word, lines_.words(rest)));
        // Indents are ignored, because programs other than OpticStudio omit them. The keyword tells whether a line
        // belongs to a surface.
        const bool is_indented = line[0] == ' ' || line[0] == '\t';
        if (!surfaces_.empty()) {
            lines_.set_surface(row().number);
            has_indents_ = has_indents_ || is_indented;
            if (read_keyword(surface_keywords(), word, rest)) return;
        }
        lines_.set_surface(0);
        if (read_keyword(system_keywords(), word, rest)) return;
        if (configuration_count_ > 1 && read_keyword(zoom_keywords(), word, rest)) return;
        // The surfaces are followed by hundreds of operands of the merit function, which are not indented.
        if (surfaces_.empty() || !has_indents_ || is_indented) add_unknown_keyword(word);
    }

    /// Sets the title, without quotes.
    void set_title(std::string_view text) {
        if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
        p_.title = std::string(text);
    }

    /// Reads SURF: adds a surface, whose number must follow that of the last one.
    void begin_surface(const C& c) {
        if (c.size() == 0) lines_.fail("SURF needs the surface's number");
        // Exporters that insert a stop between two numbered faces label it "5AS".
        const std::string_view word = c[0].text, digits = word.substr(0, word.find_first_of("ASas"));
        const bool is_inserted = digits.size() < word.size() && !surfaces_.empty();
        const int number = lines_.whole_number_of(is_inserted ? digits : word, "the number of the surface", 0, 1 << 30);
        check_count(surfaces_.size());
        if (number == 1 && surfaces_.empty()) {  // exporters that list only faces begin with the first face
            has_only_faces_ = true;
            surfaces_.emplace_back();
            last_surface().has_thickness = last_surface().at_infinity = true;
        }
        const int expected = surfaces_.empty() ? 0 : row().number + (is_inserted ? 0 : 1);
        if (number != expected)
            lines_.fail("surface " + std::to_string(number) + " follows " +
                        (surfaces_.empty() ? std::string("nothing; expected surface 0, the object")
                                           : "surface " + std::to_string(row().number) + "; expected surface " +
                                                 std::to_string(expected)));
        surfaces_.emplace_back();
        row().number = number;
        row().line = lines_.number();
        lines_.set_surface(number);
    }

    /// Reads an annular aperture (CLAP or FLAP). The outer radius of a floating one (FLAP) is the semi-diameter.
    void read_circle(const C& c) {
        row().has_aperture = true;
        const double inner = length(c, 0, "the inner radius"), outer = length_or_infinity(c, 1, "the outer radius");
        row().inner_semi_diameter = std::max(row().inner_semi_diameter, inner);
        row().is_open_outside = c.word == "CLAP" && outer == kInfinity;
        if (c.word == "CLAP" && !row().is_open_outside) row().clear_semi_diameter = outer;
    }

    /// Reads a circular obscuration (OBSC). The semi-diameter (DIAM) of a surface with an obscuration does not limit
    /// light.
    void read_obscuration(const C& c) {
        row().has_aperture = true;
        if (length(c, 0, "the inner radius") != 0)
            unsupported("an obscuration with a hole");
        else
            row().inner_semi_diameter = std::max(row().inner_semi_diameter, length(c, 1, "the outer radius"));
        row().is_open_outside = row().clear_semi_diameter == 0;
    }

    /// Reads tilt and decentre of the surface itself (SCBD). The values are: side (1: before, 2: behind the surface),
    /// order, source, decentre x and y, tilt about x, y and z.
    void read_tilt(const C& c) {
        const int side = c.whole(0, "the side of the tilt", 1, 2);
        const auto value = [&](std::size_t i) { return c.number_or(i, "the tilt or decentre", 0); };
        const Vec2d decentre{length(c, 3, "the decentre"), length(c, 4, "the decentre")};
        const Affine<double> frame = frame_of_break(decentre, {value(5), value(6), value(7)}, value(1) != 0);
        // Source of the tilt behind the surface: 1 repeats the one before it, and 2 reverses that.
        const double source = value(2);
        if (side == 1)
            row().before = frame;
        else
            row().behind = source == 1 ? row().before : source == 2 ? inverse_motion(row().before) : frame;
        if (source != 0 && (side == 1 || source > 2)) unsupported("a tilt that is picked up (SCBD)");
    }

    /// Returns n_d or V_d in GLAS, 0 if it is absent. Some editors write these two with a decimal comma.
    double glass_number(const C& c, std::size_t i, const char* what) {
        const std::string_view word = i < c.size() ? c[i].text : "";
        const std::size_t comma = word.find_first_of(",.");
        if (comma == word.npos || word[comma] != ',' || word.find_first_of(",.", comma + 1) != word.npos)
            return c.number_or(i, what, 0);
        std::string with_point(word);
        with_point[comma] = '.';
        remark("surface " + std::to_string(lines_.surface()) + ": the comma of " + in_quotes(word) +
               " is read as a decimal point");
        return lines_.number_of(with_point, what);
    }

    /// Reads GLAS: name, kind, surface of a pickup, n_d, V_d, partial dispersion.
    void read_glass(const C& c) {
        if (c.size() == 0) lines_.fail("GLAS needs the name of the glass");
        ZemaxSurface& s = last_surface();
        s.glass = std::string(c[0].text);
        s.glass_line = lines_.number();
        s.glass_kind = c.size() > 1 ? c.whole(1, "the kind of the glass", 0, 100) : 0;
        s.pickup = s.glass_kind == 2 && c.size() > 2
                       ? c.whole(2, "the surface whose glass is picked up", 0, kMaxSurfaceNumber)
                       : 0;
        s.n_d = glass_number(c, 3, "the glass's n_d");
        s.v_d = glass_number(c, 4, "the glass's V_d");
        s.partial = c.number_or(5, "the glass's partial dispersion", 0);
        if (s.has_index_pair())
            s.index_hint =
                "n_d = " + printable(c[3].text.substr(0, 30)) + ", V_d = " + printable(c[4].text.substr(0, 30));
    }

    void set_unit(const std::string& unit) {
        if (!surfaces_.empty()) lines_.fail("UNIT must precede the surfaces");
        const std::optional<double> known = millimetres_of(unit);
        if (!known) lines_.fail("the unit is " + in_quotes(unit) + "; expected MM, CM, IN or METER");
        unit_ = *known;
    }

    void set_aperture(ApertureKind kind, double value) {
        if (!(value > 0)) lines_.fail("the aperture must be positive");
        p_.aperture_kind = kind;
        p_.aperture = value;
    }

    /// Reads the value of a parameter in one configuration: surface, configuration, value. Values that the file does
    /// not specify are NaN.
    void read_configuration_value(const C& c, std::map<int, std::vector<double>>& values_by_surface) {
        if (c.size() < 3) lines_.fail(c.word + " needs a surface, a configuration and a value");
        const int position = c.whole(1, "the configuration", 1, configuration_count_);
        const double value = is_infinity(c[2].text) ? kInfinity : c.number(2, "the value");
        const bool has_surface = c.word != "APER";
        std::vector<double>& values =
            values_by_surface[has_surface ? c.whole(0, "the surface", 0, kMaxSurfaceNumber) : 0];
        values.resize(static_cast<std::size_t>(configuration_count_), std::nan(""));
        values[static_cast<std::size_t>(position) - 1] = value;
    }

    /// Adds object and image to files that list only the refracting faces: some exporters give surface 0 the glass of
    /// the first element, and end the list at the last face.
    void complete_ends() {
        const bool begins_in_glass = !surfaces_.front().glass.empty() && !surfaces_.front().at_infinity;
        const ZemaxSurface end = surfaces_.back();  // a copy, because surfaces are inserted below
        const bool ends_in_glass = !surfaces_[surfaces_.size() - 2].glass.empty() && end.glass.empty();
        if (begins_in_glass && ends_in_glass) {
            ZemaxSurface object;
            object.has_thickness = object.at_infinity = true;
            surfaces_.insert(surfaces_.begin(), object);
            has_only_faces_ = true;
        }
        if (!has_only_faces_) return check_image(end);
        surfaces_.emplace_back();
        row().number = end.row.number + 1;
        last_surface().has_thickness = true;
        p_.has_film_distance = false;
        remark("lists only faces: the object is assumed to be distant, and the film to lie at best focus");
    }

    /// Checks that the last surface is the image. If it has a glass or a thickness, the file is truncated.
    void check_image(const ZemaxSurface& image) const {
        if (!image.has_thickness || image.row.thickness != 0 || !image.glass.empty())
            fail_at("the file ends with a surface that is not an image: it " +
                        std::string(!image.glass.empty()  ? "has a glass"
                                    : image.has_thickness ? "has a thickness"
                                                          : "has no thickness (DISZ)"),
                    image.row.line, image.row.number);
    }

    /// Checks surface i, and adds its row to the prescription unless it is the object or the image.
    void convert(ZemaxSurface& s, std::size_t i) {
        const bool is_object = i == 0, is_image = i + 1 == surfaces_.size();
        const auto fail = [&](const std::string& message) { fail_at(message, s.row.line, s.row.number); };
        const auto reject = [&](const std::string& what) { add_unsupported(what, s.row.line, s.row.number); };
        if (!s.has_thickness) fail("the surface has no thickness (DISZ)");
        if (s.at_infinity && !is_object) fail("the thickness is infinite; only the object may be as far away");
        if (is_image) {
            p_.image_curvature = s.row.curvature;
            if (s.row.curvature != 0 && (s.row.conic != 0 || s.type != "STANDARD"))
                reject("an image surface that is not a sphere");
            if (s.row.is_stop) fail("the image is the aperture stop");
            if (s.type == "COORDBRK") fail("the image is a coordinate break");
            p_.image_semi_diameter = s.diameter;
        }
        if (is_object || is_image) return;
        if (s.row.clear_semi_diameter == 0) s.row.clear_semi_diameter = s.diameter;
        if (const std::string what = set_shape(s); !what.empty()) reject(what);
        set_aperture_shape(s);
        if (s.glass_kind == 4 && !s.glass.empty() && upper_case(s.glass) != "MIRROR") reject("a glass with an offset");
        convert_glass(s);
        converted_surfaces_.push_back(&s);
        p_.surfaces.push_back(s.row);
    }

    /// Converts type, parameters and extra data, which OpticStudio's manual defines for each surface type. Returns a
    /// noun phrase for a feature that realcam does not model, or an empty string.
    std::string set_shape(ZemaxSurface& s) {
        SurfaceForm& form = s.row.form;
        const auto parameter = [&](int number) { return value_or_0(s.parameters, number); };
        // OpticStudio's editor numbers the extra data as parameters, too.
        for (const auto& [number, value] : s.parameters)
            if (number > kLastParameter) s.extra_data.try_emplace(number - kLastParameter, value);
        s.parameters.erase(s.parameters.upper_bound(kLastParameter), s.parameters.end());
        // Number of extra terms, whose coefficients begin at the third extra datum, and the normalization radius.
        const int count = static_cast<int>(std::clamp(value_or_0(s.extra_data, 1), 0.0, 300.0));
        const double radius = value_or_0(s.extra_data, 2) > 0 ? value_or_0(s.extra_data, 2) : 1;
        if (s.type == "STANDARD") return "";  // its parameters have no meaning
        const auto add_parameter_terms = [&](int step) {
            for (const auto& [number, value] : s.parameters)
                if (number > 0) add_term(s.row, step * number, value, unit_);
        };
        if (s.type == "EVENASPH" || s.type == "ODDASPHE") {
            add_parameter_terms(s.type == "EVENASPH" ? 2 : 1);
        } else if (s.type == "XASPHERE" || s.type == "XOSPHERE") {
            const int step = s.type == "XASPHERE" ? 2 : 1;
            for (int k = 1; k <= count; ++k)
                add_term(s.row, step * k, value_or_0(s.extra_data, 2 + k) / std::pow(radius, step * k), unit_);
            if (count > 0 || !has_parameter_after(s, 0)) {
                remark_undefined_parameters(s, 0);
            } else {
                // The type has no such parameters, but files converted from tables have their coefficients there.
                add_parameter_terms(step);
                remark("surface " + std::to_string(s.row.number) + " of type " + s.type +
                       " has no extended terms; its parameters are read as those of type " +
                       (step == 2 ? "EVENASPH" : "ODDASPHE"));
            }
        } else if (s.type == "TOROIDAL") {
            form.base = BaseForm::toroid;
            form.curvature_x = curvature_of(parameter(1), unit_);
            for (const auto& [number, value] : s.parameters)
                if (number > 1) add_term(s.row, 2 * (number - 1), value, unit_);
            if (value_or_0(s.extra_data, 1) > 0) return "Zernike terms on a toroid";
        } else if (s.type == "BICONICX") {
            form.base = BaseForm::biconic;
            form.curvature_x = curvature_of(parameter(1), unit_);
            form.conic_x = parameter(2);
            remark_undefined_parameters(s, 2);
        } else if (s.type == "XPOLYNOM") {
            remark_undefined_parameters(s, 0);
            for (int k = 0; k < count; ++k) {
                const auto [x, y] = xy_powers(k + 1);
                const double value = value_or_0(s.extra_data, 3 + k);
                if (value != 0 && x + y > kMaxXyDegree)
                    return "a term of x and y of more than the power " + std::to_string(kMaxXyDegree);
                if (value != 0) form.xy.push_back({x, y, unit_ * value / std::pow(unit_ * radius, x + y)});
            }
        } else if (s.type == "SZERNSAG" || s.type == "FZERNSAG") {
            std::vector<double> terms;
            for (int k = 0; k < count; ++k) terms.push_back(unit_ * value_or_0(s.extra_data, 3 + k));
            set_zernike(s.row, s.type == "SZERNSAG" ? ZernikeOrder::noll : ZernikeOrder::fringe, unit_ * radius, terms);
            for (int k = 1; k <= 8; ++k) add_term(s.row, 2 * k, parameter(k), unit_);
            for (const auto& [number, value] : s.parameters)
                if (number > 8 && value != 0) return "a decentre of Zernike terms";
        } else if (s.type == "COORDBRK") {
            s.row.before = frame_of_break({unit_ * parameter(1), unit_ * parameter(2)},
                                          {parameter(3), parameter(4), parameter(5)}, parameter(6) != 0);
            s.row.curvature = 0;
            s.glass.clear();
        } else {
            return "a surface of type " + printable(s.type).substr(0, 40);
        }
        return "";
    }

    /// True if a parameter with a number greater than `last` is not 0.
    static bool has_parameter_after(const ZemaxSurface& s, int last) {
        return std::any_of(s.parameters.upper_bound(last), s.parameters.end(),
                           [](const auto& parameter) { return parameter.second != 0; });
    }

    /// Warns about parameters that the manual does not define for the type of a surface. `last`: number of the last
    /// parameter that it defines.
    void remark_undefined_parameters(const ZemaxSurface& s, int last) {
        if (has_parameter_after(s, last))
            remark("surface " + std::to_string(s.row.number) + " has parameters (PARM) that its type " + s.type +
                   " lacks: they are left out");
    }

    /// Converts the decentre and the spider of a surface's aperture.
    static void set_aperture_shape(ZemaxSurface& s) {
        ApertureShape& shape = s.row.aperture_shape;
        const Vec2d offset = s.aperture_offset;
        const bool is_circle = shape.kind == ApertureOutline::circle;
        if (offset != Vec2d{0, 0}) {
            // A decentred circle is stated only by its radii.
            double& inner = s.row.inner_semi_diameter;
            if (is_circle && inner > 0) shape.obscurations.push_back({false, {inner, inner}, {0, 0}, 0});
            inner = 0;
            if (is_circle && !s.row.is_open_outside && s.row.has_aperture && shape.obscurations.empty())
                shape.half = {s.row.clear_semi_diameter, s.row.clear_semi_diameter};
            shape.offset = shape.half.x > 0 ? offset : Vec2d{0, 0};
            for (Obscuration& piece : shape.obscurations) piece.offset = offset;
        }
        // An aperture set by the designer limits the light, and not the semi-diameter.
        if (const double reach = shape.reach(); reach > 0) s.row.clear_semi_diameter = reach;
        if (s.arms == 0) return;
        const double arm = std::max(s.row.clear_semi_diameter, s.arm_width);
        for (Obscuration piece : spider_arms(s.arms, s.arm_width, arm, 0)) {
            piece.offset = {piece.offset.x + offset.x, piece.offset.y + offset.y};
            shape.obscurations.push_back(piece);
        }
    }

    /// Sets the medium behind a surface, or makes it a mirror.
    void convert_glass(ZemaxSurface& s) {
        if (s.glass_kind == 2 && !s.glass.empty() && pick_up_glass(s)) return;
        // A medium of index -1 is a mirror by Snell's law.
        s.row.is_mirror = upper_case(s.glass) == "MIRROR" || (s.glass_kind == 1 && s.n_d == -1);
        if (s.row.is_mirror) return;
        try {
            if (s.glass.empty())  // a coordinate break is not a surface: the medium continues behind it
                s.row.material = s.type == "COORDBRK" ? current_medium_ : s.row.material;
            else
                s.row.material = s.glass_kind == 1 ? glass_of_pair(s.n_d, s.v_d) : named_glass(s);
        } catch (const InputError& error) {
            throw LensReadError(error, p_.file, s.glass_line, s.row.number);
        }
        if (s.glass_kind == 1 && !s.glass.empty() && s.partial != 0)
            remark("the partial dispersion of the model glass of surface " + std::to_string(s.row.number) +
                   " is left out");
        current_medium_ = s.row.material;
    }

    /// Resolves a pickup of the glass of a preceding surface. Returns false if the glass is determined by its name.
    bool pick_up_glass(ZemaxSurface& s) {
        const int from = s.pickup;
        const bool is_named = s.glass != "___BLANK";
        const bool is_in_front = from > 0 && from <= static_cast<int>(converted_surfaces_.size());
        const ZemaxSurface* source = is_in_front ? converted_surfaces_[static_cast<std::size_t>(from) - 1] : nullptr;
        if (!source || source->glass.empty()) {
            if (is_named) return false;
            fail_at("picks up the glass of surface " + std::to_string(from) +
                        (source ? ", which has none" : "; expected a preceding surface of the lens"),
                    s.glass_line, s.row.number);
        }
        s.row.is_mirror = source->row.is_mirror;
        s.row.material = source->row.material;
        if (!s.row.is_mirror) current_medium_ = s.row.material;
        return true;
    }

    /// Returns the glass of a surface by its name, or, if no catalogue has the name, by n_d and V_d in the file. Throws
    /// UnknownGlass.
    Glass named_glass(const ZemaxSurface& s) {
        try {
            return glasses_.find(s.glass, catalogues_, s.index_hint);
        } catch (const UnknownGlass& error) {
            if (!trusts_index_pairs_ || !s.has_index_pair() || !error.candidate.empty()) throw;
            Glass stated = glass_of_pair(s.n_d, s.v_d);
            if (reported_glasses_.insert(s.glass).second)
                remark("the glass " + in_quotes(s.glass) + " is in no catalogue that the file lists; " + s.index_hint +
                       " of the file are used");
            return stated;
        }
    }

    /// True if n_d and V_d in the lines of catalogue glasses can be trusted, that is, if they agree with the catalogue
    /// for all known glasses in the file. Otherwise they may be left over from earlier glasses.
    bool check_index_pairs() const {
        for (const ZemaxSurface& s : surfaces_) {
            if (s.glass.empty() || s.glass_kind != 0 || upper_case(s.glass) == "MIRROR") continue;
            const std::optional<Glass> known = glasses_.in_catalogue(s.glass, catalogues_);
            if (!known) continue;
            const AbbePair pair = abbe_pair(*known);
            constexpr double kMaxIndexError = 2e-3, kMaxAbbeError = 1;  // melts and catalogue editions differ by less
            if (std::fabs(pair.n_d - s.n_d) > kMaxIndexError || std::fabs(pair.v_d - s.v_d) > kMaxAbbeError)
                return false;
        }
        return true;
    }

    /// Sets the object distance from surface 0.
    void convert_object() {
        const ZemaxSurface& object = surfaces_.front();
        set_object(object.at_infinity ? kInfinity : object.row.thickness, object.row.curvature, object.row.line);
        if (!object.glass.empty() && object.at_infinity)
            add_window(object);
        else if (!object.glass.empty())
            add_unsupported("an object inside a glass", object.glass_line, 0);
        if (object.row.is_stop) fail_at("the object is the aperture stop", object.row.line);
        if (!coatings_.empty()) remark("coatings are left out: " + short_list(coatings_));
    }

    /// Adds a plane surface from air to the object's medium that touches the first face, like the pane of an aquarium:
    /// a plane has no power, so that focal length and f-number are those in the medium.
    void add_window(ZemaxSurface object) {
        convert_glass(object);
        PrescriptionSurface window;
        window.line = object.glass_line;
        window.material = object.row.material;
        const PrescriptionSurface& first = p_.surfaces.front();
        const double c = first.curvature, r = first.clear_semi_diameter;
        if (c < 0)
            window.thickness = -c * r * r / (1 + std::sqrt(std::max(0.0, 1 - (1 + first.conic) * c * c * r * r)));
        p_.surfaces.insert(p_.surfaces.begin(), window);
        remark("its object lies in a medium, " + window.material.label +
               ": a plane window in front of the lens stands between it and the air of scenes");
    }

    void convert_fields() {
        if (field_type_ > 3) return remark("its fields are of an unknown kind, and ignored");
        p_.field_kind = field_type_ == 0   ? FieldKind::angle_deg
                        : field_type_ == 1 ? FieldKind::object_height
                                           : FieldKind::image_height;
        const std::size_t listed = std::max(fields_x_.size(), fields_y_.size());
        const std::size_t count = field_count_ > 0 ? std::min(field_count_, listed) : listed;
        const double scale = field_type_ == 0 ? 1 : unit_;
        for (std::size_t i = 0; i < count; ++i) {
            // The +y edge of the pupil moves to shift + (1 - compression), in units of the pupil's radius.
            const double shift = element_or_0(pupil_shift_y_, i), compression = element_or_0(pupil_compression_y_, i);
            p_.fields.push_back({scale * element_or_0(fields_x_, i), scale * element_or_0(fields_y_, i), 0, 0,
                                 vignetting(compression - shift), vignetting(compression + shift)});
        }
    }

    void convert_wavelengths() {
        std::vector<double> all;
        for (const auto& [number, um] : wavelengths_) all.push_back(1000 * um);
        const auto primary = wavelengths_.find(primary_);
        if (!all.empty() && primary == wavelengths_.end())
            fail_at("the primary wavelength (PWAV) is number " + std::to_string(primary_) +
                    ", which the file does not have");
        set_wavelengths(all, static_cast<std::size_t>(std::distance(wavelengths_.begin(), primary)));
        // A file always has 24 rows; unused rows follow the used ones and repeat one value.
        std::vector<double>& used = p_.wavelengths_nm;
        if (used.size() < 2 || used[used.size() - 2] != used.back()) return;
        const double unused = used.back();
        while (used.size() > 1 && used.back() == unused) used.pop_back();
        if (std::ranges::find(used, p_.wavelength_nm) == used.end()) used.push_back(p_.wavelength_nm);
    }

    void convert_zoom() {
        if (zoom_thicknesses_.empty() && zoom_apertures_.empty()) return;
        for (int i = 1; i <= configuration_count_; ++i) p_.zoom_names.push_back(std::to_string(i));
        p_.zoom_current = std::min(current_configuration_, configuration_count_) - 1;
        for (const auto& [surface, values] : zoom_thicknesses_) {
            if (surface == row().number) {
                remark("the thickness behind the image, which configurations change, is ignored");
                continue;
            }
            const int index = row_of_number(surface);
            std::vector<double>& list = p_.zoom_thicknesses[index];
            list = values_in_mm(
                values, unit_, index < 0 ? p_.object_distance : p_.surfaces[static_cast<std::size_t>(index)].thickness);
            for (double& value : list) {
                if (value >= kLongest) value = kInfinity;
                if (index >= 0 && !std::isfinite(value))
                    fail_at("a configuration makes the thickness of surface " + std::to_string(surface) + " infinite");
            }
        }
        convert_zoom_semi_diameters();
        if (zoom_apertures_.empty()) return;
        const bool is_length = p_.aperture_kind == ApertureKind::entrance_pupil_diameter;
        p_.zoom_apertures = values_in_mm(zoom_apertures_[0], is_length ? unit_ : 1, p_.aperture);
    }

    /// Returns the values of all configurations times `unit`; `default_value` for those that the file does not specify.
    std::vector<double> values_in_mm(std::vector<double> values, double unit, double default_value) const {
        values.resize(static_cast<std::size_t>(configuration_count_), std::nan(""));
        for (double& value : values) value = std::isnan(value) ? default_value : unit * value;
        return values;
    }

    /// Returns the index of a surface's row; -1: the object.
    int row_of_number(int surface) const {
        if (surface == 0 && !has_only_faces_) return -1;
        const auto found = std::ranges::find(p_.surfaces, surface, &PrescriptionSurface::number);
        if (found == p_.surfaces.end())
            fail_at("a configuration changes surface " + std::to_string(surface) + ", which the lens does not have");
        return static_cast<int>(found - p_.surfaces.begin());
    }

    /// Sets the sizes of the stop in the zoom positions, if the file defines the aperture by its semi-diameter. Other
    /// surfaces have one clear semi-diameter for all configurations, which is the largest.
    void convert_zoom_semi_diameters() {
        for (const auto& [surface, values] : zoom_semi_diameters_) {
            if (surface == 0 || surface == row().number) continue;
            PrescriptionSurface& row = p_.surfaces[static_cast<std::size_t>(row_of_number(surface))];
            const std::vector<double> sizes = values_in_mm(values, unit_, row.clear_semi_diameter);
            if (row.is_stop && p_.aperture_kind == ApertureKind::stop_size) {
                p_.zoom_apertures = sizes;
            } else {
                row.clear_semi_diameter = *std::ranges::max_element(sizes);
                remark("the largest of the configurations' semi-diameters of surface " + std::to_string(surface) +
                       " is used for all configurations");
            }
        }
    }

    std::vector<ZemaxSurface> surfaces_;  ///< including object and image
    /// True if the file lists only faces: no surface is the object, and the last one need not be the image.
    bool has_only_faces_ = false;
    bool has_indents_ = false;  ///< true if lines of surfaces are indented, as OpticStudio does
    double unit_ = 1;  ///< length of the file's unit, mm
    std::vector<std::string> catalogues_;
    int field_type_ = 0;  ///< FTYP: 0: angle, 1: object height, 2: paraxial image height, 3: real image height
    std::size_t field_count_ = 0;  ///< 0: all that are listed
    std::vector<double> fields_x_, fields_y_, pupil_shift_y_, pupil_compression_y_;
    std::map<int, double> wavelengths_;  ///< um, by number
    int primary_ = 1, configuration_count_ = 1, current_configuration_ = 1;  ///< numbers begin at 1
    /// Values of all configurations by surface number, in the file's unit; NaN: not specified. The aperture of the lens
    /// is stored under 0.
    std::map<int, std::vector<double>> zoom_thicknesses_, zoom_semi_diameters_, zoom_apertures_;
    std::set<std::string> coatings_, reported_glasses_;
    Glass current_medium_ = Glass::air();  ///< medium behind the last surface converted
    std::vector<const ZemaxSurface*> converted_surfaces_;  ///< the surfaces converted so far
    bool trusts_index_pairs_ = true;
};

}  // namespace

Prescription read_zemax(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return ZemaxReader("Zemax", text, file, glasses).read();
}

}  // namespace realcam::io
