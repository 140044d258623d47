#include "lens_system.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

int LensSystem::stop_index() const {
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        if (surfaces[i].type == SurfaceType::stop) return static_cast<int>(i);
    return -1;
}

std::string LensSystem::asymmetry() const {
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        if (const std::string why = surfaces[i].asymmetry(); !why.empty())
            return "surface " + std::to_string(i + 1) + ' ' + why;
    if (!film_placement.is_in_place()) return "its film is tilted or moved";
    const auto is_mirror = [](const Surface& s) { return s.type == SurfaceType::mirror; };
    return film_distance < 0 && std::ranges::count_if(surfaces, is_mirror) % 2 == 1
               ? "its film lies before its last mirror"
               : "";
}

void LensSystem::require_rotational(const std::string& what) const {
    if (const std::string why = asymmetry(); !why.empty())
        throw InputError(what + " needs a rotationally symmetric lens; " + why);
}

std::vector<double> LensSystem::vertices() const {
    std::vector<double> z(surfaces.size(), 0.0);
    for (std::size_t i = 1; i < surfaces.size(); ++i) z[i] = z[i - 1] + surfaces[i - 1].thickness;
    return z;
}

double LensSystem::last_vertex() const {
    double z = 0;
    for (std::size_t i = 0; i + 1 < surfaces.size(); ++i) z += surfaces[i].thickness;
    return z;
}

std::vector<double> LensSystem::indices(double wavelength_nm) const {
    std::vector<double> n(surfaces.size() + 1, 1.0);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Surface& s = surfaces[i];
        n[i + 1] = s.type == SurfaceType::refracting ? s.material.index(wavelength_nm) : n[i];
        // The limits are beyond those of any medium. The comparisons also catch NaN.
        if (!(n[i + 1] > 0.1) || !(n[i + 1] < 100))
            throw InputError("the material of surface " + std::to_string(i + 1) +
                             (s.material.label.empty() ? "" : " (" + s.material.label + ")") +
                             " has no refractive index at " + std::to_string(std::lround(wavelength_nm)) + " nm");
    }
    return n;
}

LensSystem at_zoom_position(LensSystem lens, int position) {
    const ZoomPosition& target = lens.zoom.positions[static_cast<std::size_t>(position)];
    for (std::size_t i = 0; i < lens.zoom.surfaces.size(); ++i)
        lens.surfaces[static_cast<std::size_t>(lens.zoom.surfaces[i])].thickness = target.thicknesses[i];
    Surface& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index())];
    if (target.stop_semi_diameter > 0) stop.clear_semi_diameter = target.stop_semi_diameter;
    lens.stop_semi_diameter = stop.clear_semi_diameter;
    lens.film_distance = target.film_distance;
    lens.focus_distance = target.focus_distance;
    lens.zoom.current = position;
    return lens;
}

LensSystem centred(LensSystem lens) {
    for (Surface& surface : lens.surfaces) {
        surface.placement = {};
        if (!surface.form.asymmetry().empty()) surface.form = {};
        if (!surface.aperture_shape.asymmetry().empty()) surface.aperture_shape = {};
    }
    lens.film_placement = {};
    return lens;
}

namespace {

const Surface& surface_of(const LensSystem& lens, int index) {
    return lens.surfaces[static_cast<std::size_t>(index)];
}

}  // namespace

SurfaceFrames surface_frames(const LensSystem& lens) {
    SurfaceFrames result;
    Affine<double> axis;
    for (const Surface& s : lens.surfaces) {
        const Affine<double> frame = axis * s.placement.frame();
        result.surfaces.push_back(frame);
        if (!s.placement.returns) axis = frame;
        result.last_axis = axis;
        axis = axis * along_axis(s.thickness);
    }
    return result;
}

Affine<double> frame_of_next(const LensSystem& lens, int index) {
    const Surface &surface = surface_of(lens, index), &next = surface_of(lens, index + 1);
    const Affine<double> to_next = along_axis(surface.thickness) * next.placement.frame();
    return surface.placement.returns ? inverse_motion(surface.placement.frame()) * to_next : to_next;
}

}  // namespace realcam
