#include "pupil_lens.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "../trace/open_iris.hpp"

namespace realcam {

void PupilRays::set(int lane, Vec2<double> film, PupilDirection d) {
    x[lane] = film.x;
    y[lane] = film.y;
    l[lane] = d.l;
    m[lane] = d.m;
}

PupilLens::PupilLens(const LensSystem& lens, LensSystem traced, PupilTracer tracer,
                     const std::vector<double>& wavelengths_nm)
    : lens_(std::move(traced)),
      ends_(film_path_ends(lens_, LightDirection::to_scene)),
      path_(lens_, LightDirection::to_scene, wavelengths_nm.empty() ? lens.wavelength_nm : wavelengths_nm.front(),
            ends_),
      film_{static_cast<float>(lens.film_distance), static_cast<float>(1 / lens.film_radius_of_curvature)},
      tracer_(std::move(tracer)) {
    for (std::size_t i = 1; i < wavelengths_nm.size(); ++i)
        others_.emplace_back(lens_, LightDirection::to_scene, wavelengths_nm[i], ends_);
    const LensView<float> all = path_.view();
    surfaces_to_stop_.assign(all.surfaces, all.surfaces + all.count - lens_.stop_index());
    surfaces_to_stop_.back().rim_squared = std::numeric_limits<float>::max();
    if (!all.free.frames) return;
    frames_to_stop_.assign(all.free.frames, all.free.frames + surfaces_to_stop_.size());
    frames_to_stop_.back().out = {};  // rays stay in the frame of the stop
    last_surface_ = inverse_motion(*ends_.entry) * surface_frames(lens_).surfaces.back();
}

void PupilLens::trace(const PupilRays& start, bool* passes) const {
    PupilTracer::Rays rays;
    trace(path_.view(), start, rays);
    REALCAM_LANES
    for (int i = 0; i < kBlock; ++i) passes[i] = rays.status[i] == 0;
    for (const LensPath<float>& other : others_) {
        trace(other.view(), start, rays);
        REALCAM_LANES
        for (int i = 0; i < kBlock; ++i) passes[i] |= rays.status[i] == 0;
    }
}

void PupilLens::trace_to_stop(const PupilRays& start, PupilTracer::Rays& rays) const {
    LensView<float> view = path_.view();
    view.surfaces = surfaces_to_stop_.data();
    view.count = static_cast<int>(surfaces_to_stop_.size());
    if (!frames_to_stop_.empty()) view.free.frames = frames_to_stop_.data();
    trace(view, start, rays);
}

DirectionBox PupilLens::box_of_last_surface(Vec2<double> film_point, FilmMap film_map) const {
    const Surface& last = lens_.surfaces.back();
    const FilmSurface<double> film{lens_.film_distance, 1 / lens_.film_radius_of_curvature};
    const Vec3d start = film.point(film_point), x = film.direction(film_point, {1, 0, 0}),
                y = film.direction(film_point, {0, 1, 0});
    DirectionBox box = DirectionBox::empty();
    for (int ring = 0; ring <= 8; ++ring) {
        const double r = last.clear_semi_diameter * ring / 8, z = last.sag(r);
        for (int azimuth = 0; azimuth < (film_map == FilmMap::radial ? 17 : 32); ++azimuth) {
            const double angle = std::numbers::pi * azimuth / 16;
            const Vec3d d = path_.entry_index *
                            normalized(last_surface_.point({r * std::cos(angle), r * std::sin(angle), z}) - start);
            box = box.extended_to({dot(d, x), dot(d, y)});
        }
    }
    return box;
}

LensSystem PupilLens::round_iris(LensSystem lens) {
    const double rim = lens.stop().clear_semi_diameter;
    if (lens.iris.blades > 0 && !lens.is_wide_open()) {
        // Distance from the axis to the corner between two blades, which are arcs with apothem h and curvature q.
        const Iris<double> open = open_iris(lens.iris, lens.stop_semi_diameter, rim);
        const double h = open.apothem, q = open.curvature;
        const double linear = (1 - q * h) * std::cos(std::numbers::pi / open.blades), constant = 2 * h - q * h * h;
        lens.stop_semi_diameter = std::min(rim, constant / (linear + std::sqrt(linear * linear + q * constant)));
    }
    lens.iris.blades = 0;
    return lens;
}

void PupilLens::trace(const LensView<float>& view, const PupilRays& start, PupilTracer::Rays& rays) const {
    const double n2 = index_squared();
    REALCAM_LANES
    for (int i = 0; i < kBlock; ++i) {
        const double l = start.l[i], m = start.m[i], squared = n2 - l * l - m * m;
        rays.origin.set(i, static_cast<Vec3f>(Vec3d{start.x[i], start.y[i], lens_.film_distance}));
        rays.direction.set(i, static_cast<Vec3f>(Vec3d{l, m, -sqrt_or_zero(squared)}));
        rays.status[i] = squared > 0 ? 0 : static_cast<int>(RayStatus::missed);
    }
    if (film_.curvature != 0) {
        REALCAM_LANES
        for (int i = 0; i < kBlock; ++i) {
            const Vec2f film_point = {rays.origin.x[i], rays.origin.y[i]};
            rays.direction.set(i, film_.direction(film_point, rays.direction[i]));
            rays.origin.z[i] = film_.point(film_point).z;
        }
    }
    tracer_.trace(view, rays);
}

}  // namespace realcam
