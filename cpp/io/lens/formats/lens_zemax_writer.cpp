// Writer of Zemax OpticStudio's lens files (.zmx).

#include <algorithm>
#include <cmath>
#include <set>

#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"
#include "../lens_glass.hpp"
#include "../lens_text.hpp"
#include "prescription_writer.hpp"

namespace realcam::io {
namespace {

class ZemaxWriter : PrescriptionWriter {
public:
    explicit ZemaxWriter(const LensSystem& lens) : PrescriptionWriter(lens, "Zemax") {}

    LensText write() {
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) write_surface(i);
        if (!lens_.film_placement.is_in_place()) write_break(lens_.film_placement);
        begin_surface();
        line("TYPE STANDARD");
        line("CURV", {image_curvature()});
        line("DISZ 0");
        line("DIAM", {film_corner(), 0, 0, 0, 1}, " \"\"");
        const std::string surfaces = std::move(text_);
        write_head();
        text_ += surfaces;
        write_zoom();
        result_.text = std::move(text_);
        return std::move(result_);
    }

private:
    /// Keyword followed by values.
    static std::string numbers(const std::string& word, std::initializer_list<double> values) {
        std::string text = word;
        for (const double value : values) text += ' ' + exact_number(value);
        return text;
    }
    // Add an indented line of the current surface.
    void line(const std::string& text) { text_ += "  " + text + '\n'; }
    void line(const std::string& word, std::initializer_list<double> values, const char* end = "") {
        line(numbers(word, values) + end);
    }
    static std::string or_infinity(double value) { return std::isfinite(value) ? exact_number(value) : "INFINITY"; }
    void begin_surface() { text_ += "SURF " + std::to_string(++surface_count_) + '\n'; }

    /// Writes the data of the lens as a whole, and the object surface.
    void write_head() {
        text_ = "VERS 180000 0 0\nMODE SEQ\nNAME " + title() + "\nUNIT MM X W X CM MR CPMM\n";
        // For lenses without rotational symmetry only the stop defines the width of the beam.
        const bool has_pupil = lens_.is_rotational();
        const double pupil = has_pupil ? first_order(lens_, lens_.wavelength_nm).entrance_pupil_diameter : kInfinity;
        text_ += std::isfinite(pupil) ? "ENPD " + exact_number(pupil) + '\n' : "FLOA\n";
        if (!makers_.empty()) text_ += "GCAT";
        for (const std::string& maker : makers_) text_ += ' ' + maker;
        if (!makers_.empty()) text_ += '\n';
        // The corner of the film, as a real image height.
        text_ += "FTYP 3 0 2 1 0 0 0\nXFLN 0 0\nYFLN 0 " + exact_number(film_corner()) + "\nWAVM 1 " +
                 exact_number(lens_.wavelength_nm / 1000) + " 1\nPWAV 1\nSURF 0\n";
        line("TYPE STANDARD");
        line("CURV 0");
        line("DISZ " + or_infinity(object_distance()));
        line("DIAM 0 0 0 0 1 \"\"");
    }

    /// Writes a surface, with the coordinate breaks of its placement before and behind it.
    void write_surface(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const bool is_displaced = !s.placement.is_in_place(), returns = is_displaced && s.placement.returns;
        if (is_displaced) write_break(s.placement);
        begin_surface();
        if (s.type == SurfaceType::stop) line("STOP");
        std::vector<std::string> parameters;
        line("TYPE " + type_of(i, parameters));
        line("CURV", {s.bends_light() ? s.curvature : 0.0, 0, 0, 0, 0}, " \"\"");
        for (const std::string& parameter : parameters) line(parameter);
        line("DISZ", {returns ? 0.0 : thickness(i)});
        if (s.type == SurfaceType::mirror)
            line("GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0");
        else if (const Glass& behind = medium_behind(i); !behind.is_air())
            line("GLAS " + glass(behind));
        if (s.bends_light() && s.conic != 0) line("CONI", {s.conic});
        const double rim = s.type == SurfaceType::stop ? lens_.stop_semi_diameter : s.clear_semi_diameter;
        line("DIAM", {rim, 1, 0, 0, 1}, " \"\"");
        if (!s.aperture_shape.is_plain())
            write_aperture(i);
        else if (s.type == SurfaceType::aperture || s.inner_semi_diameter > 0)
            line("CLAP", {s.inner_semi_diameter, s.clear_semi_diameter, 0});
        else if (s.type != SurfaceType::stop)
            line("FLAP", {0, s.clear_semi_diameter, 0});
        if (!returns) return;
        // The reverse of a coordinate break. With order 1 a break applies its steps in reverse order.
        const auto& [decentre, tilt, unused] = s.placement;
        write_break({-decentre.x, -decentre.y, -tilt.x, -tilt.y, -tilt.z, 1}, thickness(i) - decentre.z);
    }

    /// Writes a coordinate break. `parameters`: decentre x and y, tilt about x, y and z, order.
    void write_break(std::initializer_list<double> parameters, double thickness) {
        begin_surface();
        line("TYPE COORDBRK");
        line("CURV 0 0 0 0 0 \"\"");
        double number = 0;
        for (const double parameter : parameters) line("PARM", {++number, parameter});
        line("DISZ", {thickness});
        line("DIAM 0 0 0 0 1 \"\"");
    }

    /// Writes a placement as coordinate breaks. The shift along the axis comes first: after the tilts it would be along
    /// the new axis.
    void write_break(const SurfacePlacement& placement) {
        const auto& [decentre, tilt, returns] = placement;
        if (decentre.z != 0) write_break({0, 0, 0, 0, 0, 0}, decentre.z);
        write_break({decentre.x, decentre.y, tilt.x, tilt.y, tilt.z, 0}, 0);
    }

    /// Returns the Zemax type of a surface, and appends the lines of its parameters and extra data.
    std::string type_of(std::size_t i, std::vector<std::string>& lines) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        if (!s.bends_light()) return "STANDARD";
        const auto add_even = [&](std::size_t first,
                                  std::size_t max_count) {  // `first`: number of the parameter of r^4
            for (std::size_t k = 0; k < s.aspheric.size() && k < max_count; ++k)
                lines.push_back(numbers("PARM", {static_cast<double>(k + first), s.aspheric[k]}));
        };
        // Extra data: the number of terms, the normalisation radius, and the coefficients.
        const auto add_extra = [&](double radius, const std::vector<double>& terms) {
            lines.push_back(numbers("XDAT", {1, static_cast<double>(terms.size())}));
            lines.push_back(numbers("XDAT", {2, radius}));
            for (std::size_t k = 0; k < terms.size(); ++k)
                lines.push_back(numbers("XDAT", {static_cast<double>(k + 3), terms[k]}));
        };
        if (form.adds_nothing()) {
            if (!s.is_asphere()) return "STANDARD";
            // Parameter 1 is the term of r^2; there are eight, up to r^16.
            lines.emplace_back("PARM 1 0");
            for (std::size_t k = 0; k < s.aspheric.size(); ++k) {
                if (s.aspheric[k] == 0) continue;
                lines.push_back(numbers("PARM", {static_cast<double>(k + 2), s.aspheric[k]}));
                if (k + 2 > 8) warn(i, "has an aspheric term of r^18, which OpticStudio's even asphere lacks");
            }
            return "EVENASPH";
        }
        const std::string omitted_terms = beyond_polynomials(form);
        const bool has_radial = !form.radial.empty() || (form.forbes && form.forbes->kind == ForbesKind::con);
        if (!omitted_terms.empty()) warn(i, "has " + omitted_terms + ", which realcam does not write to .zmx files");
        if ((form.base != BaseForm::conic) + has_radial + !form.xy.empty() + form.zernike.has_value() > 1)
            warn(i, "has terms of several kinds; Zemax's surface types have only one, and the first kind is written");
        const double radius_x = form.curvature_x == 0 ? 0 : 1 / form.curvature_x;
        if (form.base == BaseForm::toroid) {
            lines.push_back(numbers("PARM", {1, radius_x}));
            add_even(3, s.aspheric.size());
            return "TOROIDAL";
        }
        if (form.zernike) {
            add_even(2, 7);
            add_extra(form.zernike->radius, form.zernike->coefficients);
            return form.zernike->order == ZernikeOrder::noll ? "SZERNSAG" : "FZERNSAG";
        }
        if (has_radial) {
            add_extra(1, radial_list(radial_terms_of(s), 1));
            return "XOSPHERE";
        }
        if (s.is_asphere()) warn(i, "has even terms, which Zemax's type of this surface lacks");
        if (form.base == BaseForm::biconic) {
            lines = {numbers("PARM", {1, radius_x}), numbers("PARM", {2, form.conic_x})};
            return "BICONICX";
        }
        if (form.xy.empty()) return s.is_asphere() ? "EVENASPH" : "STANDARD";
        std::vector<double> terms;
        for (const XyTerm& term : form.xy) {
            const auto number = static_cast<std::size_t>(xy_number(term.x + term.y, term.y));
            if (number == 0) {
                warn(i, "has a constant term, which Zemax's extended polynomial lacks");
                continue;
            }
            terms.resize(std::max(terms.size(), number), 0.0);
            terms[number - 1] = term.coefficient;
        }
        add_extra(1, terms);
        return "XPOLYNOM";
    }

    /// Writes the aperture of a surface if it is not a circle about the vertex.
    void write_aperture(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const ApertureShape& shape = s.aperture_shape;
        Vec2d offset = shape.offset;
        const bool is_circle = shape.kind == ApertureOutline::circle, has_no_outline = is_circle && shape.half.x == 0;
        bool has_keyword = true;
        // In Zemax a surface has one aperture or one obscuration.
        const bool is_single_obscuration =
            has_no_outline && shape.obscurations.size() == 1 && shape.obscurations.front().angle_deg == 0;
        if (shape.kind == ApertureOutline::rectangle) {
            line("SQAP", {shape.half.x, shape.half.y});
        } else if (shape.kind == ApertureOutline::ellipse) {
            line("ELAP", {shape.half.x, shape.half.y});
        } else if (is_circle && !has_no_outline) {
            line("CLAP", {s.inner_semi_diameter, shape.half.x});
        } else if (is_single_obscuration) {
            const Obscuration& obscuration = shape.obscurations.front();
            line(obscuration.is_rectangle ? "SQOB" : "ELOB", {obscuration.half.x, obscuration.half.y});
            offset = obscuration.offset;
        } else {
            has_keyword = false;
        }
        if (shape.kind == ApertureOutline::polygon)
            warn(i, "has a polygonal aperture, which realcam does not write to .zmx files");
        if (!is_single_obscuration && !shape.obscurations.empty())
            warn(i, "has obscurations, which a surface with Zemax's single aperture cannot express");
        if (s.inner_semi_diameter > 0 && has_keyword && (has_no_outline || !is_circle))
            warn(i, "has a central obscuration, which a surface with Zemax's single aperture cannot express");
        if (offset != Vec2d{0, 0}) line("OBDC", {offset.x, offset.y});
    }

    /// Returns the values of GLAS: a catalogue glass, or else a model glass with n_d and V_d.
    std::string glass(const Glass& glass) {
        const auto known = catalogue_name_of(glass);
        const AbbePair pair = abbe_pair(glass);
        if (known && is_unique(*known)) {
            makers_.insert(upper_case(known->maker));
            return numbers(known->name, {0, 0, glass.index(kLineD_nm), pair.v_d}) + " 0 0 0 0 0 0";
        }
        if (reported_.insert(glass.label).second) {
            if (known)
                result_.warnings.push_back("the maker of the glass " + in_quotes(glass.label) +
                                           ", because another maker in the file uses the same name: it is written by "
                                           "n_d and V_d");
            const Glass model = glass_of_pair(pair.n_d, pair.v_d);
            if (!known && std::fabs(model.index(lens_.wavelength_nm) - glass.index(lens_.wavelength_nm)) > 1e-9)
                result_.warnings.push_back("the glass " + in_quotes(glass.label) +
                                           " is written by n_d and V_d, which is not exact at other wavelengths");
        }
        return numbers("___BLANK", {1, 0, pair.n_d, pair.v_d}) + " 0 0 0 0 0 0";
    }

    /// True if no other maker of the file's glasses has a glass of this name: a file lists the makers of all its
    /// glasses together, not with each glass.
    bool is_unique(const CatalogueName& known) const {
        std::set<std::string> makers;
        for (const Surface& s : lens_.surfaces)
            if (const auto other = catalogue_name_of(s.material)) makers.insert(other->maker);
        return std::ranges::none_of(catalogue_names_like(known.name), [&](const CatalogueName& other) {
            return other.maker != known.maker && makers.contains(other.maker);
        });
    }

    /// Writes the zoom positions as configurations.
    void write_zoom() {
        const ZoomRange& zoom = lens_.zoom;
        if (zoom.positions.empty()) return;
        if (surface_count_ != static_cast<int>(lens_.surfaces.size()) + 1)
            return result_.warnings.push_back("zoom positions, because surfaces are tilted or decentred");
        text_ += "MNUM " + std::to_string(zoom.positions.size()) + ' ' + std::to_string(zoom.current + 1) + '\n';
        for (const auto& [surface, values] : zoomed_quantities())
            for (std::size_t k = 0; k < values.size(); ++k)
                text_ += (surface < 0 ? "APER 0 " : "THIC " + std::to_string(surface) + ' ') + std::to_string(k + 1) +
                         ' ' + or_infinity(values[k]) + " 0 0 0 1 1 1 0 0 \"\" 0\n";
        std::string names;
        for (const ZoomPosition& position : zoom.positions)
            names += (names.empty() ? "" : ", ") + in_quotes(position.name);
        result_.warnings.push_back("the zoom positions " + names + " are numbered");
    }

    int surface_count_ = 0;  ///< surfaces written so far, including coordinate breaks, without the object
    std::string text_;  ///< text written so far
    std::set<std::string> makers_;  ///< catalogues of the glasses written so far
    std::set<std::string> reported_;  ///< glasses about which a warning has been added
};

}  // namespace

LensText lens_as_zemax(const LensSystem& lens) {
    return ZemaxWriter(lens).write();
}

}  // namespace realcam::io
