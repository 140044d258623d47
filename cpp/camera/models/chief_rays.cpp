#include "chief_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../../math/fill_unknown.hpp"
#include "../../math/hypotenuse.hpp"
#include "../../optics/lens/chief_ray.hpp"
#include "../../optics/trace/film_frame.hpp"
#include "generate_rays.hpp"
#include "pinhole_camera.hpp"

namespace realcam {
namespace {

constexpr int kSteps = 512;  ///< steps of the film radius; cubics between them are exact to 1e-8 rad
constexpr int kColumns = 48, kRows = 32;  ///< cells of the grid for lenses without rotational symmetry

using Values = SmoothGrid<6>::Values;

/// Line of a ray whose points are relative to the origin of `centre`.
RayLine line_through(Vec3d point, Vec3d direction, Vec3d centre) {
    const Vec3d unit = normalized(direction), from = point - centre;
    return {unit, point - dot(from, unit) * unit};
}

}  // namespace

LensChiefRays::LensChiefRays(const Camera& camera, const CameraView& view)
    : view_(view), centre_(centre_of_projection_mm(camera)), film_centre_{0, 0, camera_film_position(camera.lens)} {
    if (has_real_pupil(camera.model)) surfaces_.emplace(camera.lens, camera.lens.wavelength_nm);
}

std::optional<RayLine> LensChiefRays::trace(Vec2<double> film) const {
    if (surfaces_) {
        const std::optional<ChiefRay> ray = chief_ray_of_film_point(*surfaces_, film);
        return ray ? std::optional(line_of(*ray)) : std::nullopt;
    }
    const LensFrameRay ray = ideal_chief_ray(view_, {static_cast<float>(film.x), static_cast<float>(film.y)});
    const Vec3d front = {0, 0, -1000.0 * static_cast<double>(view_.front_vertex_m)};
    return line_through(front + static_cast<Vec3d>(ray.origin_mm), static_cast<Vec3d>(ray.direction), centre_);
}

std::vector<RayLine> LensChiefRays::trace_meridian(double film_radius, int steps) const {
    std::vector<RayLine> lines;
    MeridionalChiefRays chief_rays(*surfaces_);
    for (int k = 0; k <= steps; ++k) {
        const std::optional<ChiefRay> ray = chief_rays.next(k * film_radius / steps);
        if (!ray) break;
        lines.push_back(line_of(*ray));
    }
    return lines;
}

RayLine LensChiefRays::line_of(const ChiefRay& ray) const {
    return line_through(ray.scene - film_centre_, -ray.scene_direction, centre_);
}

ChiefRays::ChiefRays(const Camera& camera, const CameraView& view, double margin) : traced_(camera, view) {
    if (traced_.is_ideal()) return;
    if (camera.lens.is_rotational())
        radial_ = radial_rays(camera.film.radius_mm() * (1 + 2 * margin));
    else
        plane_ = plane_rays(camera.film, margin);
    if (!radial_ && !plane_)
        throw InputError("lens \"" + camera.lens.name + "\" has no chief rays, which a calibration moves");
}

RayLine ChiefRays::at(Vec2<double> film) const {
    if (plane_) {
        const auto limited = [](double position, int nodes) { return std::clamp(position, 0.0, nodes - 1.0); };
        const Values ray = plane_->grid
                               .at(limited((film.x - plane_->first.x) * plane_->cells_per_mm.x, plane_->grid.columns()),
                                   limited((film.y - plane_->first.y) * plane_->cells_per_mm.y, plane_->grid.rows()))
                               .value;
        return line_through({ray[3], ray[4], ray[5]}, {ray[0], ray[1], ray[2]}, traced_.centre());
    }
    if (!radial_) return *traced_.trace(film);
    const double radius = hypotenuse(film.x, film.y),
                 step = std::min(radius * radial_->steps_per_mm, radial_->angle.count() - 1.0);
    const Vec2<double> away = radius > 0 ? Vec2<double>{-film.x / radius, -film.y / radius} : Vec2<double>{0, 0};
    const double angle = radial_->angle.at(step).value, offset = radial_->offset.at(step).value,
                 cosine = std::cos(angle), sine = std::sin(angle);
    return {{away.x * sine, away.y * sine, -cosine},
            traced_.centre() + offset * Vec3d{away.x * cosine, away.y * cosine, sine}};
}

std::optional<ChiefRays::Radial> ChiefRays::radial_rays(double film_radius) const {
    std::vector<double> angles, offsets;
    for (const RayLine& ray : traced_.trace_meridian(film_radius, kSteps)) {
        const bool is_axis = angles.empty();
        // A film point at +y sees scene points at -y.
        const double angle = std::atan2(-ray.direction.y, -ray.direction.z);
        const Vec3d foot = ray.foot - traced_.centre();
        angles.push_back(is_axis ? 0 : angle);
        offsets.push_back(is_axis ? 0 : -foot.y * std::cos(angle) + foot.z * std::sin(angle));
    }
    if (angles.size() < 3) return std::nullopt;
    for (std::vector<double>* values : {&angles, &offsets})
        while (values->size() <= static_cast<std::size_t>(kSteps))
            values->push_back(2 * values->back() - (*values)[values->size() - 2]);
    return Radial{OddCurve(std::move(angles)), OddCurve(std::move(offsets)), kSteps / film_radius};
}

std::optional<ChiefRays::Plane> ChiefRays::plane_rays(const Film& film, double margin) const {
    const double width = film.width_mm * (1 + 2 * margin), height = film.height_mm * (1 + 2 * margin);
    const Vec2<double> first = {-film.shift_mm.x - 0.5 * width, -film.shift_mm.y - 0.5 * height};
    std::vector<Values> nodes;
    bool has_rays = false;
    for (int row = 0; row <= kRows; ++row)
        for (int column = 0; column <= kColumns; ++column) {
            const std::optional<RayLine> ray =
                traced_.trace({first.x + column * width / kColumns, first.y + row * height / kRows});
            Values& values = nodes.emplace_back();
            values.fill(std::numeric_limits<double>::quiet_NaN());
            if (!ray) continue;
            values = {ray->direction.x, ray->direction.y, ray->direction.z, ray->foot.x, ray->foot.y, ray->foot.z};
            has_rays = true;
        }
    if (!has_rays) return std::nullopt;
    fill_unknown(nodes, kColumns + 1);
    return Plane{SmoothGrid<6>(kColumns + 1, kRows + 1, nodes), first, {kColumns / width, kRows / height}};
}

}  // namespace realcam
