// Reader of Optiland's JSON files (save_optiland_file). The elements of surface_group.surfaces have geometry, material
// behind the surface, thickness and aperture; the first one is the object, and the last one is the image. Lengths in
// mm.

#include <cmath>
#include <filesystem>
#include <numbers>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/prescription/lens_limits.hpp"
#include "../../text/printable.hpp"
#include "../lens_format.hpp"
#include "../lens_material.hpp"
#include "prescription_json.hpp"

namespace realcam::io {
namespace {

/// Converts the file's objects one after the other; placements are set when all frames are known.
class OptilandReader : PrescriptionJson {
public:
    using PrescriptionJson::PrescriptionJson;

    Prescription read() {
        const Json& surfaces = root_["surface_group"]["surfaces"];
        check_count(surfaces.size(), "surface_group.surfaces of Optiland");
        p_.title = root_["name"].text();
        read_object(surfaces[std::size_t{0}], number(z_of(surfaces[1]), "z of the first surface"));
        for (std::size_t i = 1; i + 1 < surfaces.size(); ++i) read_surface(surfaces[i], surfaces[i + 1]);
        const Json& image = surfaces[surfaces.size() - 1];
        ++surface_;
        frames_.push_back(frame_of(image));
        p_.image_curvature = curvature_of_geometry(image["geometry"]);
        set_placements();
        surface_ = 0;
        read_aperture(root_["aperture"]);
        read_fields(root_["fields"]);
        read_wavelengths(root_["wavelengths"]["wavelengths"]);
        if (root_["pickups"].size() > 0) remark("the values in the file are used for its pickups");
        if (root_["solves"]["solves"].size() > 0) remark("the values in the file are used for its solves");
        return std::move(p_);
    }

private:
    /// Position of a surface along the z axis, mm.
    static const Json& z_of(const Json& surface) { return surface["geometry"]["cs"]["z"]; }

    // Return curvatures in 1/mm; 0 for an infinite or missing radius. `name`: noun phrase for messages.
    double curvature_of_radius(const Json& radius, const char* name) const {
        return is_infinite(radius) ? 0 : curvature_of(number(radius, name));
    }
    double curvature_of_geometry(const Json& geometry) const {
        return geometry["radius"].is_null() ? 0 : curvature_of_radius(geometry["radius"], "the radius");
    }

    /// Returns the frame of a surface. Optiland's coordinate systems have a common origin, and rotate about fixed axes:
    /// about x first, then y, then z.
    Affine<double> frame_of(const Json& surface) {
        const Json& cs = surface["geometry"]["cs"];
        if (!cs["reference_cs"].is_null()) unsupported("a coordinate system within another");
        const auto value = [&](const char* key) { return number_or(cs[key], key, 0); };
        const auto degrees = [&](const char* key) { return 180 / std::numbers::pi * value(key); };
        return SurfacePlacement{{value("x"), value("y"), value("z")}, {}, false}.frame() *
               rotation(0, 0, degrees("rz")) * rotation(0, degrees("ry"), 0) * rotation(degrees("rx"), 0, 0);
    }

    /// Sets the transforms of all rows from the frames of their surfaces.
    void set_placements() {
        // If all surfaces face along the z axis, each is decentred from its position on that axis. Otherwise the axis
        // goes from each surface to the next.
        constexpr double kMinCosine = 0.5;  // of the angle to the z axis: 60 degrees
        if (!std::ranges::all_of(frames_, [](const Affine<double>& frame) { return frame.z.z > kMinCosine; }))
            return set_placements_in_sequence();
        const auto without_z = [](Affine<double> frame) {
            frame.origin.z = 0;
            return frame;
        };
        for (std::size_t i = 0; i < p_.surfaces.size(); ++i) {
            PrescriptionSurface& row = p_.surfaces[i];
            row.before = without_z(frames_[i]);
            if (!(row.before == Affine<double>{})) row.behind = inverse_motion(row.before);
        }
        p_.image_placement = SurfacePlacement::from_frame(without_z(frames_.back()));
    }

    /// Sets the transforms and thicknesses so that the axis leads from each vertex to the next.
    void set_placements_in_sequence() {
        Affine<double> axis = along_axis(frames_.front().origin.z);
        for (std::size_t i = 0; i < p_.surfaces.size(); ++i) {
            p_.surfaces[i].before = inverse_motion(axis) * frames_[i];
            const Vec3d offset = frames_[i + 1].origin - frames_[i].origin;
            const double side = dot(offset, frames_[i].z) < 0 ? -1 : 1;
            p_.surfaces[i].thickness = side * std::sqrt(dot(offset, offset));
            axis = frames_[i] * along_axis(p_.surfaces[i].thickness);
        }
        // An auxiliary plane before the film, which blocks nothing, directs the axis so that the film is perpendicular
        // to it.
        PrescriptionSurface& last = p_.surfaces.back();
        PrescriptionSurface plane;
        plane.number = surface_;
        plane.has_aperture = true;
        plane.thickness = 0.5 * std::fabs(last.thickness);
        last.thickness *= 0.5;
        constexpr double kUnlimited = 100;  // times the distance to the film, and 100 mm
        plane.clear_semi_diameter = kUnlimited * (100 + plane.thickness);
        plane.material = last.material;
        plane.before = inverse_motion(frames_[frames_.size() - 2] * along_axis(last.thickness)) * frames_.back() *
                       along_axis(-plane.thickness);
        p_.surfaces.push_back(plane);
    }

    /// Sets the object distance. `first_surface_z`: z of the first surface.
    void read_object(const Json& object, double first_surface_z) {
        if (!is_infinite(z_of(object)))
            set_object(first_surface_z - number(z_of(object), "z of the object"),
                       curvature_of_geometry(object["geometry"]), 0);
    }

    /// Adds the row of a surface. `next`: the surface behind it.
    void read_surface(const Json& surface, const Json& next) {
        PrescriptionSurface row;
        row.number = ++surface_;
        row.is_stop = surface["is_stop"].is_true();
        frames_.push_back(frame_of(surface));
        row.thickness = number(z_of(next), "z of the surface") - number(z_of(surface), "z of the surface");
        // The thickness stated in the file is preferred, because the difference of two positions has lost digits.
        if (surface["thickness"].is_number()) {
            const double file_thickness = number(surface["thickness"], "the thickness");
            if (std::fabs(file_thickness - row.thickness) <= 1e-9 * (1 + std::fabs(file_thickness)))
                row.thickness = file_thickness;
        }
        read_geometry(surface["geometry"], row);
        const Json& interaction = surface["interaction_model"];
        const std::string& type = interaction["type"].text();
        row.is_mirror = interaction["is_reflective"].is_true() || surface["is_reflective"].is_true();
        if (!type.empty() && type != "RefractiveReflectiveModel")
            unsupported("a surface of the interaction model " + printable_name(type));
        if (!interaction["coating"].is_null())
            remark("the coating of surface " + std::to_string(surface_) + " is left out");
        if (!row.is_mirror) row.material = material_of(surface["material_post"]);
        if (const Json& aperture = surface["aperture"]; !aperture.is_null()) {
            row.has_aperture = true;
            read_outline(aperture, row, 0);
            limit_to_outline(row);
            row.is_open_outside = row.inner_semi_diameter > 0 && row.clear_semi_diameter == 0;
        }
        p_.surfaces.push_back(std::move(row));
    }

    /// Sets the shape of a row by the type of its geometry.
    void read_geometry(const Json& geometry, PrescriptionSurface& row) {
        const std::string& type = geometry["type"].text();
        const Json& coefficients = geometry["coefficients"];
        row.curvature = curvature_of_geometry(geometry);
        row.conic = number_or(geometry["conic"], "the conic", 0);
        if (type == "ToroidalGeometry") {
            row.form.base = BaseForm::toroid;
            row.curvature = curvature_of_radius(geometry["radius_y"], "radius_y");
            row.form.curvature_x = curvature_of_radius(geometry["radius_x"], "radius_x");
            row.conic = number_or(geometry["conic_yz"], "conic_yz", 0);
            add_terms(geometry["coeffs_poly_y"], 2, "a coefficient of y", row);
        } else if (type == "ForbesQNormalSlopeGeometry" || type == "ForbesQbfsGeometry") {
            read_forbes(geometry["surface_config"], row);
        } else if (type == "PolynomialGeometry") {  // row i, column j is the term x^i y^j
            for (std::size_t i = 0; i < coefficients.size() && i < 100; ++i) {
                int j = 0;
                for (const double value : numbers(coefficients[i], "a coefficient of x and y", 100)) {
                    if (value != 0) row.form.xy.push_back({static_cast<int>(i), j, value});
                    ++j;
                }
            }
        } else if (type == "ZernikePolynomialGeometry") {
            const std::string& order = geometry["zernike_type"].text();
            if (order != "noll" && order != "fringe")
                return unsupported("Zernike terms of the order " + in_quotes(printable_name(order, 20)));
            set_zernike(row, order == "noll" ? ZernikeOrder::noll : ZernikeOrder::fringe,
                        number(geometry["norm_radius"], "the radius of the Zernike terms"),
                        numbers(coefficients, "a Zernike coefficient", 300));
        } else if (type == "EvenAsphere" || type == "OddAsphere") {
            add_terms(coefficients, type == "EvenAsphere" ? 2 : 1, "an aspheric coefficient", row);
        } else if (type != "StandardGeometry" && type != "Plane") {
            unsupported("a surface of type " + printable_name(type));
        }
    }

    /// Sets a Forbes surface with its departure from the best-fit sphere.
    void read_forbes(const Json& config, PrescriptionSurface& row) const {
        row.curvature = curvature_of_geometry(config);
        row.conic = number_or(config["conic"], "the conic", 0);
        ForbesTerms forbes{ForbesKind::bfs, 1, {}};
        for (int k = 0; k < kMaxForbesTerms; ++k) {
            const std::string name = std::to_string(k);
            forbes.coefficients.push_back(number_or(config["terms"][name], "the term " + name, 0));
        }
        while (!forbes.coefficients.empty() && forbes.coefficients.back() == 0) forbes.coefficients.pop_back();
        if (forbes.coefficients.empty()) return;
        forbes.radius = number(config["norm_radius"], "the radius of the Forbes terms");
        row.form.forbes = forbes;
    }

    /// Returns the medium behind a surface.
    Glass material_of(const Json& material) {
        const std::string& type = material["type"].text();
        const auto value = [&](const char* key, const char* what) {
            const Json& member = material[key];
            return number(member.size() > 0 ? member[std::size_t{0}] : member, what);
        };
        if (number_or(material["absorp"], "the absorption", 0) != 0) remark("absorption in the glass is left out");
        if (type == "AbbeMaterialE") unsupported("a glass specified by its Abbe number at the e line");
        try {
            if (type == "IdealMaterial") return glass_of_pair(value("index", "the index"), 0);
            if (type == "AbbeMaterial" || type == "AbbeMaterialE")
                return glass_of_pair(value("index", "the index"), value("abbe", "the Abbe number"));
            if (type == "DataMaterial") return data_material(material);
            if (type == "Material") return catalogue_material(material);
        } catch (const InputError& error) {
            fail(error);
        }
        fail("its material is of the type " + in_quotes(type) + "; expected IdealMaterial, AbbeMaterial or Material");
    }

    /// Returns the glass of a name. Optiland searches a name in all folders of its data base, and stores the file that
    /// it found, whose folder is named after the glass's maker or a substance.
    Glass catalogue_material(const Json& material) {
        const std::string &name = material["name"].text(), &file = material["filename"].text();
        std::string path = file, maker = material["reference"].text();
        std::ranges::replace(path, '\\', '/');
        const std::filesystem::path parts(path);
        if (const std::string folder = parts.parent_path().filename().string(); !folder.empty()) {
            maker = folder;
            if (file.find("/main/") != file.npos)
                return glasses_.substance(printable(maker), printable(parts.stem().string()), p_.remarks);
            for (const char* shelf : {"/organic/", "/other/", "/3d/"})
                if (file.find(shelf) != file.npos) maker = "misc";
        }
        if (maker.empty()) return glasses_.find(name, {});
        try {
            return glasses_.find(name, {maker});
        } catch (const UnknownGlass&) {
            const std::optional<Glass> other = glasses_.in_catalogue(name, {});
            if (!other) throw;
            remark("the catalogue of " + in_quotes(maker) + " has no glass " + in_quotes(name) +
                   ": that of another maker is used");
            return *other;
        }
    }

    /// Returns a glass from the data in the file: a table, or formula 2 (Sellmeier) or 5 (Cauchy) of
    /// refractiveindex.info.
    Glass data_material(const Json& material) const {
        const Json& dispersion = material["definition"]["dispersion"];
        const std::string& formula = dispersion["formula"].text();
        const std::string label = printable_name(material["name"].text(), 100);
        const std::vector<double> c = numbers(dispersion["coefficients"], "a coefficient");
        const auto labelled = [&](Glass glass) {
            glass.label = label;
            return glass;
        };
        if (dispersion["kind"].text() == "tabulated") {
            std::vector<double> waves = numbers(dispersion["wavelengths_um"], "a wavelength");
            const std::vector<double> indices = numbers(dispersion["indices"], "an index");
            if (waves.size() != indices.size()) throw InputError("its table needs as many indices as wavelengths");
            for (double& wave : waves) wave *= 1000;
            return glass_of_indices(waves, indices, label);
        }
        if (formula == "formula 2" && c.size() % 2 == 1 && c.size() >= 3) {
            std::vector<Glass::SellmeierTerm> terms;
            if (c[0] != 0) terms.push_back({c[0], 0});
            for (std::size_t i = 1; i < c.size(); i += 2) terms.push_back({c[i], c[i + 1]});
            return labelled(Glass::sellmeier(terms));
        }
        if (formula != "formula 5" || c.size() % 2 != 1)
            throw InputError("its dispersion is " + in_quotes(printable_name(formula)) +
                             "; expected a table, formula 2 or formula 5");
        std::vector<double> cauchy{c[0]};
        for (std::size_t i = 1; i < c.size(); i += 2) {
            const double term = -0.5 * c[i + 1];
            if (!(term >= 1 && term <= 20 && term == std::floor(term)))
                throw InputError("its formula 5 has the power " + number_label(c[i + 1]) + "; expected -2, -4, ...");
            cauchy.resize(std::max(cauchy.size(), static_cast<std::size_t>(term) + 1), 0.0);
            cauchy[static_cast<std::size_t>(term)] += c[i];
        }
        return labelled(Glass::cauchy(cauchy));
    }

    /// Reads an aperture: a shape, or the intersection or difference of two apertures. `depth`: of the nesting.
    void read_outline(const Json& aperture, PrescriptionSurface& row, int depth) {
        const std::string& type = aperture["type"].text();
        const auto value = [&](const char* key) { return number(aperture[key], key); };
        ApertureShape& shape = row.aperture_shape;
        const bool has_shape = shape.half.x > 0 || shape.kind == ApertureOutline::polygon;
        if (type == "RadialAperture") {
            if (!is_infinite(aperture["r_max"])) row.clear_semi_diameter = value("r_max");
            row.inner_semi_diameter = number_or(aperture["r_min"], "r_min", 0);
        } else if (type == "IntersectionAperture" && depth < kMaxObscurations) {
            read_outline(aperture["a"], row, depth + 1);
            read_outline(aperture["b"], row, depth + 1);
        } else if (type == "DifferenceAperture" && depth < kMaxObscurations) {
            read_outline(aperture["a"], row, depth + 1);
            read_obscuration(aperture["b"], shape);
        } else if (has_shape) {
            unsupported("several apertures that are not circles");
        } else if (const std::optional<Obscuration> piece = axis_aligned_obscuration(aperture)) {
            set_outline(shape, !piece->is_rectangle && piece->half.x == piece->half.y, piece->is_rectangle, piece->half,
                        piece->offset);
        } else if (type == "OffsetRadialAperture" && value("r_min") == 0) {
            set_outline(shape, true, false, {value("r_max"), value("r_max")}, {value("offset_x"), value("offset_y")});
        } else if (type == "PolygonAperture") {
            shape.kind = ApertureOutline::polygon;
            shape.corners = corners_of(aperture);
        } else {
            unsupported("an aperture that is not a circle (" + printable_name(type) + ")");
        }
    }

    /// Adds the shape that is subtracted from an aperture.
    void read_obscuration(const Json& aperture, ApertureShape& shape) {
        const std::string& type = aperture["type"].text();
        std::optional<Obscuration> piece = axis_aligned_obscuration(aperture);
        if (type == "PolygonAperture") piece = rectangle_of(corners_of(aperture));
        if (!piece)
            return unsupported("an obscuration that is not an ellipse or rectangle (" + printable_name(type) + ")");
        shape.obscurations.push_back(*piece);
    }

    /// Returns an ellipse or a rectangle along the axes; std::nullopt for other types.
    std::optional<Obscuration> axis_aligned_obscuration(const Json& aperture) const {
        const std::string& type = aperture["type"].text();
        const auto value = [&](const char* key) { return number(aperture[key], key); };
        if (type == "EllipticalAperture")
            return Obscuration{false, {value("a"), value("b")}, {value("offset_x"), value("offset_y")}, 0};
        if (type != "RectangularAperture") return std::nullopt;
        const double x0 = value("x_min"), x1 = value("x_max"), y0 = value("y_min"), y1 = value("y_max");
        return Obscuration{true, {0.5 * (x1 - x0), 0.5 * (y1 - y0)}, {0.5 * (x0 + x1), 0.5 * (y0 + y1)}, 0};
    }

    std::vector<Vec2d> corners_of(const Json& aperture) const {
        const std::vector<double> x = numbers(aperture["x"], "x of a corner", kMaxApertureCorners + 1);
        const std::vector<double> y = numbers(aperture["y"], "y of a corner", kMaxApertureCorners + 1);
        if (aperture["x"].size() != aperture["y"].size()) fail("a polygon needs as many x as y");
        std::vector<Vec2d> corners;
        for (std::size_t i = 0; i < x.size(); ++i) corners.push_back({x[i], y[i]});
        return corners;
    }

    /// Returns the rectangle with these corners; std::nullopt if they are not those of a rectangle.
    static std::optional<Obscuration> rectangle_of(const std::vector<Vec2d>& corners) {
        if (corners.size() != 4) return std::nullopt;
        const auto edge = [&](std::size_t a, std::size_t b) {
            return Vec2d{corners[b].x - corners[a].x, corners[b].y - corners[a].y};
        };
        const Vec2d first_edge = edge(1, 0), other = edge(3, 0), opposite_edge = edge(2, 3);
        const double length = hypotenuse(first_edge.x, first_edge.y), width = hypotenuse(other.x, other.y);
        const double rounding = 1e-9 * (length + width);
        if (!(std::fabs(first_edge.x * other.x + first_edge.y * other.y) <= rounding * (length + width)) ||
            !(std::fabs(first_edge.x - opposite_edge.x) + std::fabs(first_edge.y - opposite_edge.y) <= rounding))
            return std::nullopt;
        return Obscuration{true,
                           {0.5 * length, 0.5 * width},
                           {0.5 * (corners[0].x + corners[2].x), 0.5 * (corners[0].y + corners[2].y)},
                           std::atan2(first_edge.y, first_edge.x) * 180 / std::numbers::pi};
    }

    /// Sets the aperture of the lens.
    void read_aperture(const Json& aperture) {
        static const std::map<std::string, ApertureKind> kinds{{"EPD", ApertureKind::entrance_pupil_diameter},
                                                               {"imageFNO", ApertureKind::f_number},
                                                               {"paraxialImageFNO", ApertureKind::working_f_number},
                                                               {"objectNA", ApertureKind::object_aperture},
                                                               {"float_by_stop_size", ApertureKind::stop_size}};
        const std::string& type = aperture["type"].text();
        const auto found = kinds.find(type);
        if (found == kinds.end()) fail("the aperture is of the type " + in_quotes(type) + ", which is unknown");
        p_.aperture_kind = found->second;
        p_.aperture = number(aperture["value"], "the value of the aperture");
        if (found->second == ApertureKind::stop_size) p_.aperture *= 0.5;  // Optiland has the diameter
    }

    void read_fields(const Json& fields) {
        std::string type = fields["field_definition"]["field_type"].text();
        if (type.empty()) type = fields["field_type"].text();
        const auto type_contains = [&](const char* part) { return type.find(part) != type.npos; };
        if (type == "AngleField" || type == "angle")
            p_.field_kind = FieldKind::angle_deg;
        else if (type == "ObjectHeightField" || type == "object_height")
            p_.field_kind = FieldKind::object_height;
        else if (type_contains("ImageHeight") || type_contains("image_height"))
            p_.field_kind = FieldKind::image_height;
        else
            return remark("its fields are of an unknown kind, and ignored");
        const Json& list = fields["fields"];
        for (std::size_t i = 0; i < list.size() && i < kMaxFileFields; ++i)
            add_field(list[i], 1, {"vx", "vx", "vy", "vy"});
    }

    void read_wavelengths(const Json& list) {
        std::vector<double> wavelengths_nm;
        std::size_t primary = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string& unit = list[i]["unit"].text();
            const double scale = unit == "nm" ? 1 : unit == "um" || unit.empty() ? 1000 : unit == "mm" ? 1e6 : 0;
            if (scale == 0) fail("the wavelength's unit is " + in_quotes(unit) + "; expected nm or um");
            wavelengths_nm.push_back(scale * number(list[i]["value"], "the wavelength"));
            if (list[i]["is_primary"].is_true()) primary = i;
        }
        set_wavelengths(std::move(wavelengths_nm), primary);
    }

    std::vector<Affine<double>> frames_;  ///< frames of the surfaces and of the image, in a common frame
};

}  // namespace

Prescription read_optiland(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return OptilandReader("Optiland", text, file, glasses).read();
}

}  // namespace realcam::io
