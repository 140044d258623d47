// Reads ray-optics' .roa, JSON: optical_model.seq_model holds interfaces and the gaps behind them, profile_dict the
// shapes, optical_spec aperture, fields and wavelengths. Each object is {"__instance_type__": [module, class],
// "attributes"}.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "../../text/printable.hpp"
#include "../lens_places.hpp"
#include "../lens_readers.hpp"
#include "../lens_text.hpp"
#include "lens_json.hpp"

namespace realcam::io {
namespace {

const Json& attributes(const Json& object) {
    return object["attributes"];
}
const std::string& module_of(const Json& object) {
    return object["__instance_type__"][std::size_t{0}].text();
}
const std::string& class_of(const Json& object) {
    return object["__instance_type__"][std::size_t{1}].text();
}

class Reader {
public:
    Reader(std::string_view text, const std::string& file, LensGlasses& glasses)
        : json_(text, file, glasses.options().keep_going), glasses_(glasses) {
        p_.file = file;
        p_.format = "ray-optics";
    }

    Prescription read() {
        const Json& model = attributes(json_.root()["optical_model"]);
        const Json& sequence = attributes(model["seq_model"]);
        const Json &interfaces = sequence["ifcs"], &gaps = sequence["gaps"];
        if (interfaces.size() < 3 || gaps.size() + 1 < interfaces.size())
            json_.fail(
                "is no lens of ray-optics: optical_model.seq_model with an object, a lens and an image is wanted");
        if (interfaces.size() > kMostFileSurfaces)
            json_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
        const Json& system = attributes(model["system_spec"]);
        p_.title = system["title"].text();
        set_unit(system);
        profiles_ = &model["profile_dict"];
        const std::size_t stop_index = sequence["stop_surface"].index(0);
        const Json& gap = attributes(gaps[std::size_t{0}])["thi"];
        const bool is_infinite = gap.is_number() && std::isinf(gap.number(0));
        const double object = is_infinite ? kInfinity : json_.number(gap, "the distance of the object");
        p_.object_distance = unit_ * object >= kLongest ? kInfinity : unit_ * object;
        for (std::size_t i = 1; i + 1 < interfaces.size(); ++i)
            read_surface(interfaces[i], gaps[i], i, i == stop_index);
        json_.set_surface(surface_ = static_cast<int>(interfaces.size()) - 1);
        PrescriptionSurface image;
        read_profile(interfaces[interfaces.size() - 1], image);
        read_place(attributes(interfaces[interfaces.size() - 1])["decenter"], image);
        p_.image_curvature = image.curvature;
        p_.image_placement = SurfacePlacement::of(image.before);
        json_.set_surface(surface_ = 0);
        read_specification(attributes(model["optical_spec"]));
        return std::move(p_);
    }

private:
    void foreign(const std::string& what) { p_.foreign.push_back({what, 0, surface_}); }

    void set_unit(const Json& system) {
        std::string unit = system["_dimensions"].text();
        if (unit.empty()) unit = system["dimensions"].text();
        unit = upper_case(unit);
        if (unit.empty() || unit == "MM")
            unit_ = 1;
        else if (unit == "CM")
            unit_ = 10;
        else if (unit == "M" || unit == "METERS")
            unit_ = 1000;
        else if (unit == "INCHES" || unit == "IN")
            unit_ = 25.4;
        else
            json_.fail("the unit is " + in_quotes(unit) + "; mm, cm, meters or inches is wanted");
    }

    void read_surface(const Json& interface, const Json& gap, std::size_t number, bool is_stop) {
        surface_ = static_cast<int>(number);
        json_.set_surface(surface_);
        const Json& a = attributes(interface);
        PrescriptionSurface row;
        row.number = surface_;
        row.is_stop = is_stop;
        if (class_of(interface) != "Surface")
            foreign("a surface of the class " + printable(class_of(interface)).substr(0, 40));
        if (!a["phase_element"].is_null()) foreign("a diffractive surface");
        read_place(a["decenter"], row);
        row.is_mirror = a["interact_mode"].text() == "reflect";
        row.thickness = unit_ * json_.number(attributes(gap)["thi"], "the thickness");
        read_rims(a, row);
        read_profile(interface, row);
        if (!row.is_mirror) row.material = material_of(attributes(gap)["medium"]);
        p_.surfaces.push_back(std::move(row));
    }

    static const Json& list_of(const Json& array) {
        return array["__ndarray__"].is_null() ? array : array["__ndarray__"];
    }

    /// Reads a decentre. As in CODE V, the first two angles are positive clockwise.
    void read_place(const Json& decentre, PrescriptionSurface& row) {
        if (decentre.is_null()) return;
        const Json& a = attributes(decentre);
        static const std::map<std::string, DecentreKind> kinds{{"decenter", DecentreKind::ordinary},
                                                               {"dec and return", DecentreKind::and_return},
                                                               {"bend", DecentreKind::bend},
                                                               {"reverse", DecentreKind::reverse}};
        // Files of earlier versions have numbers instead.
        static const std::array<DecentreKind, 4> numbered{DecentreKind::ordinary, DecentreKind::reverse,
                                                          DecentreKind::and_return, DecentreKind::bend};
        const Json& dtype = a["_dtype"].is_null() ? a["dtype"] : a["_dtype"];
        const auto found = kinds.find(dtype.text());
        if (found == kinds.end() && !(dtype.is_number() && dtype.index(9) < numbered.size()))
            return foreign("a decentre of the kind " + in_quotes(printable(dtype.text()).substr(0, 20)));
        const DecentreKind kind = found != kinds.end() ? found->second : numbered[dtype.index(0)];
        const auto value = [&](const char* key, std::size_t i) {
            return json_.number_or(list_of(a[key])[i], std::string("a decentre or tilt (") + key + ')', 0);
        };
        const SurfacePlacement placement{{unit_ * value("dec", 0), unit_ * value("dec", 1), unit_ * value("dec", 2)},
                                         {-value("euler", 0), -value("euler", 1), value("euler", 2)},
                                         false};
        for (std::size_t i = 0; i < 3; ++i)
            if (value("rot_pt", i) != 0) foreign("a point about which a surface is turned (rot_pt)");
        set_decentre(placement, kind, row);
    }

    void read_profile(const Json& interface, PrescriptionSurface& row) {
        const Json& a = attributes(interface);
        const Json& profile = a["profile"].is_null() ? (*profiles_)[a["profile_id"].text()] : a["profile"];
        const std::string type = class_of(profile);
        const Json& shape = attributes(profile);
        row.curvature = json_.number_or(shape["cv"], "the curvature", 0) / unit_;
        row.conic =
            !shape["ec"].is_null() ? json_.number(shape["ec"], "ec") - 1 : json_.number_or(shape["cc"], "cc", 0);
        if (profile.is_null() || type == "Spherical" || type == "Conic") return;
        const bool turns = type == "XToroid";
        const bool even = type == "EvenPolynomial" || type == "YToroid" || turns;
        if (type == "YToroid" || turns) {
            row.form.base = BaseForm::toroid;
            row.form.curvature_x = json_.number_or(shape["cR"], "the curvature of the sweep", 0) / unit_;
            if (turns) turn_about_axis(row);
        }
        if (!even && type != "RadialPolynomial") return foreign("a surface of type " + printable(type).substr(0, 40));
        const Json& list = list_of(shape["coefs"]);
        for (std::size_t i = 0; i < list.size() && i < 100; ++i) {
            const double value = json_.number(list[i], "an aspheric coefficient");
            const int power = (even ? 2 : 1) * (static_cast<int>(i) + 1);
            if (value != 0) row.aspheric[power] = value * std::pow(unit_, 1 - power);
        }
    }

    Glass material_of(const Json& medium) {
        const std::string type = class_of(medium), module = module_of(medium);
        const Json& a = attributes(medium);
        try {
            if (type == "Air") return Glass::air();
            if (type == "ConstantIndex" || type == "Medium") return glass_of_pair(json_.number(a["n"], "the index"), 0);
            if (type == "ModelGlass") return glass_of_pair(json_.number(a["n"], "n"), json_.number(a["v"], "v"));
            if (type == "InterpolatedMedium" || type == "InterpolatedGlass") return table_of(a);
            if (module.starts_with("opticalglass.") && !a["gname"].text().empty())
                return glasses_.find(a["gname"].text(), {module.substr(module.find('.') + 1)});
            if (type == "Glass" && !a["label"].text().empty()) return glasses_.find(a["label"].text(), {});
        } catch (const InputError& error) {
            json_.fail(error);
        }
        json_.fail("its medium is of the class " + in_quotes(type) + ", which is not known");
    }

    Glass table_of(const Json& a) const {
        const Json& wavelengths = list_of(a["wvls"]);
        const Json& indices = list_of(a["rndx"]);
        if (wavelengths.size() == 0 || wavelengths.size() != indices.size() || indices.size() > 10000)
            json_.fail("the table of its medium needs as many indices as wavelengths");
        std::vector<Glass::TablePoint> points;
        for (std::size_t i = 0; i < indices.size(); ++i)
            points.push_back({json_.number(wavelengths[i], "a wavelength"), json_.number(indices[i], "an index")});
        Glass glass = Glass::table(std::move(points));
        glass.label = printable(a["label"].text());
        return glass;
    }

    /// Reads apertures. A surface without any has the semi-diameter that ray-optics last computed.
    void read_rims(const Json& a, PrescriptionSurface& row) {
        const Json& list = a["clear_apertures"];
        for (std::size_t i = 0; i < list.size() && i < 100; ++i) {
            const Json& shape = attributes(list[i]);
            const auto value = [&](const char* key) { return json_.number_or(shape[key], key, 0); };
            const std::string& kind = class_of(list[i]);
            const bool is_circle = kind == "Circular", blocks = shape["is_obscuration"].is_true();
            if (!is_circle && kind != "Rectangular" && kind != "Elliptical") {
                foreign("an aperture that is no circle (" + printable(kind).substr(0, 40) + ")");
                continue;
            }
            const Vec2d offset{unit_ * value("x_offset"), unit_ * value("y_offset")};
            const Vec2d half = is_circle ? Vec2d{unit_ * value("radius"), unit_ * value("radius")}
                                         : Vec2d{unit_ * value("x_half_width"), unit_ * value("y_half_width")};
            if (is_circle && offset == Vec2d{0, 0}) {
                (blocks ? row.inner_semi_diameter : row.clear_semi_diameter) = half.x;
            } else if (blocks) {
                row.aperture_shape.obscurations.push_back({kind == "Rectangular", half, offset, 0});
            } else {
                row.aperture_shape.kind = is_circle               ? ApertureOutline::circle
                                          : kind == "Rectangular" ? ApertureOutline::rectangle
                                                                  : ApertureOutline::ellipse;
                row.aperture_shape.half = half;
                row.aperture_shape.offset = offset;
            }
            row.blocks = true;
        }
        if (const double reach = row.aperture_shape.reach(); reach > 0)
            row.clear_semi_diameter = row.clear_semi_diameter > 0 ? std::min(row.clear_semi_diameter, reach) : reach;
        row.is_open_outside = row.inner_semi_diameter > 0 && row.clear_semi_diameter == 0;
        if (row.clear_semi_diameter == 0)
            row.clear_semi_diameter = unit_ * json_.number_or(a["max_aperture"], "max_aperture", 0);
    }

    void read_specification(const Json& spec) {
        const Json& region = attributes(spec["spectral_region"]);
        const Json& wavelengths = list_of(region["wavelengths"]);
        const std::size_t reference = region["reference_wvl"].index(0);
        if (reference >= wavelengths.size()) json_.fail("the reference wavelength is none of the list");
        p_.wavelength_nm = json_.number(wavelengths[reference], "the wavelength");
        for (std::size_t i = 0; i < wavelengths.size(); ++i)
            p_.wavelengths_nm.push_back(json_.number(wavelengths[i], "the wavelength"));
        p_.defocus = unit_ * json_.number_or(attributes(spec["defocus"])["focus_shift"], "the focus shift", 0);
        read_aperture(attributes(spec["pupil"]));
        read_fields(attributes(spec["field_of_view"]));
    }

    /// Returns the side and the kind of a key such as ["aperture", "object", "epd"], whose first word may be absent.
    static std::pair<std::string, std::string> key_of(const Json& a) {
        const Json& key = a["_key"].is_null() ? a["key"] : a["_key"];
        const std::size_t first = key.size() == 3 ? 1 : 0;
        return {key[first].text(), key[first + 1].text()};
    }

    void read_aperture(const Json& a) {
        const auto [side, kind] = key_of(a);
        p_.aperture = json_.number(a["value"], "the value of the aperture");
        const bool object = side == "object";
        if (kind == "epd" || kind == "pupil") {
            if (!object) json_.fail("the aperture is given as an exit pupil, which is not supported");
            p_.aperture_kind = ApertureKind::entrance_pupil_diameter;
            p_.aperture *= unit_;
        } else if (kind == "f/#" && !object) {
            p_.aperture_kind = ApertureKind::working_f_number;
        } else if (kind == "NA") {
            p_.aperture_kind = object ? ApertureKind::object_aperture : ApertureKind::image_aperture;
        } else {
            json_.fail("the aperture is given by " + in_quotes(side + " " + kind) + ", which is not known");
        }
        if (!(p_.aperture > 0)) json_.fail("the aperture must be positive");
    }

    void read_fields(const Json& a) {
        const auto [side, kind] = key_of(a);
        const bool angle = kind == "angle" && side == "object";
        if (!angle && kind.find("height") == kind.npos) {
            p_.remarks.emplace_back("its fields are of a kind that is not known");
            return;
        }
        p_.field_kind = angle              ? FieldKind::angle_deg
                        : side == "object" ? FieldKind::object_height
                                           : FieldKind::image_height;
        const double scale = (angle ? 1 : unit_) *
                             (a["is_relative"].is_true() ? json_.number(a["value"], "the value of the fields") : 1);
        const Json& list = a["fields"];
        for (std::size_t i = 0; i < list.size() && i < 1000; ++i) {
            const Json& field = attributes(list[i]);
            const auto value = [&](const char* key) { return json_.number_or(field[key], "a field", 0); };
            const auto cut = [&](const char* key) { return std::clamp(value(key), 0.0, 0.999); };
            p_.fields.push_back(
                {scale * value("x"), scale * value("y"), cut("vux"), cut("vlx"), cut("vuy"), cut("vly")});
        }
    }

    LensJson json_;
    LensGlasses& glasses_;
    Prescription p_;
    const Json* profiles_ = nullptr;
    double unit_ = 1;
    int surface_ = 0;
};

}  // namespace

Prescription read_ray_optics(std::string_view text, const std::string& file, LensGlasses& glasses) {
    return Reader(text, file, glasses).read();
}

}  // namespace realcam::io
