// Writes Optiland's JSON. Each surface has its position in the lens frame, and its angles about that frame's axes.

#include <cmath>
#include <optional>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../../optics/prescription/surface_frames.hpp"
#include "../../../optics/trace/film_frame.hpp"
#include "../../text/json_writer.hpp"
#include "../../text/printable.hpp"
#include "../lens_form_terms.hpp"
#include "../lens_glass.hpp"
#include "../lens_writers.hpp"

namespace realcam::io {
namespace {

class OptilandWriter {
public:
    explicit OptilandWriter(const LensSystem& lens) : lens_(lens) {}

    LensText write() {
        result_.warnings = left_out_of_foreign_files(lens_, "Optiland");
        if (!lens_.zoom.positions.empty())
            result_.warnings.push_back("zoom positions, which an Optiland file has no word for");
        json_.begin_object().key("version").number(1);
        json_.key("name").text(printable(lens_.title.empty() ? lens_.name : lens_.title));
        json_.key("aperture").begin_object().key("type").text("float_by_stop_size");
        json_.key("value").number(2 * lens_.stop_semi_diameter).end();
        write_fields();
        json_.key("wavelengths").begin_object().key("wavelengths").begin_array().begin_object();
        json_.key("value").number(lens_.wavelength_nm).key("is_primary").truth(true).key("unit").text("nm");
        json_.key("weight").number(1).end().end().key("polarization").text("ignore").end();
        json_.key("apodization").null().key("pickups").begin_array().end();
        json_.key("solves").begin_object().key("solves").begin_array().end().end();
        write_surfaces();
        json_.end();
        result_.text = json_.finish() + '\n';
        return std::move(result_);
    }

private:
    void leave_out(std::size_t i, const std::string& what) {
        result_.warnings.push_back("surface " + std::to_string(i + 1) + ' ' + what);
    }

    void write_fields() {
        const double corner = 0.5 * hypotenuse(lens_.film_width, lens_.film_height);
        json_.key("fields").begin_object().key("fields").begin_array();
        for (const double height : {0.0, corner}) {
            json_.begin_object().key("x").number(0).key("y").number(height).key("vx").number(0).key("vy").number(0);
            json_.key("weight").number(1).end();
        }
        json_.end().key("telecentric").truth(false).key("field_definition").begin_object();
        json_.key("field_type").text("ParaxialImageHeightField").end().end();
    }

    void write_surfaces() {
        json_.key("surface_group").begin_object().key("surfaces").begin_array();
        const double object = lens_.focus_distance - lens_.film_position();
        json_.begin_object().key("type").text("ObjectSurface").key("geometry").begin_object().key("type").text("Plane");
        write_frame(along_axis(-object));
        json_.key("radius").number_or_infinity(kInfinity).end();
        write_material(Glass::air());
        json_.key("comment").text("").end();
        const SurfaceFrames frames = surface_frames(lens_);
        const Glass air = Glass::air();
        const Glass* medium = &air;
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) {
            const Surface& s = lens_.surfaces[i];
            if (s.type == SurfaceType::refracting) medium = &s.material;
            json_.begin_object().key("type").text("Surface");
            json_.key("thickness").number(i + 1 == lens_.surfaces.size() ? lens_.film_distance : s.thickness);
            write_geometry(i, frames.surfaces[i]);
            write_material(*medium);
            json_.key("is_stop").truth(s.type == SurfaceType::stop).key("aperture");
            write_apertures(i);
            write_rest(s.type == SurfaceType::mirror);
        }
        json_.begin_object().key("type").text("Surface").key("thickness").number(0).key("geometry").begin_object();
        json_.key("type").text("StandardGeometry");
        const Affine<double> film = film_frame(lens_);
        write_frame(film);
        json_.key("radius").number_or_infinity(lens_.film_radius_of_curvature).key("conic").number(0).end();
        write_material(*medium);
        json_.key("is_stop").truth(false).key("aperture").null();
        write_rest(false);
        json_.end().end();
    }

    void write_rest(bool is_mirror) {
        json_.key("comment").text("").key("interaction_model").begin_object();
        json_.key("type").text("RefractiveReflectiveModel").key("is_reflective").truth(is_mirror);
        json_.key("coating").null().key("bsdf").null().end().end();
    }

    /// Optiland's angles are rotations about x, then y, then z, of fixed axes.
    void write_frame(const Affine<double>& frame) {
        json_.key("cs").begin_object();
        json_.key("x").number(frame.origin.x).key("y").number(frame.origin.y);
        json_.key("z").number_or_infinity(frame.origin.z);
        const double across = hypotenuse(frame.x.x, frame.x.y);
        const bool is_locked = across < 1e-12;
        const double rx = is_locked ? std::atan2(-frame.z.y, frame.y.y) : std::atan2(frame.y.z, frame.z.z);
        json_.key("rx").number(rx).key("ry").number(std::atan2(-frame.x.z, across));
        json_.key("rz").number(is_locked ? 0.0 : std::atan2(frame.x.y, frame.x.x)).key("reference_cs").null().end();
    }

    void begin_geometry(const char* type, const Affine<double>& frame) {
        json_.key("geometry").begin_object().key("type").text(type);
        write_frame(frame);
    }
    void write_conic(const Surface& s) {
        json_.key("radius").number_or_infinity(s.bends_light() && s.curvature != 0 ? 1 / s.curvature : kInfinity);
        json_.key("conic").number(s.bends_light() ? s.conic : 0.0);
    }
    void write_list(const char* key, const std::vector<double>& values) {
        json_.key(key).begin_array();
        for (const double value : values) json_.number(value);
        json_.end();
    }

    void write_geometry(std::size_t i, const Affine<double>& frame) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        const bool has_xy = !form.xy.empty() || form.zernike;
        const std::string beyond = beyond_polynomials(form);
        const std::map<int, double> radial = radial_terms_of(s);
        if (!s.bends_light()) {
            begin_geometry("StandardGeometry", frame);
            write_conic(s);
        } else if (form.base == BaseForm::toroid) {
            if (has_xy || !form.radial.empty() || form.forbes)
                leave_out(i, "has terms beside its toroid, which Optiland's geometries lack");
            write_toroid(s, frame);
        } else if (form.zernike && form.xy.empty() && radial.empty() && beyond.empty()) {
            begin_geometry("ZernikePolynomialGeometry", frame);
            write_conic(s);
            write_list("coefficients", form.zernike->coefficients);
            json_.key("zernike_type").text(form.zernike->order == ZernikeOrder::noll ? "noll" : "fringe");
            json_.key("norm_radius").number(form.zernike->radius);
        } else {
            if (!beyond.empty()) leave_out(i, "has " + beyond + ", which Optiland does not read");
            write_polynomials(i, s, radial, frame);
        }
        if (s.bends_light() && form.base == BaseForm::biconic)
            leave_out(i, "is a biconic, which Optiland has not: it is written as a conic");
        json_.end();
    }

    void write_toroid(const Surface& s, const Affine<double>& frame) {
        begin_geometry("ToroidalGeometry", frame);
        const auto radius = [](double curvature) { return curvature == 0 ? kInfinity : 1 / curvature; };
        json_.key("radius_x").number_or_infinity(radius(s.form.curvature_x));
        json_.key("radius_y").number_or_infinity(radius(s.curvature)).key("conic_yz").number(s.conic);
        std::vector<double> terms(s.aspheric.empty() ? 0 : s.aspheric.size() + 1, 0.0);
        for (std::size_t k = 0; k < s.aspheric.size(); ++k) terms[k + 1] = s.aspheric[k];
        write_list("coeffs_poly_y", terms);
    }

    void write_polynomials(std::size_t i, const Surface& s, const std::map<int, double>& radial,
                           const Affine<double>& frame) {
        const bool has_xy = !s.form.xy.empty() || s.form.zernike, is_odd = has_odd_terms(s);
        if (has_xy) {
            if (is_odd) leave_out(i, "has odd terms of r beside those of x and y, which Optiland's geometries lack");
            begin_geometry("PolynomialGeometry", frame);
            write_conic(s);
            return write_table(s);
        }
        begin_geometry(radial.empty() ? "StandardGeometry" : is_odd ? "OddAsphere" : "EvenAsphere", frame);
        write_conic(s);
        if (radial.empty()) return;
        const int step = is_odd ? 1 : 2;
        std::vector<double> terms(static_cast<std::size_t>(radial.rbegin()->first / step), 0.0);
        for (const auto& [power, value] : radial) terms[static_cast<std::size_t>(power / step - 1)] = value;
        write_list("coefficients", terms);
    }

    /// Writes a row for each power of x, with a column for each power of y.
    void write_table(const Surface& s) {
        const std::map<XyPower, double> terms = xy_terms_of(s);
        const int size = terms.empty() ? 1 : terms.rbegin()->first.first + 1;
        std::vector<std::vector<double>> table(static_cast<std::size_t>(size),
                                               std::vector<double>(static_cast<std::size_t>(size), 0.0));
        for (const auto& [power, value] : terms)
            table[static_cast<std::size_t>(power.first - power.second)][static_cast<std::size_t>(power.second)] = value;
        json_.key("coefficients").begin_array();
        for (const std::vector<double>& row : table) {
            json_.begin_array();
            for (const double value : row) json_.number(value);
            json_.end();
        }
        json_.end();
    }

    void write_material(const Glass& glass) {
        json_.key("material_post").begin_object();
        if (glass.has_one_index()) {
            json_.key("type").text("IdealMaterial").key("index").number(glass.index(kLineD_nm));
            json_.key("absorp").number(0);
        } else {
            write_dispersion(glass);
        }
        json_.key("propagation_model").begin_object().key("class").text("HomogeneousPropagation").end().end();
    }

    /// Writes a glass as dispersion data: a name could match another glass, and n_d and V_d imply another formula.
    void write_dispersion(const Glass& glass) {
        const Glass::Parts parts = glass.parts();
        json_.key("type").text("DataMaterial").key("name").text(glass.label).key("bounds").text("clamp");
        json_.key("definition").begin_object().key("dispersion").begin_object();
        if (parts.formula == Glass::Formula::table) {
            // Optiland interpolates linearly: with steps of 1 nm the error is at most 1e-7 in the visible.
            const auto [first, last] = glass.known_nm();
            std::set<double> wavelengths{kLineF_nm, kLineD_nm, kLineC_nm, lens_.wavelength_nm};
            for (const Glass::TablePoint& point : parts.points) wavelengths.insert(point.wavelength_nm);
            for (double nm = std::max(300.0, first); nm <= std::min(1100.0, last); ++nm) wavelengths.insert(nm);
            std::erase_if(wavelengths, [&](double nm) { return nm < first || nm > last; });
            std::vector<double> micrometres, indices;
            for (const double nm : wavelengths) {
                micrometres.push_back(nm / 1000);
                indices.push_back(glass.index(nm));
            }
            json_.key("kind").text("tabulated");
            write_list("wavelengths_um", micrometres);
            write_list("indices", indices);
        } else {
            const bool is_cauchy = parts.formula == Glass::Formula::cauchy;
            std::vector<double> c = parts.coefficients;
            if (is_cauchy)
                for (std::size_t i = 1; 2 * i <= c.size(); ++i)
                    c.insert(c.begin() + static_cast<std::ptrdiff_t>(2 * i), -2.0 * static_cast<double>(i));
            else
                c.insert(c.begin(), 0.0);
            json_.key("kind").text("formula").key("formula").text(is_cauchy ? "formula 5" : "formula 2");
            write_list("coefficients", c);
        }
        json_.end().end();
    }

    void write_apertures(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const ApertureShape& shape = s.aperture_shape;
        for (std::size_t k = 0; k < shape.obscurations.size(); ++k)
            json_.begin_object().key("type").text("DifferenceAperture").key("a");
        const bool has_outline = shape.half.x > 0 || shape.kind == ApertureOutline::polygon;
        if (has_outline) json_.begin_object().key("type").text("IntersectionAperture").key("a");
        json_.begin_object().key("type").text("RadialAperture");
        json_.key("r_max").number(s.clear_semi_diameter).key("r_min").number(s.inner_semi_diameter).end();
        if (has_outline) {
            json_.key("b");
            write_outline(shape);
            json_.end();
        }
        for (std::size_t k = shape.obscurations.size(); k-- > 0;) {
            json_.key("b");
            write_piece(i, shape.obscurations[k]);
            json_.end();
        }
    }

    void write_outline(const ApertureShape& shape) {
        if (shape.kind == ApertureOutline::polygon) return write_polygon(shape.corners, shape.offset);
        if (shape.kind == ApertureOutline::rectangle) return write_rectangle(shape.half, shape.offset);
        write_ellipse(shape.half, shape.offset);
    }

    void write_piece(std::size_t i, const Obscuration& piece) {
        if (piece.angle_deg == 0) {
            piece.is_rectangle ? write_rectangle(piece.half, piece.offset) : write_ellipse(piece.half, piece.offset);
        } else if (piece.is_rectangle) {
            const Affine<double> turn = SurfacePlacement{{}, {0, 0, piece.angle_deg}, false}.frame();
            std::vector<Vec2d> corners;
            for (const auto& [x, y] : {Vec2d{1, 1}, Vec2d{-1, 1}, Vec2d{-1, -1}, Vec2d{1, -1}}) {
                const Vec3d corner = turn.direction({x * piece.half.x, y * piece.half.y, 0});
                corners.push_back({corner.x, corner.y});
            }
            write_polygon(corners, piece.offset);
        } else {
            if (piece.half.x != piece.half.y)
                leave_out(i, "has an elliptic obscuration that is turned, which is written as if it were not");
            write_ellipse(piece.half, piece.offset);
        }
    }

    void write_ellipse(Vec2d half, Vec2d offset) {
        json_.begin_object().key("type").text("EllipticalAperture").key("a").number(half.x).key("b").number(half.y);
        json_.key("offset_x").number(offset.x).key("offset_y").number(offset.y).end();
    }
    void write_rectangle(Vec2d half, Vec2d offset) {
        json_.begin_object().key("type").text("RectangularAperture");
        json_.key("x_min").number(offset.x - half.x).key("x_max").number(offset.x + half.x);
        json_.key("y_min").number(offset.y - half.y).key("y_max").number(offset.y + half.y).end();
    }
    void write_polygon(const std::vector<Vec2d>& corners, Vec2d offset) {
        std::vector<double> x, y;
        for (const Vec2d& corner : corners) {
            x.push_back(corner.x + offset.x);
            y.push_back(corner.y + offset.y);
        }
        json_.begin_object().key("type").text("PolygonAperture");
        write_list("x", x);
        write_list("y", y);
        json_.end();
    }

    const LensSystem& lens_;
    LensText result_;
    JsonWriter json_;
};

}  // namespace

LensText lens_as_optiland(const LensSystem& lens) {
    return OptilandWriter(lens).write();
}

}  // namespace realcam::io
