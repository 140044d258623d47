#include <cmath>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"
#include "../lens_glass.hpp"
#include "../lens_text.hpp"
#include "../lens_writers.hpp"
#include "lens_code_v_shape.hpp"

namespace realcam::io {
namespace {

class CodeVWriter {
public:
    explicit CodeVWriter(const LensSystem& lens) : lens_(lens) {}

    LensText write() {
        result_.warnings = left_out_of_foreign_files(lens_, "CODE V");
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) write_surface(i);
        // The reader sizes the stop as if the lens were centred; the pupil diameter is computed in the same way.
        const FirstOrder data = first_order(centred(lens_), lens_.wavelength_nm);
        if (!std::isfinite(data.entrance_pupil_diameter))
            throw InputError("lens \"" + lens_.name +
                             "\" has its entrance pupil at infinity, and no aperture that a .seq file states");
        // Curvatures, because radii would be rounded.
        std::string text = "RDM N;LEN\nTITLE '" + quoted(lens_.title.empty() ? lens_.name : lens_.title) + "'\nEPD " +
                           exact_number(data.entrance_pupil_diameter) + "\nDIM M\nWL " +
                           exact_number(lens_.wavelength_nm) + "\nREF 1\nWTW 1\n";
        const double corner = 0.5 * hypotenuse(lens_.film_width, lens_.film_height);
        text += "XRI 0.0 0.0\nYRI 0.0 " + exact_number(corner) + "\nWTF 1.0 1.0\n";
        text += private_glasses();
        const double object = lens_.focus_distance - lens_.film_position();
        text += "SO 0.0 " + (std::isfinite(object) ? exact_number(object) : std::string("0.1e14")) + '\n';
        result_.text = text + surfaces_ + image() + zoom() + "GO\n";
        return std::move(result_);
    }

private:
    static std::string quoted(const std::string& title) {
        std::string text = printable(title);
        for (char& c : text)
            if (c == '\'') c = '`';
        return text;
    }

    void write_surface(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const bool is_last = i + 1 == lens_.surfaces.size();
        if (s.type == SurfaceType::refracting) medium_ = &s.material;
        const CodeVShape shape = code_v_shape_of(s);
        SurfacePlacement place = s.placement;
        if (shape.constant != 0) {
            // CODE V's polynomials have no constant term: only this surface is moved.
            place = SurfacePlacement::of(place.frame() * along_axis(shape.constant));
            place.returns = s.placement.returns || s.placement.is_in_place();
        }
        const double thickness = is_last ? lens_.film_distance : s.thickness;
        surfaces_ += "S " + exact_number(s.bends_light() ? s.curvature : 0.0) + ' ' +
                     exact_number(place.returns ? thickness : thickness - shape.constant);
        if (s.type == SurfaceType::mirror)
            surfaces_ += " REFL";
        else if (!medium_->is_air())
            surfaces_ += ' ' + glass(*medium_);
        surfaces_ += '\n';
        if (s.type == SurfaceType::stop) surfaces_ += "  STO\n";
        surfaces_ += shape.commands + code_v_placement(place);
        for (const std::string& what : shape.left_out)
            result_.warnings.push_back("surface " + std::to_string(i + 1) + ' ' + what);
    }

    std::string image() const {
        // The sag of the film is measured along the light, and that of the file along the axis.
        const double curvature = (lens_.film_distance < 0 ? -1 : 1) / lens_.film_radius_of_curvature;
        return "SI " + exact_number(curvature) + " 0.0\n" + code_v_placement(lens_.film_placement);
    }

    std::string glass(const Glass& glass) {
        if (const auto known = catalogue_name_of(glass))
            return bare_glass_name(known->name) + '_' + (known->maker == "misc" ? "SPECIAL" : upper_case(known->maker));
        for (std::size_t i = 0; i < private_.size(); ++i)
            if (private_[i] == glass) return private_name(i);
        private_.push_back(glass);
        return private_name(private_.size() - 1);
    }
    static std::string private_name(std::size_t i) { return "'GLASS" + std::to_string(i + 1) + '\''; }

    /// Returns glasses that are in no catalogue, by their indices at spectral lines and at the lens's own wavelength.
    std::string private_glasses() const {
        if (private_.empty()) return {};
        std::string text = "PRV\n  PWL";
        for (const auto& point : indices_at_lines(private_.front(), lens_.wavelength_nm))
            text += ' ' + exact_number(point.wavelength_nm);
        text += '\n';
        for (std::size_t i = 0; i < private_.size(); ++i) {
            text += "  " + private_name(i);
            for (const auto& point : indices_at_lines(private_[i], lens_.wavelength_nm))
                text += ' ' + exact_number(point.index);
            text += '\n';
        }
        return text + "END\n";
    }

    std::string zoom() {
        const ZoomRange& zoom = lens_.zoom;
        if (zoom.positions.empty()) return {};
        if (!lens_.is_rotational()) {
            result_.warnings.push_back("zoom positions, because the lens is not centred");
            return {};
        }
        if (zoom.current != 0)
            result_.warnings.push_back("the position of the zoom ring: a .seq file is read in its first position");
        std::string text = "ZOO " + std::to_string(zoom.positions.size()) + "\nZOO TIT";
        for (const ZoomPosition& position : zoom.positions) text += " '" + quoted(position.name) + '\'';
        const auto state = [&](std::size_t k) {
            return static_cast<int>(k) == zoom.current ? lens_ : at_zoom_position(lens_, static_cast<int>(k));
        };
        const auto add = [&](const std::string& what, const auto& value) {
            text += "\nZOO " + what;
            for (std::size_t k = 0; k < zoom.positions.size(); ++k) text += ' ' + exact_number(value(state(k)));
        };
        for (const int i : zoom.surfaces)
            add("THI S" + std::to_string(i + 1),
                [i](const LensSystem& l) { return l.surfaces[static_cast<std::size_t>(i)].thickness; });
        add("THI S" + std::to_string(lens_.surfaces.size()), [](const LensSystem& l) { return l.film_distance; });
        add("THI SO", [](const LensSystem& l) {
            const double object = l.focus_distance - l.film_position();
            return std::isfinite(object) ? object : 1e13;
        });
        add("EPD", [](const LensSystem& l) { return first_order(l, l.wavelength_nm).entrance_pupil_diameter; });
        return text + '\n';
    }

    const LensSystem& lens_;
    LensText result_;
    std::string surfaces_;
    const Glass air_ = Glass::air();
    const Glass* medium_ = &air_;
    std::vector<Glass> private_;
};

}  // namespace

std::vector<Glass::TablePoint> indices_at_lines(const Glass& glass, double wavelength_nm) {
    std::set<double> lines{365.0146,  404.6561,  435.8343, kLineF_nm, 546.0740,
                           kLineD_nm, kLineC_nm, 706.5188, 852.11,    wavelength_nm};
    std::vector<Glass::TablePoint> points;
    for (const double nm : lines) points.push_back({nm, glass.index(nm)});
    return points;
}

LensText lens_as_code_v(const LensSystem& lens) {
    return CodeVWriter(lens).write();
}

}  // namespace realcam::io
