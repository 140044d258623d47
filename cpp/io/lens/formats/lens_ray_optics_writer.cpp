// Writer of ray-optics' JSON files (.roa): only the sequential model, from which ray-optics computes its other data.

#include <algorithm>
#include <cmath>
#include <map>

#include "../../text/json_writer.hpp"
#include "../lens_glass.hpp"
#include "prescription_writer.hpp"

namespace realcam::io {
namespace {

constexpr double kRayOpticsInfinity_mm = 1e10;  // mm, stands for infinity in ray-optics

class RayOpticsWriter : PrescriptionWriter {
public:
    explicit RayOpticsWriter(const LensSystem& lens) : PrescriptionWriter(lens, "ray-optics") {}

    LensText write() {
        if (!lens_.zoom.positions.empty())
            result_.warnings.emplace_back("zoom positions, which a ray-optics file cannot express");
        json_.begin_object().key("optical_model");
        begin("rayoptics.optical.opticalmodel", "OpticalModel");
        json_.text("ro_version", "0.9.8").truth("radius_mode", false).key("system_spec");
        begin("rayoptics.optical.opticalmodel", "SystemSpec");
        json_.text("title", title()).text("initials", "").text("_dimensions", "mm");
        json_.number("temperature", 20).number("pressure", 760);
        end();
        write_sequence();
        write_specification();
        json_.begin_object("profile_dict");
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) write_profile(i);
        write_sphere("0", 0);
        write_sphere(name_of(lens_.surfaces.size()), image_curvature());
        json_.end();
        end();
        json_.end();
        result_.text = json_.finish() + '\n';
        return std::move(result_);
    }

private:
    /// Begins an object of a Python class, as the value of the last key or as an element; end() ends it.
    JsonWriter& begin(const std::string& module, const char* type) {
        json_.begin_object().begin_array("__instance_type__").text(module).text(type).end();
        return json_.begin_object("attributes");
    }
    /// Begins a part of the optical specification under a key.
    JsonWriter& begin_part(const char* key, const char* type) {
        json_.key(key);
        return begin("rayoptics.raytr.opticalspec", type);
    }
    void end() { json_.end().end(); }

    /// Writes a NumPy array.
    void write_array(const char* key, const std::vector<double>& values) {
        json_.begin_object(key).numbers("__ndarray__", values).text("dtype", "float64");
        json_.numbers("shape", {static_cast<double>(values.size())}).end();
    }

    /// Profile id of a surface.
    static std::string name_of(std::size_t surface) { return std::to_string(surface + 1); }

    void write_sequence() {
        const std::size_t count = lens_.surfaces.size();
        json_.key("seq_model");
        begin("rayoptics.seq.sequential", "SequentialModel").begin_array("ifcs");
        write_interface("0", "Obj", "dummy", 0.5 * lens_.film_width, {}, count);
        for (std::size_t i = 0; i < count; ++i) {
            const Surface& s = lens_.surfaces[i];
            const char* mode = s.type == SurfaceType::mirror ? "reflect" : "transmit";
            write_interface(name_of(i), "", mode, s.clear_semi_diameter, s.placement, i);
        }
        write_interface(name_of(count), "Img", "dummy", film_corner(), lens_.film_placement, count);
        json_.end().begin_array("gaps");
        write_gap(std::isfinite(object_distance()) ? object_distance() : kRayOpticsInfinity_mm, Glass::air());
        for (std::size_t i = 0; i < count; ++i) write_gap(thickness(i), medium_behind(i));
        json_.end().number("stop_surface", lens_.stop_index() + 1);
        json_.number("cur_surface", static_cast<double>(count)).truth("do_apertures", false);
        end();
    }

    /// Writes an interface. `profile`: id of its shape. `rim`: semi-diameter, mm. `surface`: index of the surface whose
    /// apertures are written; the number of surfaces for object and image.
    void write_interface(const std::string& profile, const char* label, const char* mode, double rim,
                         const SurfacePlacement& placement, std::size_t surface) {
        begin("rayoptics.elem.surface", "Surface").text("label", label).number("delta_n", 0);
        json_.text("interact_mode", mode).text("profile_id", profile).number("max_aperture", rim).key("decenter");
        write_decentre(placement);
        json_.begin_array("clear_apertures");
        if (surface < lens_.surfaces.size()) write_apertures(surface);
        json_.end().numbers("edge_apertures", {});
        end();
    }

    void write_decentre(const SurfacePlacement& placement) {
        if (placement.is_in_place()) {
            json_.null();
            return;
        }
        const auto& [decentre, tilt, returns] = placement;
        begin("rayoptics.elem.surface", "DecenterData").text("_dtype", returns ? "dec and return" : "decenter");
        write_array("dec", {decentre.x, decentre.y, decentre.z});
        write_array("euler", {-tilt.x, -tilt.y, tilt.z});  // the first two angles have the opposite sign
        write_array("rot_pt", {0, 0, 0});
        json_.null("rot_mat");
        end();
    }

    void write_aperture(ApertureOutline kind, Vec2d half, Vec2d offset, bool is_obscuration) {
        const bool is_circle = kind == ApertureOutline::circle;
        begin("rayoptics.elem.surface", is_circle                            ? "Circular"
                                        : kind == ApertureOutline::rectangle ? "Rectangular"
                                                                             : "Elliptical");
        json_.number("x_offset", offset.x).number("y_offset", offset.y).number("rotation", 0);
        json_.truth("is_obscuration", is_obscuration);
        if (is_circle)
            json_.number("radius", half.x);
        else
            json_.number("x_half_width", half.x).number("y_half_width", half.y);
        end();
    }

    void write_apertures(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const ApertureShape& shape = s.aperture_shape;
        const double rim = s.type == SurfaceType::stop ? lens_.stop_semi_diameter : s.clear_semi_diameter;
        write_aperture(ApertureOutline::circle, {rim, rim}, {0, 0}, false);
        if (const double inner = s.inner_semi_diameter; inner > 0)
            write_aperture(ApertureOutline::circle, {inner, inner}, {0, 0}, true);
        if (shape.kind == ApertureOutline::polygon)
            warn(i, "has a polygonal aperture, which a ray-optics file cannot express");
        else if (shape.half.x > 0)
            write_aperture(shape.kind, shape.half, shape.offset, false);
        for (const Obscuration& obscuration : shape.obscurations) {
            const bool is_rotated =
                obscuration.angle_deg != 0 && (obscuration.is_rectangle || obscuration.half.x != obscuration.half.y);
            if (is_rotated)
                warn(i, "has a rotated obscuration, which a ray-optics file cannot express");
            else
                write_aperture(obscuration.is_rectangle ? ApertureOutline::rectangle : ApertureOutline::ellipse,
                               obscuration.half, obscuration.offset, true);
        }
    }

    void write_gap(double thickness, const Glass& medium) {
        begin("rayoptics.seq.gap", "Gap").number("thi", thickness).key("medium");
        write_medium(medium);
        end();
    }

    void write_medium(const Glass& glass) {
        static const std::map<std::string, const char*> makers{{"schott", "SchottGlass"}, {"ohara", "OharaGlass"},
                                                               {"hoya", "HoyaGlass"},     {"cdgm", "CDGMGlass"},
                                                               {"hikari", "HikariGlass"}, {"sumita", "SumitaGlass"}};
        std::vector<double> wavelengths, indices;
        for (const auto& [nm, index] : indices_at_lines(glass, lens_.wavelength_nm)) {
            wavelengths.push_back(nm);
            indices.push_back(index);
        }
        const auto known = catalogue_name_of(glass);
        if (glass.is_air()) {
            begin("opticalglass.opticalmedium", "Air");
        } else if (known && makers.contains(known->maker)) {
            begin("opticalglass." + known->maker, makers.at(known->maker)).text("gname", known->name);
        } else if (std::ranges::count(indices, indices.front()) == std::ssize(indices)) {
            begin("opticalglass.opticalmedium", "ConstantIndex").text("label", glass.label);
            json_.number("n", indices.front()).text("_catalog", "");
        } else {
            begin("opticalglass.opticalmedium", "InterpolatedMedium");
            json_.text("label", glass.label.empty() ? "glass" : glass.label).text("_catalog", "");
            json_.numbers("wvls", wavelengths).numbers("rndx", indices).null("kvals").null("kvals_wvls");
        }
        end();
    }

    void write_sphere(const std::string& name, double curvature) {
        json_.key(name);
        begin("rayoptics.elem.profiles", "Spherical").number("cv", curvature);
        end();
    }

    /// Writes the shape of a surface.
    void write_profile(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const SurfaceForm& form = s.form;
        if (!s.bends_light()) return write_sphere(name_of(i), 0);
        const bool is_toroid = form.base == BaseForm::toroid, odd = !is_toroid && has_odd_terms(s);
        if (form.base == BaseForm::biconic) warn(i, "is a biconic, which ray-optics lacks: it is written as a conic");
        if (!form.xy.empty() || form.zernike) warn(i, "has terms of x and y or of Zernike, which ray-optics lacks");
        if (const std::string terms = beyond_polynomials(form); !terms.empty())
            warn(i, "has " + terms + ", which ray-optics lacks");
        if (is_toroid && (!form.radial.empty() || form.forbes))
            warn(i, "has radial terms on a toroid, which ray-optics lacks");
        const std::map<int, double> radial = radial_terms_of(s);
        if (!is_toroid && radial.empty() && s.conic == 0) return write_sphere(name_of(i), s.curvature);
        std::vector<double> terms = radial_list(radial, odd ? 1 : 2);
        terms.resize(std::max<std::size_t>(terms.size(), 10), 0.0);
        json_.key(name_of(i));
        begin("rayoptics.elem.profiles", is_toroid ? "YToroid" : odd ? "RadialPolynomial" : "EvenPolynomial");
        json_.number("cv", s.curvature);
        if (is_toroid) json_.number("cR", form.curvature_x);
        json_.number(odd ? "ec" : "cc", odd ? s.conic + 1 : s.conic).numbers("coefs", terms);
        json_.number("max_nonzero_coef", static_cast<double>(terms.size()));
        end();
    }

    void write_specification() {
        begin_part("optical_spec", "OpticalSpecs").truth("do_aiming", true);
        begin_part("spectral_region", "WvlSpec").numbers("wavelengths", {lens_.wavelength_nm});
        json_.numbers("spectral_wts", {1}).begin_array("render_colors").text("black").end();
        json_.number("reference_wvl", 0).number("coating_wvl", 550);
        end();
        begin_part("pupil", "PupilSpec");
        json_.begin_array("_key").text("aperture").text("object").text("epd").end();
        json_.number("value", entrance_pupil_diameter(".roa")).begin_array("pupil_rays");
        for (const auto& [x, y] : {Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{-1, 0}, Vec2d{0, 1}, Vec2d{0, -1}})
            json_.numbers({x, y});
        json_.end().begin_array("ray_labels");
        for (const char* label : {"00", "+X", "-X", "+Y", "-Y"}) json_.text(label);
        json_.end();
        end();
        write_fields();
        begin_part("defocus", "FocusRange").number("focus_shift", 0).number("defocus_range", 0);
        end();
        end();
    }

    void write_fields() {
        begin_part("field_of_view", "FieldSpec");
        json_.begin_array("key").text("field").text("image").text("real height").end().number("value", film_corner());
        json_.truth("is_relative", false).truth("is_wide_angle", false);
        json_.begin_array("index_labels").text("axis").text("corner").end().text("index_label_type", "auto");
        json_.begin_array("fields");
        for (const double height : {0.0, film_corner()}) {
            begin("rayoptics.raytr.opticalspec", "Field").number("x", 0).number("y", height);
            for (const char* cut : {"vux", "vuy", "vlx", "vly"}) json_.number(cut, 0);
            json_.number("wt", 1).null("aim_info");
            end();
        }
        json_.end();
        end();
    }

    JsonWriter json_;
};

}  // namespace

LensText lens_as_ray_optics(const LensSystem& lens) {
    return RayOpticsWriter(lens).write();
}

}  // namespace realcam::io
