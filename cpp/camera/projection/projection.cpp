#include "projection.hpp"

#include <cmath>
#include <utility>

namespace realcam {

Projection::Projection(const Camera& camera, std::shared_ptr<const ProjectionRays> rays)
    : film_(camera.film), rays_(std::move(rays)) {
    const TimeInterval exposure = camera.exposure();
    const double row_time = camera.moves() ? camera.shutter.readout_time_s / film_.height : 0;
    const double begin = exposure.begin_s + 0.5 * camera.seen_time();
    const int rows = row_time > 0 ? film_.height : 1;
    for (int row = 0; row < rows; ++row)
        scene_from_camera_.push_back(camera_detail::scene_from_camera(pose_at(camera, begin + row * row_time)));
}

ProjectedPoint Projection::pixel_of(Vec3d point_m) const {
    if (!std::isfinite(point_m.x) || !std::isfinite(point_m.y) || !std::isfinite(point_m.z))
        return {kNoPixel, ProjectionStatus::bad_input};
    if (scene_from_camera_.size() == 1) return project_from_pose(scene_from_camera_.front(), point_m);
    // Rolling shutter: the row determines the time, and the time determines the row. Iterated until they agree.
    int row = static_cast<int>(scene_from_camera_.size()) / 2;
    ProjectedPoint found{};
    for (int i = 0; i < kMaxIterations; ++i) {
        found = project_from_pose(scene_from_camera_[static_cast<std::size_t>(row)], point_m);
        const int next = std::isfinite(found.pixel.y) ? row_of(found.pixel.y) : row;
        if (next == row) break;
        row = next;
    }
    return found;
}

PixelRay Projection::ray_of(Vec2<double> pixel) const {
    const Affine<double>& scene_from_camera =
        scene_from_camera_[scene_from_camera_.size() == 1 ? 0 : static_cast<std::size_t>(row_of(pixel.y))];
    const std::optional<FilmProjection> ray = rays_->ray(film_.point_of(pixel));
    if (!ray) return {kNoVector, kNoVector};
    return {scene_from_camera.point(0.001 * ray->origin), scene_from_camera.direction(ray->direction), ray->light};
}

ProjectedPoint Projection::project_from_pose(const Affine<double>& scene_from_camera, Vec3d point_m) const {
    const Vec3d from = 1000.0 * (point_m - scene_from_camera.origin);
    const Vec3d point = {dot(from, scene_from_camera.x), dot(from, scene_from_camera.y),
                         dot(from, scene_from_camera.z)};
    const std::optional<Vec2<double>> at = rays_->project(point);
    if (!at) {
        if (!rays_->is_in_front(point)) return {kNoPixel, ProjectionStatus::behind};
        return {kNoPixel, rays_->ends_in_film() ? ProjectionStatus::blocked : ProjectionStatus::outside_picture};
    }
    const Vec2<double> pixel = film_.pixel_of(*at);
    const bool inside = pixel.x >= 0 && pixel.x <= film_.width && pixel.y >= 0 && pixel.y <= film_.height;
    return {pixel, inside ? ProjectionStatus::ok : ProjectionStatus::outside_picture};
}

}  // namespace realcam
