// Writer of realcam's own lens files, which are TOML.

#include <charconv>
#include <cmath>
#include <numbers>
#include <set>

#include "../../optics/prescription/coating.hpp"
#include "../text/printable.hpp"
#include "../text/text_number.hpp"
#include "lens_glass.hpp"
#include "lens_material.hpp"
#include "lens_text.hpp"
#include "lens_toml.hpp"

namespace realcam::io {
namespace {

/// Writes a lens. The parts of the text are collected in strings, because tables of glasses and coatings precede the
/// surfaces that use them.
class TomlWriter {
public:
    explicit TomlWriter(const LensSystem& lens) : lens_(lens) {}

    std::string write() {
        for (const Surface& surface : lens_.surfaces) write_surface(surface);
        write_iris();
        write_focusing();
        write_zoom();
        std::string head = "format = 1\n" + key("name", text(lens_.name));
        if (!lens_.title.empty()) head += key("title", text(lens_.title));
        if (!lens_.source.empty()) head += key("source", text(lens_.source));
        head += number("wavelength_nm", lens_.wavelength_nm);
        head += key("film_mm", '[' + toml_number(lens_.film_width) + ", " + toml_number(lens_.film_height) + ']');
        head += number("film_distance_mm", lens_.film_distance);
        if (std::isfinite(lens_.film_radius_of_curvature))
            head += number("film_radius_of_curvature_mm", lens_.film_radius_of_curvature);
        const SurfacePlacement& film = lens_.film_placement;
        if (film.decentre != Vec3d{0, 0, 0}) head += key("film_decentre_mm", triple(film.decentre));
        if (film.tilt_deg != Vec3d{0, 0, 0}) head += key("film_tilt_deg", triple(film.tilt_deg));
        if (lens_.allow_overlap) head += key("allow_overlap", "true");
        head += write_rings();
        return head + glasses_ + coatings_ + body_;
    }

private:
    // Lines of a table: a key and its value.
    static std::string key(const std::string& name, const std::string& value) { return name + " = " + value + '\n'; }
    static std::string number(const std::string& name, double value) { return key(name, toml_number(value)); }

    static std::string triple(Vec3d v) {
        return '[' + toml_number(v.x) + ", " + toml_number(v.y) + ", " + toml_number(v.z) + ']';
    }

    /// A text in quotes. Throws InputError if no lens file can hold it.
    static std::string text(const std::string& value) {
        if (!is_utf8(value) || printable(value) != value)
            throw InputError("the text " + in_quotes(value) +
                             " cannot be written to a lens file: it has control characters, or is not UTF-8");
        std::string quoted = "\"";
        for (const char c : value) {
            if (c == '"' || c == '\\') quoted += '\\';
            quoted += c;
        }
        return quoted + '"';
    }

    /// Zoom position, focus distance and aperture, where they differ from the reader's defaults.
    std::string write_rings() const {
        std::string rings;
        double default_distance = kInfinity;
        if (!lens_.zoom.positions.empty()) {
            const ZoomPosition& current = lens_.zoom.positions[static_cast<std::size_t>(lens_.zoom.current)];
            rings += key("zoom_position", text(current.name));
            default_distance = current.focus_distance;
        }
        if (lens_.focus_distance != default_distance)
            rings +=
                key("focus_distance_mm", std::isinf(lens_.focus_distance) ? "inf" : toml_number(lens_.focus_distance));
        if (lens_.stop_semi_diameter != lens_.stop().clear_semi_diameter)
            rings += number("stop_semi_diameter_mm", lens_.stop_semi_diameter);
        return rings;
    }

    void write_surface(const Surface& s) {
        body_ += "\n[[surface]]   # " + std::to_string(++surface_count_) + '\n';
        static const char* kTypes[] = {"refracting", "mirror", "stop", "aperture"};
        if (s.type != SurfaceType::refracting)
            body_ += key("type", std::string("\"") + kTypes[static_cast<int>(s.type)] + '"');
        if (s.bends_light() && s.curvature != 0) {
            const auto radius = exact_preimage(1 / s.curvature, s.curvature, [](double r) { return 1 / r; });
            body_ += radius ? number("radius_of_curvature_mm", *radius) : number("curvature_per_mm", s.curvature);
        }
        if (surface_count_ < lens_.surfaces.size()) body_ += number("thickness_mm", s.thickness);
        if (s.type == SurfaceType::refracting && !(s.material == Glass::air()))
            body_ += key("material", material(s.material));
        body_ += number("clear_semi_diameter_mm", s.clear_semi_diameter);
        if (s.inner_semi_diameter != 0) body_ += number("inner_semi_diameter_mm", s.inner_semi_diameter);
        body_ += aperture_as_toml(s.aperture_shape);
        if (s.placement.decentre != Vec3d{0, 0, 0}) body_ += key("decentre_mm", triple(s.placement.decentre));
        if (s.placement.tilt_deg != Vec3d{0, 0, 0}) body_ += key("tilt_deg", triple(s.placement.tilt_deg));
        if (s.placement.returns) body_ += key("returns", "true");
        if (!s.bends_light()) return;
        if (s.conic != 0) body_ += number("conic", s.conic);
        body_ += form_as_toml(s.form);
        if (!s.aspheric.empty()) {
            std::string list;
            for (std::size_t i = 0; i < s.aspheric.size(); ++i)
                list += (i == 0 ? "" : ", ") + std::to_string(2 * i + 4) + " = " + toml_number(s.aspheric[i]);
            body_ += key("aspheric_coefficients", "{ " + list + " }");
        }
        if (!(s.coating == Coating())) body_ += key("coating", coating(s.coating));
    }

    /// Returns the value of the key "material": the shortest one from which the reader restores exactly this glass.
    /// Adds a table [glass.NAME] if needed.
    std::string material(const Glass& glass) {
        if (glass.has_one_index()) {
            const double index = glass.index(kLineD_nm);
            Glass plain = Glass::constant(index);
            plain.label = number_label(index);
            if (index >= 1 && plain == glass) return toml_number(index);
        }
        std::string_view rest = glass.label;
        const auto n_d = consume_number(rest);
        if (n_d && rest.starts_with(" / ")) {
            rest.remove_prefix(3);
            const auto v_d = consume_number(rest);
            if (v_d && *n_d >= 1 && *v_d > 0 && std::isfinite(*n_d) && std::isfinite(*v_d)) {
                Glass pair = Glass::from_abbe_number(*n_d, *v_d);
                pair.label = number_label(*n_d) + " / " + number_label(*v_d);
                if (pair == glass) return '[' + toml_number(*n_d) + ", " + toml_number(*v_d) + ']';
            }
        }
        for (std::size_t i = 0; i < file_glasses_.size(); ++i)
            if (file_glasses_[i].second == glass) return text(file_glasses_[i].first);
        if (uses_catalogue_name(glass)) return text(glass.label);
        return text(add_glass(glass));
    }

    /// True if the glass can be written by its catalogue name, which is then reserved: a glass table of the file takes
    /// precedence over the catalogue, so that no table may have the same name.
    bool uses_catalogue_name(const Glass& glass) {
        if (used_names_.contains(glass.label) || !catalogue_name_of(glass)) return false;
        catalogue_names_.insert(glass.label);
        return true;
    }

    /// Returns a name that no table and no used catalogue glass has: `preferred`, or else `fallback`, numbered if
    /// needed.
    std::string unused_name(const std::string& preferred, const std::string& fallback) {
        std::string name = preferred.empty() || named_coating(preferred) ? fallback : preferred;
        for (int i = 2; used_names_.contains(name) || catalogue_names_.contains(name); ++i)
            name = (preferred.empty() ? fallback : preferred) + " (" + std::to_string(i) + ')';
        used_names_.insert(name);
        return name;
    }

    /// Adds a table [glass.NAME], and returns its name.
    std::string add_glass(const Glass& glass) {
        const std::string name = unused_name(glass.label, "glass");
        const Glass::Parts parts = glass.parts();
        const auto listed = [](const std::vector<double>& values, std::size_t first, std::size_t step) {
            std::string list;
            for (std::size_t i = first; i < values.size(); i += step)
                list += (list.empty() ? "" : ", ") + toml_number(values[i]);
            return '[' + list + ']';
        };
        glasses_ += "\n[glass." + text(name) + "]\n";
        if (name != glass.label) glasses_ += key("label", text(glass.label));
        if (parts.formula == Glass::Formula::sellmeier) {
            glasses_ += key("sellmeier", "{ B = " + listed(parts.coefficients, 0, 2) +
                                             ", C = " + listed(parts.coefficients, 1, 2) + " }");
        } else if (parts.formula == Glass::Formula::cauchy) {
            glasses_ += key("cauchy", listed(parts.coefficients, 0, 1));
        } else {
            std::string rows;
            for (const Glass::TablePoint& point : parts.points)
                rows += (rows.empty() ? "[" : ", [") + toml_number(point.wavelength_nm) + ", " +
                        toml_number(point.index) + ']';
            glasses_ += key("table", '[' + rows + ']');
        }
        file_glasses_.emplace_back(name, glass);
        return name;
    }

    /// Complex indices as an array of [wavelength in nm, n, k].
    static std::string points(const CoatingMaterial& material) {
        std::string rows;
        for (const CoatingMaterial::Point& p : material.points)
            rows += (rows.empty() ? "[" : ", [") + toml_number(p.wavelength_nm) + ", " + toml_number(p.n) + ", " +
                    toml_number(p.k) + ']';
        return '[' + rows + ']';
    }

    /// Returns the value of the key "coating". Adds a table [coating.NAME] if needed.
    std::string coating(const Coating& coating) {
        if (const auto known = named_coating(coating.name); known && *known == coating) return text(coating.name);
        for (const auto& [name, own] : file_coatings_)
            if (own == coating) return text(name);
        const std::string name = unused_name(coating.name, "coating");
        std::string table = "\n[coating." + text(name) + "]\n";
        if (name != coating.name) table += key("label", text(coating.name));
        if (coating.kind == CoatingKind::reflectance) table += number("reflectance", coating.reflectance);
        if (coating.kind == CoatingKind::metal) {
            const auto known = named_metal(coating.metal.label);
            if (known && *known == coating.metal) {
                table += key("metal", text(coating.metal.label));
            } else {
                table += key("metal", points(coating.metal)) + key("metal_label", text(coating.metal.label));
            }
        }
        std::string layers;
        for (const CoatingLayer& layer : coating.layers) {
            layers += "    { ";
            const CoatingMaterial& m = layer.material;
            const auto metal = named_metal(m.label);
            if (metal && *metal == m)
                layers += "material = " + text(m.label);
            else
                layers += (m.points.empty() ? "material = " + material(m.glass) : "complex_index = " + points(m)) +
                          ", label = " + text(m.label);
            layers += ", thickness_nm = " + toml_number(layer.thickness_nm) + " },\n";
        }
        if (!layers.empty() || coating.kind == CoatingKind::bare || coating.kind == CoatingKind::layers)
            table += "layers = [\n" + layers + "]\n";
        coatings_ += table;
        file_coatings_.emplace_back(name, coating);
        return text(name);
    }

    void write_iris() {
        const IrisShape& iris = lens_.iris;
        if (iris == IrisShape()) return;
        body_ += "\n[iris]\n" + key("blades", std::to_string(iris.blades)) + number("rounding", iris.rounding);
        const auto degrees = exact_preimage(iris.rotation_rad * 180 / std::numbers::pi, iris.rotation_rad,
                                            [](double d) { return d * std::numbers::pi / 180; });
        body_ += degrees ? number("rotation_deg", *degrees) : number("rotation_rad", iris.rotation_rad);
    }

    void write_focusing() {
        const FocusingRule& rule = lens_.focusing;
        if (rule == FocusingRule()) return;
        body_ += "\n[focus]\n";
        if (rule.nearest_mm > 0) {
            const auto metres =
                exact_preimage(rule.nearest_mm / 1000, rule.nearest_mm, [](double m) { return 1000 * m; });
            body_ += metres ? number("nearest_m", *metres) : number("nearest_mm", rule.nearest_mm);
        }
        if (rule.moves_group())
            body_ += key("group",
                         '[' + std::to_string(rule.group_first + 1) + ", " + std::to_string(rule.group_last + 1) + ']');
    }

    void write_zoom() {
        for (const ZoomPosition& position : lens_.zoom.positions) {
            body_ += "\n[[zoom]]\n" + key("name", text(position.name));
            std::string list;
            for (std::size_t i = 0; i < lens_.zoom.surfaces.size(); ++i)
                list += (i == 0 ? "" : ", ") + std::to_string(lens_.zoom.surfaces[i] + 1) + " = " +
                        toml_number(position.thicknesses[i]);
            if (!list.empty()) body_ += key("thickness_mm", "{ " + list + " }");
            body_ += number("film_distance_mm", position.film_distance);
            if (std::isfinite(position.focus_distance)) body_ += number("focus_distance_mm", position.focus_distance);
            if (position.stop_semi_diameter > 0) body_ += number("stop_semi_diameter_mm", position.stop_semi_diameter);
        }
    }

    const LensSystem& lens_;
    std::string glasses_, coatings_, body_;  ///< tables of glasses and coatings; all other tables
    std::size_t surface_count_ = 0;  ///< surfaces written so far
    std::set<std::string> used_names_;  ///< of the tables added so far
    std::set<std::string> catalogue_names_;  ///< of the catalogue glasses used so far
    std::vector<std::pair<std::string, Glass>> file_glasses_;
    std::vector<std::pair<std::string, Coating>> file_coatings_;
};

}  // namespace

std::string exact_number(double value) {
    char text[40];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    return {text, end};
}

std::string lens_as_toml(const LensSystem& lens) {
    return TomlWriter(lens).write();
}

}  // namespace realcam::io
