#pragma once
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "../film/camera.hpp"

namespace REALCAM_NAMESPACE {

class CameraSetup;

/// Projection ray: the ray that represents all light of a film point.
enum class ProjectionRay {
    light,  ///< centroid ray, for whose point in focus the light's centroid is the film point (centroid_ray.hpp)
    chief,  ///< chief ray, through the centre of the stop, even if a rim blocks it
};

/// Projection ray from the lens into the scene, in the camera's axes, mm from the centre of the unshifted film.
struct FilmProjection {
    Vec3d origin;     ///< point at which it leaves the lens
    Vec3d direction;  ///< unit vector
    double light;  ///< irradiance for a uniform scene, relative to the film centre
};

/// Projection of a camera: maps film points to rays in the scene, and scene points to film points. Film coordinates in
/// mm: x to the right, y up, as in the developed image.
class ProjectionRays {
public:
    virtual ~ProjectionRays() = default;

    /// Returns std::nullopt if no light reaches the film point, and beyond the corners of the film.
    virtual std::optional<FilmProjection> ray(Vec2<double> film) const = 0;
    /// Film point whose ray passes through a scene point, which is in the frame of FilmProjection. Returns std::nullopt
    /// if no ray does.
    virtual std::optional<Vec2<double>> project(Vec3d point) const = 0;
    /// True if a point lies farther in front than the entrance pupil.
    virtual bool is_in_front(Vec3d point) const = 0;
    /// True if the lens's image ends within the film.
    virtual bool ends_in_film() const = 0;
};

/// Result of projecting a scene point onto the film.
enum class ProjectionStatus {
    ok,
    outside_picture,  ///< its image lies outside the film
    blocked,  ///< it lies in front of the lens, but none of its light reaches the film plane
    behind,  ///< it lies behind or inside the lens
    bad_input,  ///< a coordinate is not finite
};

/// Pixel coordinates from the upper left corner of the picture: the centre of the first pixel is (0.5, 0.5).
struct ProjectedPoint {
    Vec2<double> pixel;  ///< NaN if no projection ray passes through the scene point
    ProjectionStatus status;
};

/// Projection ray from the lens into the scene, metres.
struct PixelRay {
    Vec3d origin_m;  ///< point at which it leaves the lens; NaN for a pixel without light
    Vec3d direction;  ///< unit vector; NaN for a pixel without light
    double light = 0;  ///< irradiance of the pixel for a uniform scene, relative to the film centre
};

/// Projects scene points to pixels of a camera's picture, and pixels to rays in the scene. If the camera moves, each
/// row of pixels uses the camera's pose at the middle of the row's exposure.
class Projection {
public:
    /// `rays`: projection rays of the camera's lens.
    Projection(const Camera& camera, std::shared_ptr<const ProjectionRays> rays);

    /// Pixel of a scene point.
    ProjectedPoint pixel_of(Vec3d point_m) const;

    /// Projection ray of a point of the picture, in pixel coordinates as in ProjectedPoint.
    PixelRay ray_of(Vec2<double> pixel) const;

private:
    static constexpr int kMaxIterations = 20;
    static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    static constexpr Vec2<double> kNoPixel = {kNaN, kNaN};
    static constexpr Vec3d kNoVector = {kNaN, kNaN, kNaN};

    /// Index of the row of pixels at a vertical pixel coordinate, clamped to the picture.
    int row_of(double y) const { return static_cast<int>(std::clamp(y, 0.0, static_cast<double>(film_.height - 1))); }

    /// pixel_of for one pose of the camera.
    ProjectedPoint project_from_pose(const Affine<double>& scene_from_camera, Vec3d point_m) const;

    Film film_;
    std::shared_ptr<const ProjectionRays> rays_;
    std::vector<Affine<double>> scene_from_camera_;  ///< scene-from-camera transform of each row of pixels; a single
                                                     ///< one if all rows share it
};

}  // namespace REALCAM_NAMESPACE
