// Reader of OSLO's lens files (.len). A command is a keyword with its values; commands stand on lines of their own or
// are separated by ';'. "LEN NEW" begins the lens, NXT begins the next surface, and END ends the lens. Surface 0 is the
// object, and the last one is the image. Commands after END concern optimisation, analysis and further configurations.

#include <cmath>
#include <tuple>

#include "../../../number_text.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"
#include "../../text/text_number.hpp"
#include "../lens_format.hpp"
#include "prescription_reader.hpp"

namespace realcam::io {
namespace {

/// OSLO treats object distances from this number of the file's units on as infinite.
constexpr double kOsloInfinity = 1e8;

/// Medium as specified: a glass name, indices at the file's wavelengths, or n_d and V_d. Air if all are empty.
struct OsloMedium {
    std::string glass;
    std::vector<double> indices;
    std::optional<AbbePair> pair;
    int line = 0;
};

/// Surface as specified in a .len file.
struct OsloSurface {
    PrescriptionSurface row;  ///< in the file's unit
    std::map<int, double> aspheric;  ///< coefficients ASn by n
    std::map<int, double> ad_terms;  ///< coefficients AD to AG by power of r, from 4
    int aspheric_step = 0;  ///< power of r of AS1: 2 or 1; 0: not specified
    OsloMedium medium;

    /// Property that is copied from a preceding surface.
    struct Pickup {
        std::string what;  ///< CV, CVM, TH, THM, GLA or AP; M: with the opposite sign
        int from;  ///< number of the preceding surface
        double offset;  ///< added to the copied value
        int line;
    };
    std::vector<Pickup> pickups;
    /// Solves for the axial ray: the slope behind the surface (PU) determines the curvature, and the height at the next
    /// surface (PY) the thickness.
    std::optional<double> axial_slope, axial_height;
};

/// True if the word is `name` followed by a number, such as AS4.
bool is_keyword_with_number(std::string_view word, std::string_view name) {
    return word.starts_with(name) && is_digits(word.substr(name.size()));
}

/// Reads all commands first, and converts the surfaces at the end of the file.
class OsloReader : PrescriptionText {
public:
    using PrescriptionText::PrescriptionText;

    Prescription read() {
        std::string_view line;
        while (lines_.next(line)) read_line(line);
        if (surfaces_.empty()) fail_at("begins no lens (LEN NEW)");
        if (!has_ended_) fail_at("the file ends too early: expected END");
        finish();
        return std::move(p_);
    }

private:
    // Short names for the tables of keywords.
    using R = OsloReader;
    using C = LensCommand;

    /// Table of all commands. Those that are ignored do not affect the path of light: names, notes, drawing, weights,
    /// settings of OSLO's computations, and parts of a special aperture, which is recorded by its own command.
    static const Keywords<R>& commands() {
        static constexpr auto positive = [](R& r, C& c) {
            const double value = c.number(0, c.word);
            if (!(value > 0)) r.lines_.fail(c.word + " must be positive");
            return value;
        };
        static constexpr auto set_field = [](R& r, C& c, FieldKind kind) {
            r.field_ = {kind, std::fabs(c.number(0, c.word))};
        };
        static constexpr auto set_aperture = [](R& r, ApertureKind kind, double value) { r.aperture_ = {kind, value}; };
        static constexpr auto reject = [](R& r, C& c) { r.unsupported(c); };
        static constexpr auto reject_unless_0 = [](R& r, C& c) {
            if (c.number(0, c.word) != 0) r.unsupported(c);
        };
        static const Keywords<R> table{
            {"DES NOT WW DRW LDP CBK CALLBACK GPRT ELMDF1 ELMDF2 BDI BDD VX PF LMN LME APCK DT OPDO AFO EVZ IMS IAR "
             "WRSP SDAD XARM WARM ARM SASP DLAP DLRS DLNR DLFD DLNF DLHA DLVA APDX DIAM OCO PRE TEM TCE ELE EGR DLDL "
             "DLRI PKP AMO IMGNA SHFL ATP AAC AGN AAN AX1 AX2 AY1 AY2 APK"},
            // The whole lens
            {"NXT", [](R& r, C&) { r.next_surface(); }},
            {"GTO",
             [](R& r, C& c) {
                 const int last = static_cast<int>(r.surfaces_.size()) - 1;
                 r.current_ = static_cast<std::size_t>(
                     r.lines_.whole_number_of(c.size() > 0 ? c[0].text : "", "the surface", 0, last));
                 r.lines_.set_surface(r.row().number);
             }},
            {"END", [](R& r, C& c) { r.end_lens(c); }},
            {"UNI", [](R& r, C& c) { r.unit_ = positive(r, c); }},
            {"EBR", [](R& r, C& c) { r.beam_radius_ = positive(r, c); }},
            {"FNO", [](R& r, C& c) { set_aperture(r, ApertureKind::working_f_number, positive(r, c)); }},
            {"NAO", [](R& r, C& c) { set_aperture(r, ApertureKind::object_aperture, positive(r, c)); }},
            {"NAP", [](R& r, C& c) { set_aperture(r, ApertureKind::image_aperture, positive(r, c)); }},
            {"PUK",
             [](R& r, C& c) {
                 set_aperture(r, ApertureKind::image_aperture, std::sin(std::atan(std::fabs(c.number(0, c.word)))));
             }},
            {"ANG", [](R& r, C& c) { set_field(r, c, FieldKind::angle_deg); }},
            {"OBH", [](R& r, C& c) { set_field(r, c, FieldKind::object_height); }},
            {"GIH", [](R& r, C& c) { set_field(r, c, FieldKind::image_height); }},
            {"TELE",
             [](R& r, C& c) {
                 if (c.upper(0) == "ON") r.remark("TELE (a telecentric object) is ignored");
             }},
            // Surfaces
            {"RD RDF",
             [](R& r, C& c) {
                 const double radius = c.size() > 0 && is_infinity(c[0].text) ? 0 : c.number(0, "the radius");
                 r.row().curvature = std::fabs(radius) > 1e17 ? 0 : curvature_of(radius);
             }},
            {"CV CVF", [](R& r, C& c) { r.row().curvature = c.number(0, "the curvature"); }},
            {"TH THF",
             [](R& r, C& c) {
                 const bool is_infinite = c.size() > 0 && is_infinity(c[0].text);
                 if (is_infinite && r.current_ > 0)
                     r.lines_.fail("the thickness is infinite; only the object may be as far away");
                 r.row().thickness = is_infinite ? kInfinity : c.number(0, "the thickness");
             }},
            {"CC", [](R& r, C& c) { r.row().conic = c.number(0, "the conic"); }},
            {"AST",
             [](R& r, C&) {
                 for (OsloSurface& other : r.surfaces_) other.row.is_stop = false;
                 r.row().is_stop = true;
             }},
            {"AIR AIF RFL RFH",
             [](R& r, C& c) {
                 r.row().is_mirror = c.word[0] == 'R';
                 r.surface().medium = {};
             }},
            {"GLA GLF", [](R& r, C& c) { r.read_glass(c); }},
            {"AP APF", [](R& r, C& c) { r.read_aperture(c); }},
            {"PK", [](R& r, C& c) { r.read_pickup(c); }},
            {"PU", [](R& r, C& c) { r.surface().axial_slope = c.number(0, "the slope of the axial ray"); }},
            {"PY", [](R& r, C& c) { r.surface().axial_height = c.number(0, "the height of the axial ray"); }},
            {"AD AE AF AG",
             [](R& r, C& c) {
                 r.surface().ad_terms[4 + 2 * (c.word[1] - 'D')] = c.number(0, "the coefficient " + c.word);
             }},
            {"ASP",
             [](R& r, C& c) {
                 const std::string kind = c.upper(0, 10);
                 if (kind == "ASR" || kind == "1" || kind == "ARA")
                     r.surface().aspheric_step = kind == "ARA" ? 1 : 2;
                 else if (kind != "ADO" && kind != "0")
                     r.unsupported("an aspheric surface of the kind " + printable(kind));
             }},
            // Features that are not modelled
            {"DCX DCY DCZ TLA TLB TLC TOX TOY TOZ", reject_unless_0, "a tilt or decentre"},
            {"CVX RDX", reject_unless_0, "a toric surface"},
            {"PFL", reject_unless_0, "a perfect lens"},
            {"GSP", reject_unless_0, "a grating"},
            {"APN", reject_unless_0, "a special aperture"},
            {"DOR", reject_unless_0, "a diffractive surface"},
            {"HOR", reject_unless_0, "a hologram"},
            {"PUC PYC", reject, "a solve of the chief ray"},
            {"EC", reject, "a solve of the edge"},
            {"PI PIC", reject, "a solve of the angle"},
            {"BEN", reject, "a bent axis"},
            {"GC", reject, "global coordinates"},
            {"RCO", reject, "a return of coordinates"},
            {"GOR", reject, "a grating"},
            {"TIR", reject, "total internal reflection"},
            {"ELI NAC", reject, "a non-sequential element"},
            {"GRC GRD GRT", reject, "a glass with a gradient"},
            {"SPL", reject, "a spline surface"},
            {"ARR", reject, "an array of lenses"},
            {"EIK", reject, "an eikonal surface"},
            {"FZL FRN", reject, "a Fresnel surface"},
            {"LMO",
             [](R& r, C& c) {
                 if (c.upper(0) == "NSS") r.unsupported("a non-sequential group (LMO NSS)");
             }},
        };
        return table;
    }

    /// The current surface, to which commands apply.
    OsloSurface& surface() { return surfaces_[current_]; }
    PrescriptionSurface& row() { return surfaces_[current_].row; }

    /// Reads the commands of a line, separated by ';'; "//" begins a comment.
    void read_line(std::string_view line) {
        std::size_t begin = 0;
        bool quoted = false;
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (line[i] == '"') quoted = !quoted;
            if (quoted) continue;
            const bool is_comment = line.substr(i).starts_with("//");
            if (line[i] != ';' && !is_comment) continue;
            read_command(line.substr(begin, i - begin));
            if (is_comment) return;
            begin = i + 1;
        }
        read_command(line.substr(begin));
    }

    /// Reads a command from its text.
    void read_command(std::string_view text) {
        text = without_blanks(text);
        const std::string word = upper_case(text.substr(0, std::min<std::size_t>(text.find_first_of(" \t,"), 20)));
        const auto* known = commands().find(word);
        // The words of ignored commands are not split: they may be free text.
        if (word.empty() || (known && !known->read) || is_keyword_with_number(word, "SNO") ||
            is_keyword_with_number(word, "WW"))
            return;
        if (has_ended_) return read_late_command(word, text);
        std::vector<LensWord> words = lines_.words(text);
        words.erase(words.begin());
        C c(lines_, word, std::move(words));
        if (word == "LEN") return begin_lens(c);
        if (surfaces_.empty()) return;  // ignores text before LEN NEW
        if (word.starts_with("WV")) return read_wavelengths(c);
        if (word.size() < 6 && is_keyword_with_number(word, "AS")) {
            surface().aspheric[std::stoi(word.substr(2))] = c.number(0, "the coefficient " + word);
            if (surface().aspheric_step == 0) surface().aspheric_step = 2;
        } else if (!commands().read(*this, c) && !word.starts_with("AVX") && !word.starts_with("AVY")) {
            add_unknown_keyword(word);
        }
    }

    /// Reads a command after END: directly after it some programs write the wavelengths. Other commands do not concern
    /// the lens.
    void read_late_command(const std::string& word, std::string_view text) {
        if (word == "CFG") remark("its further configurations (CFG) are left out");
        reads_late_wavelengths_ = reads_late_wavelengths_ && word.starts_with("WV");
        if (!reads_late_wavelengths_) return;
        std::vector<LensWord> words = lines_.words(text);
        words.erase(words.begin());
        read_wavelengths({lines_, word, std::move(words)});
    }

    /// Reads LEN NEW: title, scale and the number of the image surface.
    void begin_lens(const C& c) {
        if (!surfaces_.empty()) lines_.fail("a second lens (LEN); expected only one");
        if (c.upper(0) != "NEW") lines_.fail("expected LEN NEW, which begins a lens");
        if (c.size() > 1) p_.title = std::string(c[1].text);
        if (c.size() > 3) stated_image_ = c.whole(3, "the number of surfaces", 2, kMaxSurfaceNumber);
        surfaces_.emplace_back().row.line = lines_.number();
    }

    /// Makes the next surface the current one, and adds it if it is new.
    void next_surface() {
        check_count(++current_);
        if (current_ == surfaces_.size()) {
            surfaces_.emplace_back().row.line = lines_.number();
            row().number = static_cast<int>(current_);
        }
        lines_.set_surface(static_cast<int>(current_));
    }

    /// Reads END, and checks the number of surfaces.
    void end_lens(const C& c) {
        const int last = static_cast<int>(surfaces_.size()) - 1;
        const int stated_number = c.size() > 0 ? c.whole(0, "the number of the image", 0, kMaxSurfaceNumber) : last;
        lines_.set_surface(0);
        for (const int number : {stated_number, stated_image_ < 0 ? last : stated_image_})
            if (number != last)
                lines_.fail("the image is surface " + std::to_string(last) + "; the file says that it is " +
                            std::to_string(number));
        has_ended_ = true;
        reads_late_wavelengths_ = wavelengths_.empty();
    }

    /// Reads WV and all wavelengths, or WV2 and the second one.
    void read_wavelengths(const C& c) {
        if (c.word.size() > 2) {
            const std::string_view number = std::string_view(c.word).substr(2);
            const int i = lines_.whole_number_of(number, "the number of the wavelength", 1, kMaxWavelengths);
            wavelengths_[i] = c.number(0, "the wavelength");
            return;
        }
        wavelengths_.clear();
        for (std::size_t i = 0; i < c.size() && i < kMaxFileFields; ++i)
            wavelengths_[static_cast<int>(i) + 1] = c.number(i, "each wavelength");
    }

    /// Reads GLA: a glass name or code, MODEL with n_d and V_d, or indices at the file's wavelengths.
    void read_glass(const C& c) {
        if (c.size() == 0) lines_.fail("GLA needs a glass");
        row().is_mirror = false;
        OsloMedium& medium = surface().medium = {};
        medium.line = lines_.number();
        const auto is_number = [&](std::size_t i) {
            std::string_view rest = i < c.size() ? c[i].text : "";
            return consume_number(rest) && rest.empty();
        };
        const bool is_model = c.upper(0, 4) == "MOD", is_code = c.size() == 1 && glass_of_number(c[0].text);
        if (!is_model && (!is_number(0) || is_code)) {
            medium.glass = std::string(c[0].text);
            return;
        }
        const std::size_t first = !is_model ? 0 : is_number(1) ? 1 : 2;  // a name may come between
        for (std::size_t i = first; i < c.size() && medium.indices.size() < kMaxFileIndices; ++i)
            medium.indices.push_back(c.number(i, "the index"));
        if (medium.indices.empty()) lines_.fail("GLA needs a glass, or its indices");
        if (!is_model || medium.indices.size() != 2 || !(medium.indices[1] >= 10)) return;
        medium.pair = AbbePair{medium.indices[0], medium.indices[1]};
        medium.indices.clear();
    }

    /// Reads AP: a keyword (CHK: the aperture blocks light) and the radius.
    void read_aperture(const C& c) {
        std::size_t i = 0;
        for (; i < c.size(); ++i) {
            const std::string kind = c.upper(i, 4);
            if (kind != "CHK" && kind != "UNC" && kind != "SPC") break;
            row().has_aperture = kind == "CHK";
        }
        const double radius = c.number(i, "the radius of the aperture");
        if (!(radius >= 0))
            lines_.fail("the radius of the aperture is " + number_text(radius) + "; expected 0 (not stated) or more");
        // OSLO gives an object at infinity a radius as large as its distance.
        row().clear_semi_diameter = unit_ * radius > kLongest ? 0 : radius;
    }

    /// Reads PK: property, surface, and an offset.
    void read_pickup(const C& c) {
        if (c.size() < 2) lines_.fail("PK needs a property and the surface from which it is picked up");
        const std::string what = c.upper(0, 8);
        static const Keywords<R> known{{"CV CVM TH THM GLA AP"}};
        if (!known.find(what)) return unsupported("a pickup of " + printable(what) + " (PK)");
        const int stated_number = c.whole(1, "the surface that is picked up", -1000, 1000);
        // A negative number is relative to this surface.
        const int from = stated_number < 0 ? row().number + stated_number : stated_number;
        if (from < 0 || from >= row().number)
            lines_.fail("PK " + what + " picks up from surface " + std::to_string(from) +
                        "; expected a preceding surface");
        const double offset = c.size() > 2 ? c.number(2, "the offset") : 0;
        surface().pickups.push_back({what, from, offset, lines_.number()});
    }

    /// Resolves pickups and solves, and converts the stored surfaces to the prescription.
    void finish() {
        if (surfaces_.size() < 3) fail_at("has no surface between object and image");
        for (const auto& [i, um] : wavelengths_) wavelengths_um_.push_back(um);
        std::vector<double> nm;
        for (const double um : wavelengths_um_) nm.push_back(1000 * um);
        set_wavelengths(nm, 0);
        if (wavelengths_um_.empty()) wavelengths_um_ = {0.58756, 0.48613, 0.65627};  // OSLO's defaults
        p_.wavelength_nm = 1000 * wavelengths_um_.front();
        // Pickups refer to preceding surfaces, whose own pickups are resolved by then.
        for (OsloSurface& s : surfaces_)
            for (const OsloSurface::Pickup& pickup : s.pickups) pick_up(s, pickup);
        for (OsloSurface& s : surfaces_) s.row.material = material_of(s);
        resolve_solves();
        const PrescriptionSurface &object = surfaces_.front().row, &image = surfaces_.back().row;
        set_object(object.thickness >= kOsloInfinity ? kInfinity : unit_ * object.thickness, object.curvature,
                   object.line);
        p_.image_curvature = image.curvature;
        if (!object.material.is_air()) add_unsupported("an object inside a glass", object.line, 0);
        p_.defocus = unit_ * image.thickness;
        bool has_stop = false;
        for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) has_stop = has_stop || surfaces_[i].row.is_stop;
        if (!has_stop) surfaces_[1].row.is_stop = true;  // OSLO's default
        for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) p_.surfaces.push_back(in_millimetres(surfaces_[i]));
        finish_aperture();
        remark_unknown_keywords("commands");
    }

    /// Returns the row of a surface in mm, with its aspheric terms.
    PrescriptionSurface in_millimetres(const OsloSurface& s) const {
        PrescriptionSurface row = s.row;
        row.curvature /= unit_;
        row.thickness *= unit_;
        row.clear_semi_diameter *= unit_;
        if (row.is_mirror) row.material = Glass::air();
        for (const auto& [power, value] : s.ad_terms) add_term(row, power, value, unit_);
        for (const auto& [index, value] : s.aspheric) {
            if (index == 0 && value != 0) fail_at("AS0 moves the vertex", row.line, row.number);
            if (index > 0) add_term(row, s.aspheric_step * index, value, unit_);
        }
        return row;
    }

    /// Sets fields and aperture of the prescription.
    void finish_aperture() {
        if (field_) {
            p_.field_kind = field_->first;
            p_.fields = {{0, 0}, {0, (p_.field_kind == FieldKind::angle_deg ? 1 : unit_) * field_->second}};
        }
        const double radius = unit_ * beam_radius_.value_or(1);
        if (!aperture_ && !beam_radius_)
            remark("it specifies no aperture; OSLO's default, a beam radius of one unit, is assumed");
        if (!aperture_ && std::isinf(p_.object_distance)) {
            aperture_ = {ApertureKind::entrance_pupil_diameter, 2 * radius};
        } else if (!aperture_) {  // the beam has this radius at the first surface, wherever the pupil is
            aperture_ = {ApertureKind::object_aperture, std::sin(std::atan(radius / std::fabs(p_.object_distance)))};
        }
        std::tie(p_.aperture_kind, p_.aperture) = *aperture_;
    }

    /// Copies the property of a pickup to surface `s`.
    void pick_up(OsloSurface& s, const OsloSurface::Pickup& pickup) const {
        const OsloSurface& from = surfaces_[static_cast<std::size_t>(pickup.from)];
        const auto fail = [&](const std::string& message) { fail_at(message, pickup.line, s.row.number); };
        const auto refuse_solve = [&](const std::string& what, const std::optional<double>& solve) {
            if (solve)
                fail("picks up the " + what + " of surface " + std::to_string(from.row.number) +
                     ", which is set by a solve; expected a value in the file");
        };
        const double sign = pickup.what.ends_with('M') ? -1 : 1;
        if (pickup.what.starts_with("CV")) {  // copies the complete shape
            refuse_solve("curvature", from.axial_slope);
            s.row.curvature = sign * from.row.curvature + pickup.offset;
            s.row.conic = from.row.conic;
            s.aspheric_step = from.aspheric_step;
            s.aspheric = from.aspheric;
            s.ad_terms = from.ad_terms;
            for (auto* terms : {&s.aspheric, &s.ad_terms})
                for (auto& [power, value] : *terms) value *= sign;
        } else if (pickup.what.starts_with("TH")) {
            refuse_solve("thickness", from.axial_height);
            s.row.thickness = sign * from.row.thickness + pickup.offset;
        } else if (pickup.what == "AP") {
            s.row.clear_semi_diameter = from.row.clear_semi_diameter;
        } else {
            if (from.row.is_mirror) fail("picks up the glass of a mirror");
            s.row.is_mirror = false;
            s.medium = from.medium;
            s.medium.line = pickup.line;
        }
    }

    /// Returns the glass of a name. Throws UnknownGlass.
    Glass named_glass(const std::string& name) {
        // OSLO's files name no maker. OSLO searches Schott's catalogue first; other makers use the same names for other
        // glasses.
        const std::vector<std::string> first{"SCHOTT"};
        if (!glasses_.in_catalogue(name, first)) return glasses_.find(name, {});
        if (!glasses_.in_catalogue(name, {}))
            remark("the glass " + in_quotes(name) + ", whose name several makers use, is assumed to be Schott's");
        return glasses_.find(name, first);
    }

    /// Returns the medium behind a surface. Throws LensReadError.
    Glass material_of(const OsloSurface& s) {
        const auto& [glass, indices, pair, line] = s.medium;
        try {
            if (pair) return glass_of_pair(pair->n_d, pair->v_d);
            if (!glass.empty()) return named_glass(glass);
            if (indices.empty() || s.row.is_mirror) return Glass::air();
            if (is_constant(indices)) return glass_of_pair(indices.front(), 0);
            if (indices.size() != wavelengths_um_.size())
                throw InputError("has " + std::to_string(indices.size()) + " indices for " +
                                 std::to_string(wavelengths_um_.size()) + " wavelengths (WV)");
            std::vector<double> nm;
            for (const double um : wavelengths_um_) nm.push_back(1000 * um);
            return glass_of_indices(nm, indices, "glass of surface " + std::to_string(s.row.number));
        } catch (const InputError& error) {
            throw LensReadError(error, p_.file, line, s.row.number);
        }
    }

    /// Resolves solves, whose results a file does not always contain, by tracing the marginal ray through the surfaces
    /// in order, in the file's unit. Only a beam radius determines the height of the ray; a solve for height 0 does not
    /// need it.
    void resolve_solves() {
        const double object = surfaces_.front().row.thickness, radius = beam_radius_.value_or(1);
        ParaxialRay ray{radius, object >= kOsloInfinity ? 0 : radius / object};
        double index = surfaces_.front().row.material.index(p_.wavelength_nm), sign = 1;
        for (std::size_t i = 1; i + 1 < surfaces_.size(); ++i) {
            auto& [row, aspheric, ad_terms, step, medium, pickups, axial_slope, axial_height] = surfaces_[i];
            const auto fail = [&, line = row.line, number = row.number](const std::string& message) {
                fail_at(message, line, number);
            };
            // Light returns through the medium in front of a mirror.
            if (row.is_mirror) row.material = surfaces_[i - 1].row.material;
            const double index_before = sign * index;
            if (row.is_mirror) sign = -sign;
            index = row.material.index(p_.wavelength_nm);
            const double index_behind = sign * index;
            if ((axial_slope || axial_height.value_or(0) != 0) && aperture_)
                fail("a solve of the axial ray (PU, PY) needs the radius of the beam (EBR)");
            if (axial_slope) {
                const double bend = ray.height * (index_behind - index_before);
                if (bend == 0) fail("no curvature gives the axial ray the slope of the solve (PU)");
                row.curvature = (index_before * ray.slope - index_behind * *axial_slope) / bend;
            }
            ray = refract_paraxial(ray, row.curvature, index_before, index_behind);
            if (axial_height) {
                if (ray.slope == 0) fail("no thickness gives the axial ray the height of the solve (PY)");
                row.thickness = (*axial_height - ray.height) / ray.slope;
            }
            ray.height += row.thickness * ray.slope;
        }
    }

    std::vector<OsloSurface> surfaces_;  ///< including object and image
    std::size_t current_ = 0;  ///< index of the surface to which commands apply
    bool has_ended_ = false;  ///< true after END
    bool reads_late_wavelengths_ = false;  ///< true if wavelengths directly after END are read
    int stated_image_ = -1;  ///< number of the image surface, from the first line
    double unit_ = 1;  ///< length of the file's unit, mm
    std::map<int, double> wavelengths_;  ///< um, by number from 1
    std::vector<double> wavelengths_um_;  ///< the same, or OSLO's defaults
    std::optional<double> beam_radius_;  ///< at the first surface, in the file's unit
    std::optional<std::pair<ApertureKind, double>> aperture_;
    std::optional<std::pair<FieldKind, double>> field_;
};

}  // namespace

Prescription read_oslo(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return OsloReader("OSLO", text, file, glasses).read();
}

}  // namespace realcam::io
