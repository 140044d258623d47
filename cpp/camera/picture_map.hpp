#pragma once
#include <optional>
#include <vector>

#include "camera_view.hpp"

namespace REALCAM_NAMESPACE {

/// Where points of a scene appear in a camera's picture, by its middle rays. These go from the film through the middle
/// of the pupil. Those along one radius of the film stand for all, because lenses are round.
class PictureMap {
public:
    /// `camera` points to memory of the host.
    explicit PictureMap(const CameraView& camera);

    /// Column and row, counted from the upper left corner of the picture, of a point in metres, or of a direction for a
    /// point at infinity. Both are in the axes of the camera: x right, y up, z backward from the middle of the film.
    /// Nothing where no middle ray goes there.
    std::optional<Vec2<double>> pixel_of(Vec3d point, bool is_direction) const;

private:
    static constexpr int kRadii = 512;

    /// A middle ray in the plane of the axis.
    struct Ray {
        double film_mm;
        double x, z, along_x, along_z;
    };

    /// How far beside a ray a point lies, above 0 outwards.
    static double beside(const Ray& ray, double radius, double z, bool is_direction);

    std::optional<double> film_radius(double radius, double z, bool is_direction) const;

    double pixels_per_mm_x_, pixels_per_mm_y_;
    Vec2<double> axis_;  ///< where the lens's axis meets the picture
    std::vector<Ray> rays_;  ///< from the middle outwards
};

}  // namespace REALCAM_NAMESPACE
