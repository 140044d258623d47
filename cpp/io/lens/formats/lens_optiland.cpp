// Optiland's JSON (save_optiland_file): surface_group.surfaces, each with geometry, material behind it, thickness and
// aperture; the first is the object, the last the image.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "../../text/printable.hpp"
#include "../lens_readers.hpp"
#include "../lens_text.hpp"
#include "lens_json.hpp"

namespace realcam::io {
namespace {

class Reader {
public:
    Reader(std::string_view text, const std::string& file, LensGlasses& glasses)
        : json_(text, file, glasses.options().keep_going), glasses_(glasses) {
        p_.file = file;
        p_.format = "Optiland";
    }

    Prescription read() {
        const Json& root = json_.root();
        const Json& surfaces = root["surface_group"]["surfaces"];
        if (surfaces.size() < 3)
            json_.fail("is no lens of Optiland: surface_group.surfaces with an object, a lens and an image is wanted");
        if (surfaces.size() > kMostFileSurfaces)
            json_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
        p_.title = root["name"].text();
        const double first = json_.number(surfaces[1]["geometry"]["cs"]["z"], "z of the first surface");
        read_object(surfaces[std::size_t{0}], first);
        for (std::size_t i = 1; i + 1 < surfaces.size(); ++i) read_surface(surfaces[i], surfaces[i + 1], i);
        json_.set_surface(static_cast<int>(surfaces.size()) - 1);
        const Json& image = surfaces[surfaces.size() - 1];
        check_place(image, "image");
        p_.image_curvature = curvature_of(image["geometry"]);
        json_.set_surface(0);
        read_aperture(root["aperture"]);
        read_fields(root["fields"]);
        read_wavelengths(root["wavelengths"]["wavelengths"]);
        for (const char* part : {"pickups"})
            if (root[part].size() > 0)
                p_.remarks.push_back("the values in the file are taken for those of its pickups");
        if (root["solves"]["solves"].size() > 0)
            p_.remarks.push_back("the values in the file are taken for those of its solves");
        return std::move(p_);
    }

private:
    void foreign(const std::string& what) { p_.foreign.push_back({what, 0, surface_}); }

    double curvature_of(const Json& geometry) const {
        const Json& radius = geometry["radius"];
        if (radius.is_null() || (radius.is_number() && std::isinf(radius.number(0)))) return 0;
        const double value = json_.number(radius, "the radius");
        return value == 0 ? 0 : 1 / value;
    }

    /// Its systems of coordinates count from one origin, and turn about fixed axes: about x first, then y, then z. Here
    /// each surface alone is moved from its place on the z axis.
    void read_place(const Json& surface, PrescriptionSurface& row) {
        const Json& cs = surface["geometry"]["cs"];
        if (!cs["reference_cs"].is_null()) return foreign("a system of coordinates within another");
        const auto value = [&](const char* key) { return json_.number_or(cs[key], key, 0); };
        constexpr double kDegrees = 180 / std::numbers::pi;
        const auto turn = [](Vec3d tilt) { return SurfacePlacement{{}, tilt, false}.frame(); };
        const SurfacePlacement shift{{value("x"), value("y"), 0}, {}, false};
        row.before = shift.frame() * turn({0, 0, kDegrees * value("rz")}) * turn({0, kDegrees * value("ry"), 0}) *
                     turn({kDegrees * value("rx"), 0, 0});
        if (!(row.before == Affine<double>{})) row.behind = inverse_motion(row.before);
    }

    /// Tilts and decentres of a coordinate system.
    void check_place(const Json& surface, const std::string& what) {
        const Json& cs = surface["geometry"]["cs"];
        for (const char* key : {"x", "y", "rx", "ry", "rz"})
            if (json_.number_or(cs[key], key, 0) != 0 || !cs["reference_cs"].is_null())
                return foreign("a tilt or decentre of the " + what);
    }

    void read_object(const Json& object, double first) {
        const Json& z = object["geometry"]["cs"]["z"];
        if (z.is_number() && std::isinf(z.number(0))) return;
        p_.object_distance = first - json_.number(z, "z of the object");
        if (p_.object_distance >= kLongest) p_.object_distance = kInfinity;
        if (curvature_of(object["geometry"]) != 0) foreign("a curved object");
    }

    void read_surface(const Json& surface, const Json& next, std::size_t number) {
        surface_ = static_cast<int>(number);
        json_.set_surface(surface_);
        PrescriptionSurface row;
        row.number = surface_;
        row.is_stop = surface["is_stop"].is_true();
        read_place(surface, row);
        const auto z = [&](const Json& s) { return json_.number(s["geometry"]["cs"]["z"], "z of the surface"); };
        row.thickness = z(next) - z(surface);
        read_thickness(surface["thickness"], row);
        read_geometry(surface["geometry"], row);
        const Json& interaction = surface["interaction_model"];
        const std::string type = interaction["type"].text();
        row.is_mirror = interaction["is_reflective"].is_true() || surface["is_reflective"].is_true();
        if (!type.empty() && type != "RefractiveReflectiveModel")
            foreign("a surface of the interaction model " + printable(type).substr(0, 40));
        if (!interaction["coating"].is_null())
            p_.remarks.push_back("the coating of surface " + std::to_string(surface_) + " is left out");
        if (!row.is_mirror) row.material = material_of(surface["material_post"]);
        read_rim(surface["aperture"], row);
        p_.surfaces.push_back(std::move(row));
    }

    /// The difference of two places has lost digits of the thickness that the file says itself.
    void read_thickness(const Json& thickness, PrescriptionSurface& row) const {
        if (!thickness.is_number()) return;
        const double stated = json_.number(thickness, "the thickness");
        if (std::fabs(stated - row.thickness) <= 1e-9 * (1 + std::fabs(stated))) row.thickness = stated;
    }

    void read_geometry(const Json& geometry, PrescriptionSurface& row) {
        const std::string type = geometry["type"].text();
        row.curvature = curvature_of(geometry);
        row.conic = json_.number_or(geometry["conic"], "the conic", 0);
        const bool even = type == "EvenAsphere", odd = type == "OddAsphere";
        if (type == "ToroidalGeometry") return read_toroid(geometry, row);
        if (type == "PolynomialGeometry") return read_xy_terms(geometry["coefficients"], row);
        if (type == "ZernikePolynomialGeometry") return read_zernike_terms(geometry, row);
        if (!even && !odd && type != "StandardGeometry" && type != "Plane")
            foreign("a surface of type " + printable(type).substr(0, 40));
        if (!even && !odd) return;
        const Json& list = geometry["coefficients"];
        for (std::size_t i = 0; i < list.size() && i < 100; ++i) {
            const double value = json_.number(list[i], "an aspheric coefficient");
            const int power = (even ? 2 : 1) * (static_cast<int>(i) + 1);
            if (value != 0) row.aspheric[power] = value;
        }
    }

    void read_toroid(const Json& geometry, PrescriptionSurface& row) const {
        const auto curvature = [&](const char* key) {
            const Json& radius = geometry[key];
            return radius.is_number() && std::isinf(radius.number(0)) ? 0.0 : 1 / json_.number(radius, key);
        };
        row.form.base = BaseForm::toroid;
        row.curvature = curvature("radius_y");
        row.form.curvature_x = curvature("radius_x");
        row.conic = json_.number_or(geometry["conic_yz"], "conic_yz", 0);
        const Json& list = geometry["coeffs_poly_y"];
        for (std::size_t i = 0; i < list.size() && i < 100; ++i)
            if (const double value = json_.number(list[i], "a coefficient of y"); value != 0)
                row.aspheric[2 * (static_cast<int>(i) + 1)] = value;
    }

    /// A table whose row is the power of x, and its column that of y.
    void read_xy_terms(const Json& table, PrescriptionSurface& row) {
        for (std::size_t i = 0; i < table.size() && i < 100; ++i)
            for (std::size_t j = 0; j < table[i].size() && j < 100; ++j) {
                const double value = json_.number(table[i][j], "a coefficient of x and y");
                if (value != 0) row.form.xy.push_back({static_cast<int>(i), static_cast<int>(j), value});
            }
    }

    void read_zernike_terms(const Json& geometry, PrescriptionSurface& row) {
        const std::string order = geometry["zernike_type"].text();
        if (order != "noll" && order != "fringe")
            return foreign("Zernike terms of the order " + in_quotes(printable(order).substr(0, 20)));
        ZernikeTerms terms{order == "noll" ? ZernikeOrder::noll : ZernikeOrder::fringe,
                           json_.number(geometry["norm_radius"], "the radius of the Zernike terms"),
                           {}};
        const Json& list = geometry["coefficients"];
        for (std::size_t i = 0; i < list.size() && i < 300; ++i)
            terms.coefficients.push_back(json_.number(list[i], "a Zernike coefficient"));
        while (!terms.coefficients.empty() && terms.coefficients.back() == 0) terms.coefficients.pop_back();
        if (!terms.coefficients.empty()) row.form.zernike = terms;
    }

    Glass material_of(const Json& material) {
        const std::string type = material["type"].text();
        if (json_.number_or(material["absorp"], "the absorption", 0) != 0)
            p_.remarks.push_back("absorption in the glass is left out");
        try {
            if (type == "IdealMaterial") {
                const Json& index = material["index"];
                return glass_of_pair(json_.number(index.size() > 0 ? index[std::size_t{0}] : index, "the index"), 0);
            }
            if (type == "AbbeMaterial" || type == "AbbeMaterialE") {
                const Json &index = material["index"], &abbe = material["abbe"];
                const auto first = [](const Json& v) -> const Json& { return v.size() > 0 ? v[std::size_t{0}] : v; };
                if (type == "AbbeMaterialE") foreign("a glass by its Abbe number at the e line");
                return glass_of_pair(json_.number(first(index), "the index"),
                                     json_.number(first(abbe), "the Abbe number"));
            }
            if (type == "Material") {
                // The file of the glass lies in the folder of its maker, or of what is no glass.
                std::string maker = material["reference"].text();
                const std::string& path = material["filename"].text();
                const std::size_t slash = path.find_last_of("/\\");
                if (slash != path.npos && slash > 0) {
                    const std::size_t folder = path.find_last_of("/\\", slash - 1);
                    maker = path.substr(folder == path.npos ? 0 : folder + 1,
                                        slash - (folder == path.npos ? 0 : folder + 1));
                    for (const char* shelf : {"/main/", "/organic/", "/other/", "/3d/"})
                        if (path.find(shelf) != path.npos) maker = "misc";
                }
                return glasses_.find(material["name"].text(),
                                     maker.empty() ? std::vector<std::string>{} : std::vector{maker});
            }
        } catch (const InputError& error) {
            json_.fail(error);
        }
        json_.fail("its material is of the type " + in_quotes(type) +
                   "; IdealMaterial, AbbeMaterial or Material is wanted");
    }

    void read_rim(const Json& aperture, PrescriptionSurface& row) {
        if (aperture.is_null()) return;
        const std::string type = aperture["type"].text();
        if (type == "EllipticalAperture" || type == "RectangularAperture") return read_shaped(type, aperture, row);
        if (type != "RadialAperture")
            return foreign("an aperture that is no circle (" + printable(type).substr(0, 40) + ")");
        const Json& outer = aperture["r_max"];
        if (!(outer.is_number() && std::isinf(outer.number(0)))) row.clear_semi_diameter = json_.number(outer, "r_max");
        row.inner_semi_diameter = json_.number_or(aperture["r_min"], "r_min", 0);
        row.blocks = true;
        row.is_open_outside = row.inner_semi_diameter > 0 && row.clear_semi_diameter == 0;
    }

    void read_shaped(const std::string& type, const Json& aperture, PrescriptionSurface& row) const {
        const auto value = [&](const char* key) { return json_.number(aperture[key], key); };
        ApertureShape& shape = row.aperture_shape;
        if (type == "EllipticalAperture") {
            shape.kind = ApertureOutline::ellipse;
            shape.half = {value("a"), value("b")};
            shape.offset = {value("offset_x"), value("offset_y")};
        } else {
            shape.kind = ApertureOutline::rectangle;
            const double x0 = value("x_min"), x1 = value("x_max"), y0 = value("y_min"), y1 = value("y_max");
            shape.half = {0.5 * (x1 - x0), 0.5 * (y1 - y0)};
            shape.offset = {0.5 * (x0 + x1), 0.5 * (y0 + y1)};
        }
        row.clear_semi_diameter = shape.reach();
        row.blocks = true;
    }

    void read_aperture(const Json& aperture) {
        static const std::map<std::string, ApertureKind> kinds{{"EPD", ApertureKind::entrance_pupil_diameter},
                                                               {"imageFNO", ApertureKind::f_number},
                                                               {"paraxialImageFNO", ApertureKind::working_f_number},
                                                               {"objectNA", ApertureKind::object_aperture},
                                                               {"float_by_stop_size", ApertureKind::stop_size}};
        const std::string type = aperture["type"].text();
        const auto found = kinds.find(type);
        if (found == kinds.end()) json_.fail("the aperture is of the type " + in_quotes(type) + ", which is not known");
        p_.aperture_kind = found->second;
        p_.aperture = json_.number(aperture["value"], "the value of the aperture");
        if (found->second == ApertureKind::stop_size) p_.aperture *= 0.5;  // Optiland gives the diameter
    }

    void read_fields(const Json& fields) {
        std::string type = fields["field_definition"]["field_type"].text();
        if (type.empty()) type = fields["field_type"].text();
        const bool angle = type == "AngleField" || type == "angle";
        const bool object = type == "ObjectHeightField" || type == "object_height";
        const bool image = type.find("ImageHeight") != type.npos || type.find("image_height") != type.npos;
        if (!angle && !object && !image) {
            p_.remarks.push_back("its fields are of a kind that is not known");
            return;
        }
        p_.field_kind = angle ? FieldKind::angle_deg : object ? FieldKind::object_height : FieldKind::image_height;
        const Json& list = fields["fields"];
        for (std::size_t i = 0; i < list.size() && i < 1000; ++i) {
            const auto value = [&](const char* key) { return json_.number_or(list[i][key], "a field", 0); };
            const auto cut = [&](const char* key) { return std::clamp(value(key), 0.0, 0.999); };
            p_.fields.push_back({value("x"), value("y"), cut("vx"), cut("vx"), cut("vy"), cut("vy")});
        }
    }

    void read_wavelengths(const Json& list) {
        if (list.size() == 0) {
            p_.remarks.push_back("it states no wavelength: that of the d line is taken");
            return;
        }
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (i > 0 && !list[i]["is_primary"].is_true()) continue;
            const std::string unit = list[i]["unit"].text();
            const double scale = unit == "nm" ? 1 : unit == "um" || unit.empty() ? 1000 : unit == "mm" ? 1e6 : 0;
            if (scale == 0) json_.fail("the wavelength's unit is " + in_quotes(unit) + "; nm or um is wanted");
            p_.wavelength_nm = scale * json_.number(list[i]["value"], "the wavelength");
        }
    }

    LensJson json_;
    LensGlasses& glasses_;
    Prescription p_;
    int surface_ = 0;
};

}  // namespace

Prescription read_optiland(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Reader(text, file, glasses).read();
}

}  // namespace realcam::io
