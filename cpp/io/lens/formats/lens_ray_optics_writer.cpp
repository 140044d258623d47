// Writes ray-optics' .roa: the data of its sequential model; the program computes other data itself.

#include <cmath>
#include <map>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../text/json_writer.hpp"
#include "../../text/printable.hpp"
#include "../lens_form_terms.hpp"
#include "../lens_glass.hpp"
#include "../lens_writers.hpp"

namespace realcam::io {
namespace {

constexpr double kFarAway = 1e10;  // ray-optics' infinity

class RayOpticsWriter {
public:
    explicit RayOpticsWriter(const LensSystem& lens) : lens_(lens) {}

    LensText write() {
        result_.warnings = left_out_of_foreign_files(lens_, "ray-optics");
        if (!lens_.zoom.positions.empty())
            result_.warnings.push_back("zoom positions, which a ray-optics file has no word for");
        json_.begin_object().key("optical_model");
        begin("rayoptics.optical.opticalmodel", "OpticalModel");
        json_.key("ro_version").text("0.9.8").key("radius_mode").truth(false);
        write_system();
        write_sequence();
        write_specification();
        json_.key("profile_dict").begin_object();
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) write_profile(i);
        json_.key("0");
        write_sphere(0);
        json_.key(image_name());
        // The sag of the film is measured along the light, and that of the file along the axis.
        write_sphere((lens_.film_distance < 0 ? -1 : 1) / lens_.film_radius_of_curvature);
        json_.end();
        end();
        json_.end();
        result_.text = json_.finish() + '\n';
        return std::move(result_);
    }

private:
    void begin(const char* module, const char* type) {
        json_.begin_object().key("__instance_type__").begin_array().text(module).text(type).end();
        json_.key("attributes").begin_object();
    }
    void end() { json_.end().end(); }

    void write_array(const std::vector<double>& values) {
        json_.begin_object().key("__ndarray__");
        write_list(values);
        json_.key("dtype").text("float64").key("shape").begin_array();
        json_.number(static_cast<double>(values.size())).end().end();
    }
    void write_list(const std::vector<double>& values) {
        json_.begin_array();
        for (const double value : values) json_.number(value);
        json_.end();
    }

    std::string image_name() const { return std::to_string(lens_.surfaces.size() + 1); }
    void leave_out(std::size_t i, const std::string& what) {
        result_.warnings.push_back("surface " + std::to_string(i + 1) + ' ' + what);
    }

    void write_system() {
        json_.key("system_spec");
        begin("rayoptics.optical.opticalmodel", "SystemSpec");
        json_.key("title").text(printable(lens_.title.empty() ? lens_.name : lens_.title)).key("initials").text("");
        json_.key("_dimensions").text("mm").key("temperature").number(20).key("pressure").number(760);
        end();
    }

    void write_sequence() {
        json_.key("seq_model");
        begin("rayoptics.seq.sequential", "SequentialModel");
        json_.key("ifcs").begin_array();
        write_interface("0", "Obj", "dummy", 0.5 * lens_.film_width, nullptr, {});
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) {
            const Surface& s = lens_.surfaces[i];
            const char* mode = s.type == SurfaceType::mirror ? "reflect" : "transmit";
            write_interface(std::to_string(i + 1), "", mode, s.clear_semi_diameter, &s, s.placement);
        }
        write_interface(image_name(), "Img", "dummy", 0.5 * hypotenuse(lens_.film_width, lens_.film_height), nullptr,
                        lens_.film_placement);
        json_.end();
        json_.key("gaps").begin_array();
        const double object = lens_.focus_distance - lens_.film_position();
        const Glass air = Glass::air();
        write_gap(std::isfinite(object) ? object : kFarAway, air);
        const Glass* medium = &air;
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) {
            const Surface& s = lens_.surfaces[i];
            if (s.type == SurfaceType::refracting) medium = &s.material;
            write_gap(i + 1 == lens_.surfaces.size() ? lens_.film_distance : s.thickness, *medium);
        }
        json_.end();
        json_.key("stop_surface").number(lens_.stop_index() + 1);
        json_.key("cur_surface").number(static_cast<double>(lens_.surfaces.size()));
        json_.key("do_apertures").truth(false);
        end();
    }

    void write_interface(const std::string& profile, const char* label, const char* mode, double rim, const Surface* s,
                         const SurfacePlacement& place) {
        begin("rayoptics.elem.surface", "Surface");
        json_.key("label").text(label).key("delta_n").number(0).key("interact_mode").text(mode);
        json_.key("profile_id").text(profile).key("max_aperture").number(rim).key("decenter");
        write_decentre(place);
        json_.key("clear_apertures").begin_array();
        if (s) write_apertures(*s);
        json_.end().key("edge_apertures").begin_array().end();
        end();
    }

    void write_decentre(const SurfacePlacement& place) {
        if (place.is_in_place()) {
            json_.null();
            return;
        }
        begin("rayoptics.elem.surface", "DecenterData");
        json_.key("_dtype").text(place.returns ? "dec and return" : "decenter").key("dec");
        write_array({place.decentre.x, place.decentre.y, place.decentre.z});
        // The first two angles are positive clockwise.
        json_.key("euler");
        write_array({-place.tilt_deg.x, -place.tilt_deg.y, place.tilt_deg.z});
        json_.key("rot_pt");
        write_array({0, 0, 0});
        json_.key("rot_mat").null();
        end();
    }

    void write_aperture(const char* type, Vec2d half, Vec2d offset, bool blocks) {
        begin("rayoptics.elem.surface", type);
        json_.key("x_offset").number(offset.x).key("y_offset").number(offset.y).key("rotation").number(0);
        json_.key("is_obscuration").truth(blocks);
        if (std::string_view(type) == "Circular")
            json_.key("radius").number(half.x);
        else
            json_.key("x_half_width").number(half.x).key("y_half_width").number(half.y);
        end();
    }

    void write_apertures(const Surface& s) {
        const auto i = static_cast<std::size_t>(&s - lens_.surfaces.data());
        const ApertureShape& shape = s.aperture_shape;
        const bool is_stop = s.type == SurfaceType::stop;
        const double rim = is_stop ? lens_.stop_semi_diameter : s.clear_semi_diameter;
        write_aperture("Circular", {rim, rim}, {0, 0}, false);
        if (s.inner_semi_diameter > 0)
            write_aperture("Circular", {s.inner_semi_diameter, s.inner_semi_diameter}, {0, 0}, true);
        if (shape.kind == ApertureOutline::polygon)
            leave_out(i, "has a polygonal aperture, which a ray-optics file has no word for");
        else if (shape.half.x > 0)
            write_aperture(shape.kind == ApertureOutline::circle      ? "Circular"
                           : shape.kind == ApertureOutline::rectangle ? "Rectangular"
                                                                      : "Elliptical",
                           shape.half, shape.offset, false);
        for (const Obscuration& piece : shape.obscurations) {
            const bool is_turned = piece.angle_deg != 0 && (piece.is_rectangle || piece.half.x != piece.half.y);
            if (is_turned)
                leave_out(i, "has an obscuration that is turned, which a ray-optics file has no word for");
            else
                write_aperture(piece.is_rectangle ? "Rectangular" : "Elliptical", piece.half, piece.offset, true);
        }
    }

    void write_gap(double thickness, const Glass& medium) {
        begin("rayoptics.seq.gap", "Gap");
        json_.key("thi").number(thickness).key("medium");
        write_medium(medium);
        end();
    }

    void write_medium(const Glass& glass) {
        static const std::map<std::string, const char*> makers{{"schott", "SchottGlass"}, {"ohara", "OharaGlass"},
                                                               {"hoya", "HoyaGlass"},     {"cdgm", "CDGMGlass"},
                                                               {"hikari", "HikariGlass"}, {"sumita", "SumitaGlass"}};
        if (glass.is_air()) {
            begin("opticalglass.opticalmedium", "Air");
            return end();
        }
        const std::vector<Glass::TablePoint> points = indices_at_lines(glass, lens_.wavelength_nm);
        const bool is_constant = std::all_of(points.begin(), points.end(),
                                             [&](const auto& point) { return point.index == points.front().index; });
        if (const auto known = catalogue_name_of(glass); known && makers.contains(known->maker)) {
            begin(("opticalglass." + known->maker).c_str(), makers.at(known->maker));
            json_.key("gname").text(known->name);
        } else if (is_constant) {
            begin("opticalglass.opticalmedium", "ConstantIndex");
            json_.key("label").text(glass.label).key("n").number(points.front().index).key("_catalog").text("");
        } else {
            begin("opticalglass.opticalmedium", "InterpolatedMedium");
            json_.key("label").text(glass.label.empty() ? "glass" : glass.label).key("_catalog").text("").key("wvls");
            std::vector<double> wavelengths, indices;
            for (const auto& point : points) {
                wavelengths.push_back(point.wavelength_nm);
                indices.push_back(point.index);
            }
            write_list(wavelengths);
            json_.key("rndx");
            write_list(indices);
            json_.key("kvals").null().key("kvals_wvls").null();
        }
        end();
    }

    void write_sphere(double curvature) {
        begin("rayoptics.elem.profiles", "Spherical");
        json_.key("cv").number(curvature);
        end();
    }

    void write_profile(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        json_.key(std::to_string(i + 1));
        if (!s.bends_light()) return write_sphere(0);
        if (form.base == BaseForm::biconic)
            leave_out(i, "is a biconic, which ray-optics lacks: it is written as a conic");
        if (!form.xy.empty() || form.zernike)
            leave_out(i, "has terms of x and y or of Zernike, which ray-optics lacks");
        if (const std::string terms = beyond_polynomials(form); !terms.empty())
            leave_out(i, "has " + terms + ", which ray-optics lacks");
        const bool is_toroid = form.base == BaseForm::toroid, odd = !is_toroid && has_odd_terms(s);
        if (is_toroid && (!form.radial.empty() || form.forbes))
            leave_out(i, "has radial terms on a toroid, which ray-optics lacks");
        const std::map<int, double> radial = radial_terms_of(s);
        if (!is_toroid && radial.empty() && s.conic == 0) return write_sphere(s.curvature);
        const int step = odd ? 1 : 2;
        std::vector<double> terms(10, 0.0);
        for (const auto& [power, value] : radial) {
            const auto place = static_cast<std::size_t>(power / step);
            if (terms.size() < place) terms.resize(place, 0.0);
            terms[place - 1] = value;
        }
        begin("rayoptics.elem.profiles", is_toroid ? "YToroid" : odd ? "RadialPolynomial" : "EvenPolynomial");
        json_.key("cv").number(s.curvature);
        if (is_toroid) json_.key("cR").number(form.curvature_x);
        if (odd)
            json_.key("ec").number(s.conic + 1);
        else
            json_.key("cc").number(s.conic);
        json_.key("coefs");
        write_list(terms);
        json_.key("max_nonzero_coef").number(static_cast<double>(terms.size()));
        end();
    }

    void write_specification() {
        json_.key("optical_spec");
        begin("rayoptics.raytr.opticalspec", "OpticalSpecs");
        json_.key("do_aiming").truth(true).key("spectral_region");
        begin("rayoptics.raytr.opticalspec", "WvlSpec");
        json_.key("wavelengths");
        write_list({lens_.wavelength_nm});
        json_.key("spectral_wts");
        write_list({1});
        json_.key("render_colors").begin_array().text("black").end();
        json_.key("reference_wvl").number(0).key("coating_wvl").number(550);
        end();
        const FirstOrder data = first_order(centred(lens_), lens_.wavelength_nm);
        if (!std::isfinite(data.entrance_pupil_diameter))
            throw InputError("lens \"" + lens_.name +
                             "\" has its entrance pupil at infinity, and no aperture that a .roa file states");
        json_.key("pupil");
        begin("rayoptics.raytr.opticalspec", "PupilSpec");
        json_.key("_key").begin_array().text("aperture").text("object").text("epd").end();
        json_.key("value").number(data.entrance_pupil_diameter);
        json_.key("pupil_rays").begin_array();
        for (const auto& [x, y] : {Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{-1, 0}, Vec2d{0, 1}, Vec2d{0, -1}})
            write_list({x, y});
        json_.end().key("ray_labels").begin_array();
        for (const char* label : {"00", "+X", "-X", "+Y", "-Y"}) json_.text(label);
        json_.end();
        end();
        write_fields();
        json_.key("defocus");
        begin("rayoptics.raytr.opticalspec", "FocusRange");
        json_.key("focus_shift").number(0).key("defocus_range").number(0);
        end();
        end();
    }

    void write_fields() {
        const double corner = 0.5 * hypotenuse(lens_.film_width, lens_.film_height);
        json_.key("field_of_view");
        begin("rayoptics.raytr.opticalspec", "FieldSpec");
        json_.key("key").begin_array().text("field").text("image").text("real height").end();
        json_.key("value").number(corner).key("is_relative").truth(false).key("is_wide_angle").truth(false);
        json_.key("index_labels").begin_array().text("axis").text("corner").end();
        json_.key("index_label_type").text("auto").key("fields").begin_array();
        for (const double height : {0.0, corner}) {
            begin("rayoptics.raytr.opticalspec", "Field");
            json_.key("x").number(0).key("y").number(height);
            for (const char* cut : {"vux", "vuy", "vlx", "vly"}) json_.key(cut).number(0);
            json_.key("wt").number(1).key("aim_info").null();
            end();
        }
        json_.end();
        end();
    }

    const LensSystem& lens_;
    LensText result_;
    JsonWriter json_;
};

}  // namespace

LensText lens_as_ray_optics(const LensSystem& lens) {
    return RayOpticsWriter(lens).write();
}

}  // namespace realcam::io
