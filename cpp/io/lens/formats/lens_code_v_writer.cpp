// Writer of CODE V's sequence files (.seq).

#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_glass.hpp"
#include "../lens_text.hpp"
#include "prescription_writer.hpp"

namespace realcam::io {
namespace {

constexpr int kXyDegree = 10;  // highest degree of SPS XYP
constexpr std::size_t kAnamorphicTerms = 4;  // even terms of AAS, from r^4 to r^10

class CodeVWriter : PrescriptionWriter {
public:
    explicit CodeVWriter(const LensSystem& lens) : PrescriptionWriter(lens, "CODE V") {}

    LensText write() {
        std::string surfaces;
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) surfaces += surface(i);
        // Curvatures, because radii would be rounded.
        result_.text =
            "RDM N;LEN\nTITLE " + quoted(title()) + "\nEPD " + exact_number(entrance_pupil_diameter(".seq")) +
            "\nDIM M\nWL " + exact_number(lens_.wavelength_nm) + "\nREF 1\nWTW 1\nXRI 0.0 0.0\nYRI 0.0 " +
            exact_number(film_corner()) + "\nWTF 1.0 1.0\n" + private_glasses() + "SO 0.0 " +
            (std::isfinite(object_distance()) ? exact_number(object_distance()) : "0.1e14") + '\n' + surfaces + "SI " +
            exact_number(image_curvature()) + " 0.0\n" + placement_commands(lens_.film_placement) + zoom() + "GO\n";
        return std::move(result_);
    }

private:
    static std::string quoted(const std::string& title) {
        std::string text = printable(title);
        for (char& c : text)
            if (c == '\'') c = '`';
        return '\'' + text + '\'';
    }
    static std::string command(const std::string& word, double value) {
        return "  " + word + ' ' + exact_number(value) + '\n';
    }
    void line(const std::string& word) { commands_ += "  " + word + '\n'; }
    void line(const std::string& word, double value) { commands_ += command(word, value); }

    /// Returns the commands of a surface.
    std::string surface(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        commands_.clear();
        if (s.type == SurfaceType::stop) line("STO");
        const double constant = s.bends_light() ? write_form(i) : 0;
        write_aperture(i);
        SurfacePlacement placement = s.placement;
        if (constant != 0) {
            // CODE V's polynomials have no constant term; the surface alone is displaced by it instead.
            placement = SurfacePlacement::from_frame(placement.frame() * along_axis(constant));
            placement.returns = s.placement.returns || s.placement.is_in_place();
        }
        std::string text = "S " + exact_number(s.bends_light() ? s.curvature : 0.0) + ' ' +
                           exact_number(placement.returns ? thickness(i) : thickness(i) - constant);
        if (s.type == SurfaceType::mirror)
            text += " REFL";
        else if (const Glass& medium = medium_behind(i); !medium.is_air())
            text += ' ' + glass(medium);
        return text + '\n' + commands_ + placement_commands(placement);
    }

    /// Returns XDE to CDE, and DAR if the placement returns; empty if the surface is neither decentred nor tilted.
    static std::string placement_commands(const SurfacePlacement& placement) {
        const auto& [decentre, tilt, returns] = placement;
        if (placement.is_in_place()) return {};
        std::string text;
        // CODE V's alpha and beta have the opposite sign.
        for (const auto& [word, value] : {std::pair{"XDE", decentre.x},
                                          {"YDE", decentre.y},
                                          {"ZDE", decentre.z},
                                          {"ADE", -tilt.x},
                                          {"BDE", -tilt.y},
                                          {"CDE", tilt.z}})
            if (value != 0) text += command(word, value);
        return returns ? text + "  DAR\n" : text;
    }

    /// Adds the commands of a surface's form. Returns the constant term of the sag in mm, by which the surface must be
    /// displaced along its axis.
    double write_form(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        const bool has_radial = !form.radial.empty() || form.forbes, has_xy = !form.xy.empty() || form.zernike;
        if (const std::string terms = beyond_polynomials(form); !terms.empty())
            warn(i, "has " + terms + ", which realcam does not write to .seq files");
        if (form.base != BaseForm::conic) {
            if (has_radial || has_xy) warn(i, "has terms beside its toroid or biconic, which CODE V's types lack");
            const bool is_toroid = form.base == BaseForm::toroid;
            line(is_toroid ? "YTO" : "AAS");
            line("CUX", form.curvature_x);
            line("K", s.conic);
            if (!is_toroid) line("KX", form.conic_x);
            write_even(i, is_toroid ? "" : "R");
        } else if (has_xy) {
            return write_polynomial(i);
        } else if (has_radial) {
            line("SPS ODD");
            line("SCO K", s.conic);
            for (const auto& [power, value] : radial_terms_of(s)) line("SCO AR" + std::to_string(power), value);
        } else if (s.is_asphere() || s.conic != 0) {
            line(s.is_asphere() ? "ASP" : "CON");
            line("K", s.conic);
            write_even(i, "");
        }
        return 0;
    }

    /// Adds the even terms. `suffix`: of their keywords, "R" in an anamorphic asphere, otherwise empty.
    void write_even(std::size_t i, const std::string& suffix) {
        const std::vector<double>& terms = lens_.surfaces[i].aspheric;
        for (std::size_t k = 0; k < terms.size(); ++k) {
            if (terms[k] == 0) continue;
            if (suffix.empty() || k < kAnamorphicTerms)
                line("ABCDEFGH"[k] + suffix, terms[k]);
            else
                warn(i, "has even terms of more than r^10, which CODE V's anamorphic asphere lacks");
        }
    }

    /// Adds a polynomial in x and y (SPS XYP). Returns its constant term in mm.
    double write_polynomial(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        if (has_odd_terms(s)) warn(i, "has odd terms of r beside those of x and y, which CODE V's types lack");
        line("SPS XYP");
        line("SCO K", s.conic);
        double constant = 0;
        bool is_too_high = false;
        for (const auto& [power, value] : xy_terms_of(s)) {
            const auto [degree, y] = power;
            if (degree == 0)
                constant = value;
            else if (degree > kXyDegree)
                is_too_high = true;
            else
                line("SCO C" + std::to_string(xy_number(degree, y) + 1), value);
        }
        if (is_too_high) warn(i, "has terms of x and y of more than the power 10, which CODE V's polynomial lacks");
        return constant;
    }

    /// Adds the commands of a surface's apertures. Labels distinguish them.
    void write_aperture(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const ApertureShape& shape = s.aperture_shape;
        if (s.type != SurfaceType::stop || !shape.is_plain())
            line(shape.is_plain() ? "CIR" : "CIR L'RIM'", s.clear_semi_diameter);
        if (s.inner_semi_diameter > 0) line("CIR OBS", s.inner_semi_diameter);
        const auto add = [&](ApertureOutline kind, const std::string& obscures, const std::string& label,
                             const Obscuration& obscuration) {
            const std::string word = kind == ApertureOutline::rectangle ? "RE" : "EL";
            if (kind == ApertureOutline::circle) {
                line("CIR" + label, obscuration.half.x);
            } else {
                line(word + 'X' + obscures + label, obscuration.half.x);
                line(word + 'Y' + obscures + label, obscuration.half.y);
            }
            if (obscuration.offset.x != 0) line("ADX" + label, obscuration.offset.x);
            if (obscuration.offset.y != 0) line("ADY" + label, obscuration.offset.y);
            if (obscuration.angle_deg != 0) line("ARO" + label, obscuration.angle_deg);
        };
        if (shape.kind == ApertureOutline::polygon)
            warn(i, "has a polygonal aperture, which a .seq file cannot express");
        else if (shape.half.x > 0)
            add(shape.kind, "", " L'OPEN'", {false, shape.half, shape.offset, 0});
        int number = 0;
        for (const Obscuration& obscuration : shape.obscurations)
            add(obscuration.is_rectangle ? ApertureOutline::rectangle : ApertureOutline::ellipse, " OBS",
                " L'OBS" + std::to_string(++number) + '\'', obscuration);
    }

    /// Returns the name of a glass in the file; a glass that is in no catalogue becomes a private glass.
    std::string glass(const Glass& glass) {
        if (const auto known = catalogue_name_of(glass))
            return bare_glass_name(known->name) + '_' + (known->maker == "misc" ? "SPECIAL" : upper_case(known->maker));
        std::size_t i = 0;
        while (i < private_glasses_.size() && !(private_glasses_[i] == glass)) ++i;
        if (i == private_glasses_.size()) private_glasses_.push_back(glass);
        return private_name(i);
    }
    static std::string private_name(std::size_t i) { return "'GLASS" + std::to_string(i + 1) + '\''; }

    /// Returns the commands of the private glasses: their indices at spectral lines and at the design wavelength.
    std::string private_glasses() const {
        if (private_glasses_.empty()) return {};
        std::string wavelengths = "PRV\n  PWL", text;
        for (std::size_t i = 0; i < private_glasses_.size(); ++i) {
            text += "\n  " + private_name(i);
            for (const auto& [nm, index] : indices_at_lines(private_glasses_[i], lens_.wavelength_nm)) {
                if (i == 0) wavelengths += ' ' + exact_number(nm);
                text += ' ' + exact_number(index);
            }
        }
        return wavelengths + text + "\nEND\n";
    }

    std::string zoom() {
        const ZoomRange& zoom = lens_.zoom;
        if (zoom.positions.empty()) return {};
        if (!lens_.is_rotational()) {
            result_.warnings.push_back("zoom positions, because the lens has no rotational symmetry");
            return {};
        }
        if (zoom.current != 0)
            result_.warnings.push_back("the current zoom position: CODE V opens a .seq file in its first position");
        std::string text = "ZOO " + std::to_string(zoom.positions.size()) + "\nZOO TIT";
        for (const ZoomPosition& position : zoom.positions) text += ' ' + quoted(position.name);
        for (const auto& [surface, values] : zoomed_quantities()) {
            const bool is_object = surface == ZoomedQuantity::kObject;
            text += surface == ZoomedQuantity::kEntrancePupil
                        ? "\nZOO EPD"
                        : "\nZOO THI S" + (is_object ? "O" : std::to_string(surface));
            for (const double value : values)
                text += ' ' + exact_number(is_object && !std::isfinite(value) ? 1e13 : value);
        }
        return text + '\n';
    }

    std::string commands_;  ///< commands that follow the line of the current surface
    std::vector<Glass> private_glasses_;  ///< glasses that are in no catalogue
};

}  // namespace

LensText lens_as_code_v(const LensSystem& lens) {
    return CodeVWriter(lens).write();
}

}  // namespace realcam::io
