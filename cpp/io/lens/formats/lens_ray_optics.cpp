// Reader of ray-optics' JSON files (.roa). optical_model.seq_model holds the interfaces and the gaps behind them,
// profile_dict holds the shapes, and optical_spec holds aperture, fields and wavelengths. Each object of Python is
// stored as {"__instance_type__": [module, class], "attributes": {...}}.

#include <array>
#include <cmath>

#include "../../text/printable.hpp"
#include "../lens_format.hpp"
#include "prescription_json.hpp"

namespace realcam::io {
namespace {

/// Attributes of a stored object; null if it is absent.
const Json& attributes(const Json& object) {
    return object["attributes"];
}
/// Python module of the object's class.
const std::string& module_of(const Json& object) {
    return object["__instance_type__"][std::size_t{0}].text();
}
/// Name of the object's class.
const std::string& class_of(const Json& object) {
    return object["__instance_type__"][std::size_t{1}].text();
}
/// Returns the member of a name with or without a leading underscore: versions of ray-optics differ in it.
const Json& member(const Json& object, const std::string& name) {
    const Json& underscored = object['_' + name];
    return underscored.is_null() ? object[name] : underscored;
}
/// Elements of a list or a NumPy array.
const Json& list_of(const Json& array) {
    return array["__ndarray__"].is_null() ? array : array["__ndarray__"];
}

/// Converts the file's objects one after the other.
class RayOpticsReader : PrescriptionJson {
public:
    using PrescriptionJson::PrescriptionJson;

    Prescription read() {
        const Json& model = attributes(root_["optical_model"]);
        const Json& sequence = attributes(model["seq_model"]);
        const Json &interfaces = sequence["ifcs"], &gaps = sequence["gaps"];
        check_count(gaps.size() + 1 < interfaces.size() ? 0 : interfaces.size(),
                    "optical_model.seq_model of ray-optics");
        const Json& system = attributes(model["system_spec"]);
        p_.title = system["title"].text();
        set_unit(member(system, "dimensions").text());
        profiles_ = &model["profile_dict"];
        const Json& gap = attributes(gaps[std::size_t{0}])["thi"];
        set_object(is_infinite(gap) ? kInfinity : unit_ * number(gap, "the distance of the object"), 0, 0);
        const std::size_t stop_index = sequence["stop_surface"].index(0);
        for (std::size_t i = 1; i + 1 < interfaces.size(); ++i) read_surface(interfaces[i], gaps[i], i == stop_index);
        ++surface_;
        PrescriptionSurface image;
        const Json& last = interfaces[interfaces.size() - 1];
        read_profile(attributes(last), image);
        read_placement(attributes(last)["decenter"], image);
        p_.image_curvature = image.curvature;
        p_.image_placement = SurfacePlacement::from_frame(image.before);
        surface_ = 0;
        read_specification(attributes(model["optical_spec"]));
        return std::move(p_);
    }

private:
    /// Sets the unit of lengths; empty: mm.
    void set_unit(const std::string& unit) {
        const std::optional<double> known = millimetres_of(unit.empty() ? "MM" : upper_case(unit));
        if (!known) fail("the unit is " + in_quotes(upper_case(unit)) + "; expected mm, cm, meters or inches");
        unit_ = *known;
    }

    /// Adds the row of an interface and the gap behind it.
    void read_surface(const Json& interface, const Json& gap, bool is_stop) {
        const Json& a = attributes(interface);
        PrescriptionSurface row;
        row.number = ++surface_;
        row.is_stop = is_stop;
        if (class_of(interface) != "Surface")
            unsupported("a surface of the class " + printable_name(class_of(interface)));
        if (!a["phase_element"].is_null()) unsupported("a diffractive surface");
        read_placement(a["decenter"], row);
        row.is_mirror = a["interact_mode"].text() == "reflect";
        row.thickness = unit_ * number(attributes(gap)["thi"], "the thickness");
        read_apertures(a, row);
        read_profile(a, row);
        if (!row.is_mirror) row.material = material_of(attributes(gap)["medium"]);
        p_.surfaces.push_back(std::move(row));
    }

    /// Sets the placement of a row. As in CODE V, the first two angles have the opposite sign.
    void read_placement(const Json& decentre, PrescriptionSurface& row) {
        if (decentre.is_null()) return;
        const Json& a = attributes(decentre);
        // Files of earlier versions have numbers instead of names.
        static constexpr std::array<std::pair<std::string_view, DecentreKind>, 4> kinds{
            {{"decenter", DecentreKind::ordinary},
             {"reverse", DecentreKind::reverse},
             {"dec and return", DecentreKind::and_return},
             {"bend", DecentreKind::bend}}};
        const Json& type = member(a, "dtype");
        std::size_t kind = type.is_number() ? type.index(kinds.size()) : 0;
        while (!type.is_number() && kind < kinds.size() && kinds[kind].first != type.text()) ++kind;
        if (kind >= kinds.size())
            return unsupported("a decentre of type " + in_quotes(printable_name(type.text(), 20)));
        const auto values = [&](const char* key) {
            const auto value = [&](std::size_t i) {
                return number_or(list_of(a[key])[i], std::string("a decentre or tilt (") + key + ')', 0);
            };
            return Vec3d{value(0), value(1), value(2)};
        };
        const Vec3d decentre_mm = unit_ * values("dec"), angles = values("euler");
        if (values("rot_pt") != Vec3d{0, 0, 0}) unsupported("a rotation about a point other than the vertex (rot_pt)");
        set_decentre({decentre_mm, {-angles.x, -angles.y, angles.z}, false}, kinds[kind].second, row);
    }

    /// Sets the shape of a row. `a`: attributes of the interface.
    void read_profile(const Json& a, PrescriptionSurface& row) {
        const Json& profile = a["profile"].is_null() ? (*profiles_)[a["profile_id"].text()] : a["profile"];
        const std::string& type = class_of(profile);
        const Json& shape = attributes(profile);
        row.curvature = number_or(shape["cv"], "the curvature", 0) / unit_;
        row.conic = !shape["ec"].is_null() ? number(shape["ec"], "ec") - 1 : number_or(shape["cc"], "cc", 0);
        if (profile.is_null() || type == "Spherical" || type == "Conic") return;
        const bool is_toroid = type == "YToroid" || type == "XToroid";
        if (is_toroid) {
            row.form.base = BaseForm::toroid;
            row.form.curvature_x = number_or(shape["cR"], "the curvature of the sweep", 0) / unit_;
        }
        if (type == "XToroid") swap_toroid_axes(row);
        if (is_toroid || type == "EvenPolynomial" || type == "RadialPolynomial")
            add_terms(list_of(shape["coefs"]), type == "RadialPolynomial" ? 1 : 2, "an aspheric coefficient", row,
                      unit_);
        else
            unsupported("a surface of type " + printable_name(type));
    }

    /// Returns the medium of a gap.
    Glass material_of(const Json& medium) {
        const std::string &type = class_of(medium), &module = module_of(medium);
        const Json& a = attributes(medium);
        try {
            if (type == "Air") return Glass::air();
            if (type == "ConstantIndex" || type == "Medium") return glass_of_pair(number(a["n"], "the index"), 0);
            if (type == "ModelGlass") return glass_of_pair(number(a["n"], "n"), number(a["v"], "v"));
            if (type == "InterpolatedMedium" || type == "InterpolatedGlass") return tabulated_glass(a);
            if (module.starts_with("opticalglass.") && !a["gname"].text().empty())
                return glasses_.find(a["gname"].text(), {module.substr(module.find('.') + 1)});
            if (type == "Glass" && !a["label"].text().empty()) return glasses_.find(a["label"].text(), {});
        } catch (const InputError& error) {
            fail(error);
        }
        fail("its medium is of the class " + in_quotes(type) + ", which is unknown");
    }

    Glass tabulated_glass(const Json& a) const {
        const Json &wavelengths = list_of(a["wvls"]), &indices = list_of(a["rndx"]);
        if (wavelengths.size() == 0 || wavelengths.size() != indices.size() || indices.size() > kMaxFileIndices)
            fail("the table of its medium needs as many indices as wavelengths");
        return glass_of_indices(numbers(wavelengths, "a wavelength"), numbers(indices, "an index"),
                                printable(a["label"].text()));
    }

    /// Sets the apertures of a row. A surface without apertures has the semi-diameter that ray-optics last computed.
    void read_apertures(const Json& a, PrescriptionSurface& row) {
        const Json& list = a["clear_apertures"];
        for (std::size_t i = 0; i < list.size() && i < 100; ++i) {
            const Json& shape = attributes(list[i]);
            const auto length = [&](const char* key) { return unit_ * number_or(shape[key], key, 0); };
            const std::string& kind = class_of(list[i]);
            const bool is_circle = kind == "Circular", is_obscuration = shape["is_obscuration"].is_true();
            if (!is_circle && kind != "Rectangular" && kind != "Elliptical") {
                unsupported("an aperture that is not a circle (" + printable_name(kind) + ")");
                continue;
            }
            const Vec2d offset{length("x_offset"), length("y_offset")};
            const Vec2d half = is_circle ? Vec2d{length("radius"), length("radius")}
                                         : Vec2d{length("x_half_width"), length("y_half_width")};
            row.has_aperture = true;
            if (is_circle && offset == Vec2d{0, 0}) {
                (is_obscuration ? row.inner_semi_diameter : row.clear_semi_diameter) = half.x;
            } else if (is_obscuration) {
                row.aperture_shape.obscurations.push_back({kind == "Rectangular", half, offset, 0});
            } else {
                set_outline(row.aperture_shape, is_circle, kind == "Rectangular", half, offset);
            }
        }
        limit_to_outline(row);
        row.is_open_outside = row.inner_semi_diameter > 0 && row.clear_semi_diameter == 0;
        if (row.clear_semi_diameter == 0)
            row.clear_semi_diameter = unit_ * number_or(a["max_aperture"], "max_aperture", 0);
    }

    /// Sets wavelengths, defocus, aperture and fields.
    void read_specification(const Json& spec) {
        const Json& region = attributes(spec["spectral_region"]);
        const Json& wavelengths = list_of(region["wavelengths"]);
        const std::size_t reference = region["reference_wvl"].index(0);
        if (reference >= wavelengths.size())
            fail("the index of the reference wavelength exceeds the list of wavelengths");
        set_wavelengths(numbers(wavelengths, "the wavelength", wavelengths.size()), reference);
        p_.defocus = unit_ * number_or(attributes(spec["defocus"])["focus_shift"], "the focus shift", 0);
        read_aperture(attributes(spec["pupil"]));
        read_fields(attributes(spec["field_of_view"]));
    }

    /// Returns the side and the kind of a key such as ["aperture", "object", "epd"], whose first word may be absent.
    static std::pair<std::string, std::string> key_of(const Json& a) {
        const Json& key = member(a, "key");
        const std::size_t first = key.size() == 3 ? 1 : 0;
        return {key[first].text(), key[first + 1].text()};
    }

    void read_aperture(const Json& a) {
        const auto [side, kind] = key_of(a);
        p_.aperture = number(a["value"], "the value of the aperture");
        const bool object = side == "object";
        if (kind == "epd" || kind == "pupil") {
            if (!object) fail("the aperture is specified by the exit pupil, which is not supported");
            p_.aperture_kind = ApertureKind::entrance_pupil_diameter;
            p_.aperture *= unit_;
        } else if (kind == "f/#" && !object) {
            p_.aperture_kind = ApertureKind::working_f_number;
        } else if (kind == "NA") {
            p_.aperture_kind = object ? ApertureKind::object_aperture : ApertureKind::image_aperture;
        } else {
            fail("the aperture is specified by " + in_quotes(side + " " + kind) + ", which is unknown");
        }
        if (!(p_.aperture > 0)) fail("the aperture must be positive");
    }

    void read_fields(const Json& a) {
        const auto [side, kind] = key_of(a);
        const bool angle = kind == "angle" && side == "object";
        if (!angle && kind.find("height") == kind.npos) return remark("its fields are of an unknown kind, and ignored");
        p_.field_kind = angle              ? FieldKind::angle_deg
                        : side == "object" ? FieldKind::object_height
                                           : FieldKind::image_height;
        const double scale =
            (angle ? 1 : unit_) * (a["is_relative"].is_true() ? number(a["value"], "the value of the fields") : 1);
        const Json& list = a["fields"];
        for (std::size_t i = 0; i < list.size() && i < kMaxFileFields; ++i)
            add_field(attributes(list[i]), scale, {"vux", "vlx", "vuy", "vly"});
    }

    const Json* profiles_ = nullptr;  ///< profile_dict: shapes by id
    double unit_ = 1;  ///< length of the file's unit, mm
};

}  // namespace

Prescription read_ray_optics(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return RayOpticsReader("ray-optics", text, file, glasses).read();
}

}  // namespace realcam::io
