// Writer of Optiland's JSON files. Each surface has its position in the lens frame, and its angles about that frame's
// axes.

#include <cmath>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/prescription/lens_system.hpp"
#include "../../../optics/trace/film_frame.hpp"
#include "../../text/json_writer.hpp"
#include "prescription_reader.hpp"
#include "prescription_writer.hpp"

namespace realcam::io {
namespace {

class OptilandWriter : PrescriptionWriter {
public:
    explicit OptilandWriter(const LensSystem& lens) : PrescriptionWriter(lens, "Optiland") {}

    LensText write() {
        if (!lens_.zoom.positions.empty())
            result_.warnings.emplace_back("zoom positions, which an Optiland file cannot express");
        json_.begin_object().number("version", 1).text("name", title());
        json_.begin_object("aperture").text("type", "float_by_stop_size");
        json_.number("value", 2 * lens_.stop_semi_diameter).end();
        json_.begin_object("fields").begin_array("fields");
        for (const double height : {0.0, film_corner()})
            json_.begin_object().numbers({{"x", 0}, {"y", height}, {"vx", 0}, {"vy", 0}, {"weight", 1}}).end();
        json_.end().truth("telecentric", false).begin_object("field_definition");
        json_.text("field_type", "ParaxialImageHeightField").end().end();
        json_.begin_object("wavelengths").begin_array("wavelengths").begin_object();
        json_.number("value", lens_.wavelength_nm).truth("is_primary", true).text("unit", "nm").number("weight", 1);
        json_.end().end().text("polarization", "ignore").end();
        json_.null("apodization").numbers("pickups", {}).begin_object("solves").numbers("solves", {}).end();
        write_surfaces();
        json_.end();
        result_.text = json_.finish() + '\n';
        return std::move(result_);
    }

private:
    /// Writes object, surfaces and image.
    void write_surfaces() {
        json_.begin_object("surface_group").begin_array("surfaces");
        json_.begin_object().text("type", "ObjectSurface");
        begin_geometry("Plane", along_axis(-object_distance()));
        json_.key("radius").number_or_infinity(kInfinity).end();
        write_material(Glass::air());
        json_.text("comment", "").end();
        const SurfaceFrames frames = surface_frames(lens_);
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) {
            const Surface& s = lens_.surfaces[i];
            json_.begin_object().text("type", "Surface").number("thickness", thickness(i));
            write_geometry(i, frames.surfaces[i]);
            write_material(medium_behind(i));
            json_.truth("is_stop", s.type == SurfaceType::stop).key("aperture");
            write_apertures(i);
            write_interaction(s.type == SurfaceType::mirror);
        }
        json_.begin_object().text("type", "Surface").number("thickness", 0);
        begin_geometry("StandardGeometry", film_frame(lens_));
        json_.key("radius").number_or_infinity(lens_.film_radius_of_curvature).number("conic", 0).end();
        write_material(medium_behind(lens_.surfaces.size() - 1));
        json_.truth("is_stop", false).null("aperture");
        write_interaction(false);
        json_.end().end();
    }

    /// Ends a surface with its interaction model.
    void write_interaction(bool is_mirror) {
        json_.text("comment", "").begin_object("interaction_model");
        json_.text("type", "RefractiveReflectiveModel").truth("is_reflective", is_mirror);
        json_.null("coating").null("bsdf").end().end();
    }

    /// Begins a geometry with its frame. Optiland's angles are rotations about x, then y, then z, of fixed axes.
    void begin_geometry(const char* type, const Affine<double>& frame) {
        json_.begin_object("geometry").text("type", type).begin_object("cs");
        json_.number("x", frame.origin.x).number("y", frame.origin.y).key("z").number_or_infinity(frame.origin.z);
        const double across = hypotenuse(frame.x.x, frame.x.y);
        const bool is_locked = across < 1e-12;  // gimbal lock: only the sum or difference of rx and rz is defined
        const double rx = is_locked ? std::atan2(-frame.z.y, frame.y.y) : std::atan2(frame.y.z, frame.z.z);
        json_.number("rx", rx).number("ry", std::atan2(-frame.x.z, across));
        json_.number("rz", is_locked ? 0.0 : std::atan2(frame.x.y, frame.x.x)).null("reference_cs").end();
    }

    /// Begins a geometry with radius and conic constant.
    void begin_conic(const char* type, const Affine<double>& frame, const Surface& s) {
        begin_geometry(type, frame);
        write_radius("radius", s.bends_light() ? s.curvature : 0);
        json_.number("conic", s.bends_light() ? s.conic : 0.0);
    }
    /// Writes a radius of curvature in mm; infinity for a plane.
    void write_radius(const char* key, double curvature) {
        json_.key(key).number_or_infinity(curvature == 0 ? kInfinity : 1 / curvature);
    }

    /// Writes the shape and the frame of a surface.
    void write_geometry(std::size_t i, const Affine<double>& frame) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        const bool has_xy = !form.xy.empty() || form.zernike, is_odd = has_odd_terms(s);
        const std::string omitted_terms = beyond_polynomials(form);
        const std::map<int, double> radial = radial_terms_of(s);
        if (!s.bends_light()) {
            begin_conic("StandardGeometry", frame, s);
        } else if (form.base == BaseForm::toroid) {
            if (has_xy || !form.radial.empty() || form.forbes)
                warn(i, "has terms beside its toroid, which Optiland's geometries lack");
            begin_geometry("ToroidalGeometry", frame);
            write_radius("radius_x", form.curvature_x);
            write_radius("radius_y", s.curvature);
            std::vector<double> terms = s.aspheric;
            if (!terms.empty()) terms.insert(terms.begin(), 0.0);
            json_.number("conic_yz", s.conic).numbers("coeffs_poly_y", terms);
        } else if (form.zernike && form.xy.empty() && radial.empty() && omitted_terms.empty()) {
            begin_conic("ZernikePolynomialGeometry", frame, s);
            json_.numbers("coefficients", form.zernike->coefficients);
            json_.text("zernike_type", form.zernike->order == ZernikeOrder::noll ? "noll" : "fringe");
            json_.number("norm_radius", form.zernike->radius);
        } else {
            if (!omitted_terms.empty()) warn(i, "has " + omitted_terms + ", which Optiland does not read");
            if (has_xy && is_odd)
                warn(i, "has odd terms of r beside those of x and y, which Optiland's geometries lack");
            begin_conic(has_xy           ? "PolynomialGeometry"
                        : radial.empty() ? "StandardGeometry"
                        : is_odd         ? "OddAsphere"
                                         : "EvenAsphere",
                        frame, s);
            if (has_xy)
                write_polynomial_table(s);
            else if (!radial.empty())
                json_.numbers("coefficients", radial_list(radial, is_odd ? 1 : 2));
        }
        if (s.bends_light() && form.base == BaseForm::biconic)
            warn(i, "is a biconic, which Optiland lacks: it is written as a conic");
        json_.end();
    }

    /// Writes the table of coefficients of a polynomial: row i, column j is the coefficient of x^i y^j.
    void write_polynomial_table(const Surface& s) {
        const std::map<XyPower, double> terms = xy_terms_of(s);
        const std::size_t size = terms.empty() ? 1 : static_cast<std::size_t>(terms.rbegin()->first.first) + 1;
        std::vector<std::vector<double>> table(size, std::vector<double>(size, 0.0));
        for (const auto& [power, value] : terms)
            table[static_cast<std::size_t>(power.first - power.second)][static_cast<std::size_t>(power.second)] = value;
        json_.begin_array("coefficients");
        for (const std::vector<double>& row : table) json_.numbers(row);
        json_.end();
    }

    void write_material(const Glass& glass) {
        json_.begin_object("material_post");
        if (glass.has_one_index())
            json_.text("type", "IdealMaterial").number("index", glass.index(kLineD_nm)).number("absorp", 0);
        else
            write_dispersion(glass);
        json_.begin_object("propagation_model").text("class", "HomogeneousPropagation").end().end();
    }

    /// Writes a glass as dispersion data: a name could match another glass, and n_d and V_d imply another formula.
    void write_dispersion(const Glass& glass) {
        const Glass::Parts parts = glass.parts();
        json_.text("type", "DataMaterial").text("name", glass.label).text("bounds", "clamp");
        json_.begin_object("definition").begin_object("dispersion");
        if (parts.formula == Glass::Formula::table) {
            // Optiland interpolates linearly: with steps of 1 nm the error is at most 1e-7 in the visible.
            const auto [first, last] = glass.known_nm();
            std::set<double> wavelengths{kLineF_nm, kLineD_nm, kLineC_nm, lens_.wavelength_nm};
            for (const Glass::TablePoint& point : parts.points) wavelengths.insert(point.wavelength_nm);
            for (double nm = std::max(300.0, first); nm <= std::min(1100.0, last); ++nm) wavelengths.insert(nm);
            std::vector<double> micrometres, indices;
            for (const double nm : wavelengths) {
                if (nm < first || nm > last) continue;
                micrometres.push_back(nm / 1000);
                indices.push_back(glass.index(nm));
            }
            json_.text("kind", "tabulated").numbers("wavelengths_um", micrometres).numbers("indices", indices);
        } else {
            const bool is_cauchy = parts.formula == Glass::Formula::cauchy;
            std::vector<double> c = parts.coefficients;
            if (is_cauchy)
                for (std::size_t i = 1; 2 * i <= c.size(); ++i)
                    c.insert(c.begin() + static_cast<std::ptrdiff_t>(2 * i), -2.0 * static_cast<double>(i));
            else
                c.insert(c.begin(), 0.0);
            json_.text("kind", "formula").text("formula", is_cauchy ? "formula 5" : "formula 2");
            json_.numbers("coefficients", c);
        }
        json_.end().end();
    }

    /// Writes the apertures of a surface as nested differences and an intersection.
    void write_apertures(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const ApertureShape& shape = s.aperture_shape;
        for (std::size_t k = 0; k < shape.obscurations.size(); ++k) begin_aperture("DifferenceAperture").key("a");
        const bool has_outline = shape.half.x > 0 || shape.kind == ApertureOutline::polygon;
        if (has_outline) begin_aperture("IntersectionAperture").key("a");
        begin_aperture("RadialAperture");
        json_.number("r_max", s.clear_semi_diameter).number("r_min", s.inner_semi_diameter).end();
        if (has_outline) {
            json_.key("b");
            if (shape.kind == ApertureOutline::polygon)
                write_polygon(shape.corners, shape.offset);
            else
                write_shape({shape.kind == ApertureOutline::rectangle, shape.half, shape.offset, 0});
            json_.end();
        }
        for (std::size_t k = shape.obscurations.size(); k-- > 0;) {
            const Obscuration& obscuration = shape.obscurations[k];
            const bool is_rotated = obscuration.angle_deg != 0;
            if (is_rotated && !obscuration.is_rectangle && obscuration.half.x != obscuration.half.y)
                warn(i, "has a rotated elliptic obscuration, which is written without its rotation");
            json_.key("b");
            if (is_rotated && obscuration.is_rectangle)
                write_polygon(rotated_rectangle(obscuration.half, obscuration.angle_deg), obscuration.offset);
            else
                write_shape(obscuration);
            json_.end();
        }
    }

    JsonWriter& begin_aperture(const char* type) { return json_.begin_object().text("type", type); }

    /// Writes an ellipse or rectangle; its rotation is ignored.
    void write_shape(const Obscuration& obscuration) {
        const auto& [is_rectangle, half, offset, angle_deg] = obscuration;
        begin_aperture(is_rectangle ? "RectangularAperture" : "EllipticalAperture");
        if (is_rectangle)
            json_.numbers({{"x_min", offset.x - half.x}, {"x_max", offset.x + half.x}})
                .numbers({{"y_min", offset.y - half.y}, {"y_max", offset.y + half.y}});
        else
            json_.numbers({{"a", half.x}, {"b", half.y}, {"offset_x", offset.x}, {"offset_y", offset.y}});
        json_.end();
    }

    void write_polygon(const std::vector<Vec2d>& corners, Vec2d offset) {
        std::vector<double> x, y;
        for (const Vec2d& corner : corners) {
            x.push_back(corner.x + offset.x);
            y.push_back(corner.y + offset.y);
        }
        begin_aperture("PolygonAperture").numbers("x", x).numbers("y", y).end();
    }

    JsonWriter json_;
};

}  // namespace

LensText lens_as_optiland(const LensSystem& lens) {
    return OptilandWriter(lens).write();
}

}  // namespace realcam::io
