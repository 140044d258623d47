#pragma once
#include <optional>
#include <vector>

#include "../models/camera_view.hpp"

namespace REALCAM_NAMESPACE {

/// Projects scene points into a camera's picture by its pixel-centre rays, which pass through the centre of the pupil.
/// The lens is rotationally symmetric, so the rays along one film radius represent all.
class PictureMap {
public:
    /// `camera`: its arrays must be in host memory.
    explicit PictureMap(const CameraView& camera);

    /// Pixel coordinates, from the upper left corner of the picture, of a point in metres, or of a direction for a
    /// point at infinity. Both are in the axes of the camera: x right, y up, z backward from the centre of the film.
    /// Returns std::nullopt if no pixel-centre ray goes there.
    std::optional<Vec2<double>> pixel_of(Vec3d point, bool is_direction) const;

private:
    static constexpr int kRadii = 512;

    /// Pixel-centre ray in the meridional plane.
    struct Ray {
        double film_mm;
        double x, z, along_x, along_z;
    };

    /// Signed distance of a point from a ray, positive outwards.
    static double beside(const Ray& ray, double radius, double z, bool is_direction);

    std::optional<double> film_radius(double radius, double z, bool is_direction) const;

    double pixels_per_mm_x_, pixels_per_mm_y_;
    Vec2<double> axis_;  ///< pixel coordinates of the lens's axis
    std::vector<Ray> rays_;  ///< in order of increasing film radius
};

}  // namespace REALCAM_NAMESPACE
