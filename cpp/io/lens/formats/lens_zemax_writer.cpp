#include <algorithm>
#include <cmath>
#include <set>

#include "../../../math/hypotenuse.hpp"
#include "../../../optics/lens/paraxial.hpp"
#include "../../text/printable.hpp"
#include "../lens_glass.hpp"
#include "../lens_writers.hpp"
#include "lens_zemax_shape.hpp"

namespace realcam::io {
namespace {

class ZemaxWriter {
public:
    explicit ZemaxWriter(const LensSystem& lens) : lens_(lens) {}

    LensText write() {
        result_.warnings = left_out_of_foreign_files(lens_, "Zemax");
        for (std::size_t i = 0; i < lens_.surfaces.size(); ++i) write_surface(i);
        if (!lens_.film_placement.is_in_place()) write_break(lens_.film_placement);
        write_zoom();
        std::string head = "VERS 180000 0 0\nMODE SEQ\nNAME " +
                           printable(lens_.title.empty() ? lens_.name : lens_.title) + "\nUNIT MM X W X CM MR CPMM\n";
        // For lenses without rotational symmetry only the stop defines the width of the beam.
        const bool has_pupil = lens_.is_rotational();
        const double pupil = has_pupil ? first_order(lens_, lens_.wavelength_nm).entrance_pupil_diameter : kInfinity;
        if (std::isfinite(pupil))
            head += "ENPD " + exact_number(pupil) + '\n';
        else
            head += "FLOA\n";
        if (!makers_.empty()) {
            head += "GCAT";
            for (const std::string& maker : makers_) head += ' ' + maker;
            head += '\n';
        }
        // The corner of the film, as a real image height.
        const double corner = 0.5 * hypotenuse(lens_.film_width, lens_.film_height);
        head += "FTYP 3 0 2 1 0 0 0\nXFLN 0 0\nYFLN 0 " + exact_number(corner) + "\nWAVM 1 " +
                exact_number(lens_.wavelength_nm / 1000) + " 1\nPWAV 1\n";
        const double object = lens_.focus_distance - lens_.film_position();
        head += "SURF 0\n  TYPE STANDARD\n  CURV 0\n  DISZ " +
                (std::isfinite(object) ? exact_number(object) : std::string("INFINITY")) + "\n  DIAM 0 0 0 0 1 \"\"\n";
        const std::string image = "SURF " + std::to_string(count_ + 1) + "\n  TYPE STANDARD\n  CURV " +
                                  exact_number((lens_.film_distance < 0 ? -1 : 1) / lens_.film_radius_of_curvature) +
                                  "\n  DISZ 0\n  DIAM " + exact_number(corner) + " 0 0 0 1 \"\"\n";
        result_.text = head + surfaces_ + image + zoom_;
        return std::move(result_);
    }

private:
    void line(const std::string& text) { surfaces_ += "  " + text + '\n'; }

    void write_surface(std::size_t i) {
        const Surface& s = lens_.surfaces[i];
        const bool is_last = i + 1 == lens_.surfaces.size();
        const bool is_moved = !s.placement.is_in_place(), returns = is_moved && s.placement.returns;
        if (is_moved) write_break(s.placement);
        surfaces_ += "SURF " + std::to_string(++count_) + '\n';
        if (s.type == SurfaceType::stop) line("STOP");
        const bool bends = s.bends_light(), is_asphere = bends && s.is_asphere() && s.form.is_none();
        const ZemaxShape shape = zemax_shape_of(s);
        line("TYPE " + shape.type);
        line("CURV " + exact_number(bends ? s.curvature : 0.0) + " 0 0 0 0 \"\"");
        for (const std::string& parameter : shape.lines) line(parameter);
        for (const std::string& what : shape.left_out)
            result_.warnings.push_back("surface " + std::to_string(i + 1) + ' ' + what);
        if (is_asphere) {
            // Parameter 1 is the term of r^2; there are eight, up to r^16.
            line("PARM 1 0");
            for (std::size_t k = 0; k < s.aspheric.size(); ++k) {
                if (s.aspheric[k] == 0) continue;
                line("PARM " + std::to_string(k + 2) + ' ' + exact_number(s.aspheric[k]));
                if (k + 2 > 8)
                    result_.warnings.push_back("surface " + std::to_string(i + 1) +
                                               " has an aspheric term of r^18, which OpticStudio's even asphere lacks");
            }
        }
        const double thickness = is_last ? lens_.film_distance : s.thickness;
        line("DISZ " + exact_number(returns ? 0.0 : thickness));
        if (s.type == SurfaceType::mirror)
            line("GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0");
        else if (const Glass& behind = medium_behind(i); !behind.is_air())
            line("GLAS " + glass(behind));
        if (bends && s.conic != 0) line("CONI " + exact_number(s.conic));
        const double rim = s.type == SurfaceType::stop ? lens_.stop_semi_diameter : s.clear_semi_diameter;
        line("DIAM " + exact_number(rim) + " 1 0 0 1 \"\"");
        if (!s.aperture_shape.is_plain())
            for (const std::string& aperture : shape.aperture) line(aperture);
        else if (s.type == SurfaceType::aperture || s.inner_semi_diameter > 0)
            line("CLAP " + exact_number(s.inner_semi_diameter) + ' ' + exact_number(s.clear_semi_diameter) + " 0");
        else if (s.type != SurfaceType::stop)
            line("FLAP 0 " + exact_number(s.clear_semi_diameter) + " 0");
        if (returns) write_return(s.placement, thickness);
    }

    void write_break_line(const std::vector<double>& parameters, double thickness) {
        surfaces_ += "SURF " + std::to_string(++count_) + '\n';
        line("TYPE COORDBRK");
        line("CURV 0 0 0 0 0 \"\"");
        for (std::size_t k = 0; k < parameters.size(); ++k)
            line("PARM " + std::to_string(k + 1) + ' ' + exact_number(parameters[k]));
        line("DISZ " + exact_number(thickness));
        line("DIAM 0 0 0 0 1 \"\"");
    }

    /// Writes a coordinate break. The shift along the axis comes first: after a break it would be along the new axis.
    void write_break(const SurfacePlacement& place) {
        const auto& [decentre, tilt, returns] = place;
        if (decentre.z != 0) write_break_line({0, 0, 0, 0, 0, 0}, decentre.z);
        write_break_line({decentre.x, decentre.y, tilt.x, tilt.y, tilt.z, 0}, 0);
    }

    /// Writes the reverse of a coordinate break. With order 1 a break applies its steps in reverse order.
    void write_return(const SurfacePlacement& place, double thickness) {
        const auto& [decentre, tilt, returns] = place;
        write_break_line({-decentre.x, -decentre.y, -tilt.x, -tilt.y, -tilt.z, 1}, thickness - decentre.z);
    }

    /// Returns the medium behind a surface. A stop or an aperture inside a glass has it on both sides.
    const Glass& medium_behind(std::size_t i) const {
        for (std::size_t k = i + 1; k-- > 0;)
            if (lens_.surfaces[k].type == SurfaceType::refracting) return lens_.surfaces[k].material;
        static const Glass air = Glass::air();
        return air;
    }

    std::string glass(const Glass& glass) {
        if (const auto known = catalogue_name_of(glass); known && is_unique(*known)) {
            std::string maker = known->maker;
            for (char& c : maker) c = static_cast<char>(c - 'a' + 'A');
            makers_.insert(maker);
            return known->name + " 0 0 " + exact_number(glass.index(kLineD_nm)) + ' ' +
                   exact_number(abbe_pair(glass).v_d) + " 0 0 0 0 0 0";
        }
        const AbbePair pair = abbe_pair(glass);
        Glass model = glass_of_pair(pair.n_d, pair.v_d);
        if (const auto shared = catalogue_name_of(glass); shared && told_.insert(glass.label).second)
            result_.warnings.push_back("that the glass " + in_quotes(glass.label) +
                                       " is that maker's, as another maker in the file has the name too: it is written "
                                       "by n_d and V_d");
        if (told_.insert(glass.label).second &&
            std::fabs(model.index(lens_.wavelength_nm) - glass.index(lens_.wavelength_nm)) > 1e-9)
            result_.warnings.push_back("the glass " + in_quotes(glass.label) +
                                       " is written by n_d and V_d, which at other wavelengths is not exact");
        return "___BLANK 1 0 " + exact_number(pair.n_d) + ' ' + exact_number(pair.v_d) + " 0 0 0 0 0 0";
    }

    /// True if no other maker in the file has another glass of this name. A file lists the makers of all of its glasses
    /// together.
    bool is_unique(const CatalogueName& known) const {
        std::set<std::string> makers;
        for (const Surface& s : lens_.surfaces)
            if (const auto other = catalogue_name_of(s.material)) makers.insert(other->maker);
        return std::ranges::none_of(catalogue_names_like(known.name), [&](const CatalogueName& other) {
            return other.maker != known.maker && makers.contains(other.maker);
        });
    }

    void write_zoom() {
        const ZoomRange& zoom = lens_.zoom;
        if (zoom.positions.empty()) return;
        if (count_ != static_cast<int>(lens_.surfaces.size())) {
            result_.warnings.push_back("zoom positions, because surfaces are tilted or decentred");
            return;
        }
        zoom_ = "MNUM " + std::to_string(zoom.positions.size()) + ' ' + std::to_string(zoom.current + 1) + '\n';
        const auto add = [&](const std::string& name, int surface, std::size_t position, double value) {
            zoom_ += name + ' ' + std::to_string(surface) + ' ' + std::to_string(position + 1) + ' ' +
                     (std::isfinite(value) ? exact_number(value) : std::string("INFINITY")) +
                     " 0 0 0 1 1 1 0 0 \"\" 0\n";
        };
        const std::size_t count = zoom.positions.size();
        // The current position has the lens unchanged; in the others it is focused at their rest distance.
        const auto state = [&](std::size_t k) {
            return static_cast<int>(k) == zoom.current ? lens_ : at_zoom_position(lens_, static_cast<int>(k));
        };
        for (std::size_t j = 0; j < zoom.surfaces.size(); ++j)
            for (std::size_t k = 0; k < count; ++k)
                add("THIC", zoom.surfaces[j] + 1, k,
                    state(k).surfaces[static_cast<std::size_t>(zoom.surfaces[j])].thickness);
        for (std::size_t k = 0; k < count; ++k)
            add("THIC", static_cast<int>(lens_.surfaces.size()), k, state(k).film_distance);
        for (std::size_t k = 0; k < count; ++k) {
            const LensSystem there = state(k);
            add("THIC", 0, k, there.focus_distance - there.film_position());
        }
        for (std::size_t k = 0; k < count; ++k)
            add("APER", 0, k, first_order(state(k), lens_.wavelength_nm).entrance_pupil_diameter);
        std::string names;
        for (const ZoomPosition& position : zoom.positions)
            names += (names.empty() ? "" : ", ") + in_quotes(position.name);
        result_.warnings.push_back("the zoom positions " + names + " are numbered");
    }

    const LensSystem& lens_;
    int count_ = 0;  ///< number of surfaces written, including coordinate breaks
    LensText result_;
    std::string surfaces_, zoom_;
    std::set<std::string> makers_, told_;
};

}  // namespace

std::vector<std::string> left_out_of_foreign_files(const LensSystem& lens, const std::string& format) {
    std::vector<std::string> list;
    const std::string none = ", which a " + format + " file has no word for";
    std::string coated, holes;
    for (std::size_t i = 0; i < lens.surfaces.size(); ++i)
        if (!(lens.surfaces[i].coating == Coating())) coated += (coated.empty() ? "" : ", ") + std::to_string(i + 1);
    if (!coated.empty()) list.push_back("the coatings of surfaces " + coated + none);
    if (lens.iris.blades != 0)
        list.push_back("the " + std::to_string(lens.iris.blades) + " blades of the diaphragm" + none);
    if (lens.focusing.moves_group() || lens.focusing.nearest_mm > 0) list.push_back("how the lens focuses" + none);
    if (lens.stop_semi_diameter < lens.stop().clear_semi_diameter)
        list.push_back("how far the diaphragm opens: it is written as it is closed");
    if (!lens.source.empty()) list.push_back("the source of the lens" + none);
    if (std::fabs(lens.film_width * 2 - lens.film_height * 3) > 1e-9 * lens.film_width)
        list.push_back("the film's shape: it is written as the height of its corner");
    if (lens.allow_crossing) list.push_back("that faces may cross" + none);
    return list;
}

LensText lens_as_zemax(const LensSystem& lens) {
    return ZemaxWriter(lens).write();
}

}  // namespace realcam::io
