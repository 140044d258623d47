// Reads Optiland's JSON (save_optiland_file): surface_group.surfaces, each with geometry, the material behind it,
// thickness and aperture; the first is the object, the last the image.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../lens_material.hpp"
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
        json_.set_surface(surface_ = static_cast<int>(surfaces.size()) - 1);
        const Json& image = surfaces[surfaces.size() - 1];
        frames_.push_back(frame_of(image));
        p_.image_curvature = curvature_of(image["geometry"]);
        set_places();
        json_.set_surface(surface_ = 0);
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

    /// Returns the frame of a surface. Optiland's coordinate systems have a common origin, and rotate about fixed axes:
    /// about x first, then y, then z.
    Affine<double> frame_of(const Json& surface) {
        const Json& cs = surface["geometry"]["cs"];
        if (!cs["reference_cs"].is_null()) foreign("a system of coordinates within another");
        const auto value = [&](const char* key) { return json_.number_or(cs[key], key, 0); };
        constexpr double kDegrees = 180 / std::numbers::pi;
        const auto turn = [](Vec3d tilt) { return SurfacePlacement{{}, tilt, false}.frame(); };
        const SurfacePlacement shift{{value("x"), value("y"), value("z")}, {}, false};
        return shift.frame() * turn({0, 0, kDegrees * value("rz")}) * turn({0, kDegrees * value("ry"), 0}) *
               turn({kDegrees * value("rx"), 0, 0});
    }

    void set_places() {
        // If all surfaces face along the z axis, each is decentred from its position on that axis. Otherwise the axis
        // goes from each surface to the next.
        constexpr double kSteepest = 0.5;  // cosine of 60 degrees
        const bool is_straight = std::all_of(frames_.begin(), frames_.end(),
                                             [](const Affine<double>& frame) { return frame.z.z > kSteepest; });
        const auto without_z = [](Affine<double> frame) {
            frame.origin.z = 0;
            return frame;
        };
        if (!is_straight) return set_places_one_by_one();
        for (std::size_t i = 0; i < p_.surfaces.size(); ++i) {
            PrescriptionSurface& row = p_.surfaces[i];
            row.before = without_z(frames_[i]);
            if (!(row.before == Affine<double>{})) row.behind = inverse_motion(row.before);
        }
        p_.image_placement = SurfacePlacement::of(without_z(frames_.back()));
    }

    void set_places_one_by_one() {
        Affine<double> here = along_axis(frames_.front().origin.z);
        for (std::size_t i = 0; i < p_.surfaces.size(); ++i) {
            p_.surfaces[i].before = inverse_motion(here) * frames_[i];
            const Vec3d way = frames_[i + 1].origin - frames_[i].origin;
            const double side = dot(way, frames_[i].z) < 0 ? -1 : 1;
            p_.surfaces[i].thickness = side * std::sqrt(dot(way, way));
            here = frames_[i] * along_axis(p_.surfaces[i].thickness);
        }
        // An auxiliary plane before the film, which blocks nothing, directs the axis so that the film is perpendicular
        // to it.
        PrescriptionSurface plane;
        plane.number = surface_;
        plane.blocks = true;
        plane.thickness = 0.5 * std::fabs(p_.surfaces.back().thickness);
        p_.surfaces.back().thickness *= 0.5;
        plane.clear_semi_diameter = 100 * (100 + plane.thickness);
        plane.material = p_.surfaces.back().material;
        plane.before = inverse_motion(frames_[frames_.size() - 2] * along_axis(p_.surfaces.back().thickness)) *
                       frames_.back() * along_axis(-plane.thickness);
        p_.surfaces.push_back(plane);
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
        frames_.push_back(frame_of(surface));
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

    /// Prefers the thickness stated in the file, because the difference of two positions has lost digits.
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
        if (type == "ForbesQNormalSlopeGeometry" || type == "ForbesQbfsGeometry")
            return read_forbes(geometry["surface_config"], row);
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

    void read_forbes(const Json& config, PrescriptionSurface& row) const {
        row.curvature = curvature_of(config);
        row.conic = json_.number_or(config["conic"], "the conic", 0);
        const Json& terms = config["terms"];
        ForbesTerms forbes{ForbesKind::bfs, 1, {}};
        for (int k = 0; k < kMaxForbesTerms; ++k)
            forbes.coefficients.push_back(
                json_.number_or(terms[std::to_string(k)], "the term " + std::to_string(k), 0));
        while (!forbes.coefficients.empty() && forbes.coefficients.back() == 0) forbes.coefficients.pop_back();
        if (forbes.coefficients.empty()) return;
        forbes.radius = json_.number(config["norm_radius"], "the radius of the Forbes terms");
        row.form.forbes = forbes;
    }

    /// Reads a table of coefficients: row i, column j is the term x^i y^j.
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

    /// Finds a glass. Optiland looks for a name in all of its folders, and stores the folder where it found it.
    Glass glass_named(const std::string& name, const std::string& maker) {
        if (maker.empty()) return glasses_.find(name, {});
        try {
            return glasses_.find(name, {maker});
        } catch (const UnknownGlass&) {
            const std::optional<Glass> other = glasses_.in_catalogue(name, {});
            if (!other) throw;
            p_.remarks.push_back("the catalogue of " + in_quotes(maker) + " has no glass " + in_quotes(name) +
                                 ": another maker's is taken");
            return *other;
        }
    }

    std::vector<double> list_of(const Json& list, const char* what) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < list.size() && i < kMostFileIndices; ++i)
            values.push_back(json_.number(list[i], what));
        return values;
    }

    /// Returns a glass from the data in the file: a table, or formula 2 (Sellmeier) or 5 (Cauchy) of
    /// refractiveindex.info.
    Glass data_material(const Json& material) {
        const Json& dispersion = material["definition"]["dispersion"];
        const std::string formula = dispersion["formula"].text();
        const std::vector<double> c = list_of(dispersion["coefficients"], "a coefficient");
        Glass glass = Glass::air();
        if (dispersion["kind"].text() == "tabulated") {
            const std::vector<double> waves = list_of(dispersion["wavelengths_um"], "a wavelength"),
                                      indices = list_of(dispersion["indices"], "an index");
            if (waves.size() != indices.size()) throw InputError("its table needs as many indices as wavelengths");
            std::vector<Glass::TablePoint> points;
            for (std::size_t i = 0; i < waves.size(); ++i) points.push_back({1000 * waves[i], indices[i]});
            glass = Glass::table(std::move(points));
        } else if (formula == "formula 2" && c.size() % 2 == 1 && c.size() >= 3) {
            std::vector<Glass::SellmeierTerm> terms;
            if (c[0] != 0) terms.push_back({c[0], 0});
            for (std::size_t i = 1; i < c.size(); i += 2) terms.push_back({c[i], c[i + 1]});
            glass = Glass::sellmeier(terms);
        } else if (formula == "formula 5" && c.size() % 2 == 1) {
            std::vector<double> cauchy{c[0]};
            for (std::size_t i = 1; i < c.size(); i += 2) {
                const double term = -0.5 * c[i + 1];
                if (!(term >= 1 && term <= 20 && term == std::floor(term)))
                    throw InputError("its formula 5 has the power " + number_label(c[i + 1]) +
                                     "; -2, -4, ... are wanted");
                cauchy.resize(std::max(cauchy.size(), static_cast<std::size_t>(term) + 1), 0.0);
                cauchy[static_cast<std::size_t>(term)] += c[i];
            }
            glass = Glass::cauchy(cauchy);
        } else {
            throw InputError("its dispersion is " + in_quotes(printable(formula).substr(0, 40)) +
                             "; a table, formula 2 or formula 5 is wanted");
        }
        glass.label = printable(material["name"].text()).substr(0, 100);
        return glass;
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
            if (type == "DataMaterial") return data_material(material);
            if (type == "Material") {
                // The glass's file is in the folder of its maker, or in that of another substance.
                std::string maker = material["reference"].text();
                const std::string& path = material["filename"].text();
                const std::size_t slash = path.find_last_of("/\\");
                if (slash != path.npos && slash > 0) {
                    const std::size_t folder = path.find_last_of("/\\", slash - 1);
                    maker = path.substr(folder == path.npos ? 0 : folder + 1,
                                        slash - (folder == path.npos ? 0 : folder + 1));
                    if (path.find("/main/") != path.npos) {
                        const std::string page = path.substr(slash + 1, path.find_last_of('.') - slash - 1);
                        return glasses_.substance(printable(maker), printable(page), p_.remarks);
                    }
                    for (const char* shelf : {"/organic/", "/other/", "/3d/"})
                        if (path.find(shelf) != path.npos) maker = "misc";
                }
                return glass_named(material["name"].text(), maker);
            }
        } catch (const InputError& error) {
            json_.fail(error);
        }
        json_.fail("its material is of the type " + in_quotes(type) +
                   "; IdealMaterial, AbbeMaterial or Material is wanted");
    }

    void read_rim(const Json& aperture, PrescriptionSurface& row) {
        if (aperture.is_null()) return;
        row.blocks = true;
        read_outline(aperture, row, 0);
        if (const double reach = row.aperture_shape.reach(); reach > 0)
            row.clear_semi_diameter = row.clear_semi_diameter > 0 ? std::min(row.clear_semi_diameter, reach) : reach;
        row.is_open_outside = row.inner_semi_diameter > 0 && row.clear_semi_diameter == 0;
    }

    /// Reads an aperture: a shape, an intersection of two, or a difference of two.
    void read_outline(const Json& aperture, PrescriptionSurface& row, int depth) {
        const std::string type = aperture["type"].text();
        const auto value = [&](const char* key) { return json_.number(aperture[key], key); };
        ApertureShape& shape = row.aperture_shape;
        const bool has_shape = shape.half.x > 0 || shape.kind == ApertureOutline::polygon;
        if (type == "RadialAperture") {
            const Json& outer = aperture["r_max"];
            if (!(outer.is_number() && std::isinf(outer.number(0)))) row.clear_semi_diameter = value("r_max");
            row.inner_semi_diameter = json_.number_or(aperture["r_min"], "r_min", 0);
        } else if (type == "IntersectionAperture" && depth < kMaxObscurations) {
            read_outline(aperture["a"], row, depth + 1);
            read_outline(aperture["b"], row, depth + 1);
        } else if (type == "DifferenceAperture" && depth < kMaxObscurations) {
            read_outline(aperture["a"], row, depth + 1);
            read_piece(aperture["b"], shape);
        } else if (has_shape) {
            foreign("several apertures that are no circles");
        } else if (type == "EllipticalAperture") {
            shape.kind = ApertureOutline::ellipse;
            shape.half = {value("a"), value("b")};
            if (shape.half.x == shape.half.y) shape.kind = ApertureOutline::circle;
            shape.offset = {value("offset_x"), value("offset_y")};
        } else if (type == "OffsetRadialAperture" && value("r_min") == 0) {
            shape.half = {value("r_max"), value("r_max")};
            shape.offset = {value("offset_x"), value("offset_y")};
        } else if (type == "RectangularAperture") {
            shape.kind = ApertureOutline::rectangle;
            read_rectangle(aperture, shape.half, shape.offset);
        } else if (type == "PolygonAperture") {
            shape.kind = ApertureOutline::polygon;
            shape.corners = corners_of(aperture);
        } else {
            foreign("an aperture that is no circle (" + printable(type).substr(0, 40) + ")");
        }
    }

    void read_rectangle(const Json& aperture, Vec2d& half, Vec2d& offset) const {
        const auto value = [&](const char* key) { return json_.number(aperture[key], key); };
        const double x0 = value("x_min"), x1 = value("x_max"), y0 = value("y_min"), y1 = value("y_max");
        half = {0.5 * (x1 - x0), 0.5 * (y1 - y0)};
        offset = {0.5 * (x0 + x1), 0.5 * (y0 + y1)};
    }

    std::vector<Vec2d> corners_of(const Json& aperture) const {
        const Json &x = aperture["x"], &y = aperture["y"];
        if (x.size() != y.size()) json_.fail("a polygon needs as many x as y");
        std::vector<Vec2d> corners;
        for (std::size_t i = 0; i < x.size() && i <= kMaxApertureCorners; ++i)
            corners.push_back({json_.number(x[i], "x of a corner"), json_.number(y[i], "y of a corner")});
        return corners;
    }

    void read_piece(const Json& aperture, ApertureShape& shape) {
        const std::string type = aperture["type"].text();
        const auto value = [&](const char* key) { return json_.number(aperture[key], key); };
        Obscuration piece;
        if (type == "EllipticalAperture") {
            piece.half = {value("a"), value("b")};
            piece.offset = {value("offset_x"), value("offset_y")};
        } else if (type == "RectangularAperture") {
            piece.is_rectangle = true;
            read_rectangle(aperture, piece.half, piece.offset);
        } else if (type == "PolygonAperture" && set_rectangle(corners_of(aperture), piece)) {
            piece.is_rectangle = true;
        } else {
            return foreign("an obscuration that is no ellipse or rectangle (" + printable(type).substr(0, 40) + ")");
        }
        shape.obscurations.push_back(piece);
    }

    /// Returns false if the corners are not those of a rectangle.
    static bool set_rectangle(const std::vector<Vec2d>& corners, Obscuration& piece) {
        if (corners.size() != 4) return false;
        const auto between = [&](std::size_t a, std::size_t b) {
            return Vec2d{corners[b].x - corners[a].x, corners[b].y - corners[a].y};
        };
        const Vec2d one = between(1, 0), other = between(3, 0), same = between(2, 3);
        const double length = hypotenuse(one.x, one.y), width = hypotenuse(other.x, other.y);
        const double rounding = 1e-9 * (length + width);
        if (!(std::fabs(one.x * other.x + one.y * other.y) <= rounding * (length + width)) ||
            !(std::fabs(one.x - same.x) + std::fabs(one.y - same.y) <= rounding))
            return false;
        piece.half = {0.5 * length, 0.5 * width};
        piece.offset = {0.5 * (corners[0].x + corners[2].x), 0.5 * (corners[0].y + corners[2].y)};
        piece.angle_deg = std::atan2(one.y, one.x) * 180 / std::numbers::pi;
        return true;
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
        if (found->second == ApertureKind::stop_size) p_.aperture *= 0.5;  // Optiland has the diameter
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
            const std::string unit = list[i]["unit"].text();
            const double scale = unit == "nm" ? 1 : unit == "um" || unit.empty() ? 1000 : unit == "mm" ? 1e6 : 0;
            if (scale == 0) json_.fail("the wavelength's unit is " + in_quotes(unit) + "; nm or um is wanted");
            p_.wavelengths_nm.push_back(scale * json_.number(list[i]["value"], "the wavelength"));
            if (i == 0 || list[i]["is_primary"].is_true()) p_.wavelength_nm = p_.wavelengths_nm.back();
        }
    }

    LensJson json_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<Affine<double>> frames_;  ///< frames of the surfaces and of the image, in a common frame
    int surface_ = 0;
};

}  // namespace

Prescription read_optiland(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Reader(text, file, glasses).read();
}

}  // namespace realcam::io
