#pragma once
#include <optional>

#include "camera.hpp"

namespace REALCAM_NAMESPACE {

class CameraSetup;

/// Which ray stands for all the light that a film point gets.
enum class SightRay {
    light,  ///< the mean of the rays of the point in focus whose light has its middle there (mean_ray.hpp)
    chief,  ///< that through the middle of the stop, even where a rim blocks it
};

/// A line from the lens into the scene, in the camera's axes, mm from the middle of its film.
struct FilmSight {
    Vec3d origin, direction;
    double light;  ///< irradiance for an even field, over that in the middle of the film
};

/// Along which lines a camera's film looks into the scene. Places on the film are in mm, right and up as the picture
/// shows them.
class LinesOfSight {
public:
    virtual ~LinesOfSight() = default;

    /// Nothing where no light arrives, and beyond the corners of the film.
    virtual std::optional<FilmSight> from(Vec2<double> place) const = 0;
    /// The place whose line goes through a point, which is given as FilmSight's are. Nothing where no line does.
    virtual std::optional<Vec2<double>> place_of(Vec3d point) const = 0;
    /// Whether a point is farther in front than the entrance pupil.
    virtual bool is_in_front(Vec3d point) const = 0;
    /// Whether the lens's image ends within the film.
    virtual bool ends_in_film() const = 0;
};

}  // namespace REALCAM_NAMESPACE
