#pragma once
#include <optional>
#include <vector>

#include "../models/camera_view.hpp"

namespace REALCAM_NAMESPACE {

/// Projects scene points into a camera's picture by its pixel-centre rays, which pass through the centre of the pupil.
/// The lens is rotationally symmetric, so the rays along one film radius represent all. A calibrated camera moves them.
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
        double film_mm;  ///< film radius of its pixel
        double x, z;  ///< where it leaves the lens, from the centre of the film, metres
        double along_x, along_z;  ///< unit direction towards the scene
    };

    /// Signed distance of a point from a ray, metres, positive outwards; for a direction, the sine of the angle between
    /// them. `radius`: distance of the point from the axis.
    static double signed_distance(const Ray& ray, double radius, double z, bool is_direction);

    /// Film radius, mm, whose ray passes through a point or has a direction, interpolated between neighbouring rays.
    /// Returns std::nullopt if no ray does.
    std::optional<double> film_radius(double radius, double z, bool is_direction) const;

    /// Film point, mm in the lens's axes, of a point for the lens without a calibration.
    std::optional<Vec2<double>> lens_film_point(Vec3d point, bool is_direction) const;

    BundleMotionsView bundles_;
    double pixels_per_mm_x_, pixels_per_mm_y_;
    Vec2<double> axis_;  ///< pixel coordinates of the lens's axis
    std::vector<Ray> rays_;  ///< in order of increasing film radius
};

}  // namespace REALCAM_NAMESPACE
