#pragma once
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

class CameraSetup;

/// Projection ray: the ray that represents all light of a film point.
enum class ProjectionRay {
    light,  ///< centroid ray, for whose point in focus the light's centroid is the film point (mean_ray.hpp)
    chief,  ///< chief ray, through the centre of the stop, even if a rim blocks it
};

/// Projection ray from the lens into the scene, in the camera's axes, mm from the centre of the unshifted film.
struct FilmProjection {
    Vec3d origin, direction;
    double light;  ///< irradiance for a uniform scene, relative to the middle of the film
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

}  // namespace REALCAM_NAMESPACE
