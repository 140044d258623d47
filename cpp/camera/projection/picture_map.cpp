#include "picture_map.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../models/bundle_motions.hpp"
#include "../models/pixel_centre_rays.hpp"

namespace realcam {

PictureMap::PictureMap(const CameraView& camera)
    : bundles_(camera.bundles),
      pixels_per_mm_x_(0.5 * camera.width / static_cast<double>(camera.film_half_width)),
      pixels_per_mm_y_(0.5 * camera.height / static_cast<double>(camera.film_half_height)),
      axis_{0.5 * camera.width + pixels_per_mm_x_ * static_cast<double>(camera.film_centre.x),
            0.5 * camera.height - pixels_per_mm_y_ * static_cast<double>(camera.film_centre.y)} {
    // Auxiliary film behind the same lens: one row of pixels, with corners of the film at both ends.
    CameraView along = camera;
    static_cast<CameraFrame&>(along) = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    along.keys = nullptr;
    along.key_count = 0;
    along.bundles = {};
    const float corner = hypotenuse(camera.film_half_width + std::fabs(camera.film_centre.x),
                                    camera.film_half_height + std::fabs(camera.film_centre.y));
    along.film_centre = {0, 0};
    along.width = 2 * kRadii;
    along.height = 1;
    along.film_half_width = corner;
    along.film_half_height = 1e-6f * corner;
    SampleBlock<1> block{};
    CameraRays<1> rays;
    float time[1];
    block.used[0] = 1;
    // Columns from the middle to the right, which show scene points at x > 0.
    for (int k = 0; k < kRadii; ++k) {
        block.column[0] = kRadii + k;
        pixel_centre_rays(along, block, rays, time);
        if (!rays.passed[0]) continue;
        const Vec3d origin = static_cast<Vec3d>(rays.origin[0]), direction = static_cast<Vec3d>(rays.direction[0]);
        rays_.push_back(
            {(k + 0.5) * static_cast<double>(corner) / kRadii, origin.x, origin.z, direction.x, direction.z});
    }
}

std::optional<Vec2<double>> PictureMap::pixel_of(Vec3d point, bool is_direction) const {
    const std::optional<Vec2<double>> film =
        bundles_.nodes ? calibrated_film_point(bundles_, point, is_direction,
                                               [&](Vec3d moved) { return lens_film_point(moved, is_direction); })
                       : lens_film_point(point, is_direction);
    if (!film) return std::nullopt;
    return Vec2<double>{axis_.x - pixels_per_mm_x_ * film->x, axis_.y + pixels_per_mm_y_ * film->y};
}

std::optional<Vec2<double>> PictureMap::lens_film_point(Vec3d point, bool is_direction) const {
    const double radius = hypotenuse(point.x, point.y);
    const std::optional<double> film = film_radius(radius, point.z, is_direction);
    if (!film) return std::nullopt;
    const double scale = radius > 0 ? *film / radius : 0;
    return Vec2<double>{-scale * point.x, -scale * point.y};
}

double PictureMap::signed_distance(const Ray& ray, double radius, double z, bool is_direction) {
    const double x = is_direction ? radius : radius - ray.x, depth = is_direction ? z : z - ray.z;
    return depth * ray.along_x - x * ray.along_z;
}

std::optional<double> PictureMap::film_radius(double radius, double z, bool is_direction) const {
    if (rays_.empty()) return std::nullopt;
    const auto is_ahead = [&](const Ray& ray) {
        const double x = is_direction ? radius : radius - ray.x, depth = is_direction ? z : z - ray.z;
        return x * ray.along_x + depth * ray.along_z > 0;
    };
    double before = signed_distance(rays_.front(), radius, z, is_direction);
    // Linear interpolation between the axis and the first ray.
    if (before <= 0 && is_ahead(rays_.front())) {
        return rays_.front().film_mm * radius / (radius - before);
    }
    for (std::size_t k = 1; k < rays_.size(); ++k) {
        const double here = signed_distance(rays_[k], radius, z, is_direction);
        if (before > 0 && here <= 0 && is_ahead(rays_[k])) {
            const double fraction = before / (before - here);
            return rays_[k - 1].film_mm + fraction * (rays_[k].film_mm - rays_[k - 1].film_mm);
        }
        before = here;
    }
    return std::nullopt;
}

}  // namespace realcam
