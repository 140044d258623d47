#pragma once
#include <optional>
#include <vector>

#include "../../math/curves.hpp"
#include "../../math/smooth_grid.hpp"
#include "../../optics/lens/chief_ray.hpp"
#include "../film/camera.hpp"

namespace REALCAM_NAMESPACE {

/// Line of a ray from the lens into the scene, in the axes of the camera: points in mm from the centre of the unshifted
/// film.
struct RayLine {
    Vec3d direction;  ///< unit vector towards the scene
    Vec3d foot;  ///< its point nearest to the centre of projection
};

/// Traces the chief rays of a camera's lens, or of the ideal model that replaces it. Film points are in mm, in the
/// lens's axes.
class LensChiefRays {
public:
    /// `view`: view of the camera, for ideal models.
    LensChiefRays(const Camera& camera, const CameraView& view);

    /// Chief ray of a film point; std::nullopt if there is none.
    std::optional<RayLine> trace(Vec2<double> film) const;
    /// Chief rays of the film points (0, y) of a rotationally symmetric lens with surfaces, with y from 0 to
    /// `film_radius` in equal steps. They end at the first point that has none.
    std::vector<RayLine> trace_meridian(double film_radius, int steps) const;

    Vec3d centre() const { return centre_; }  ///< centre_of_projection_mm
    bool is_ideal() const { return !surfaces_.has_value(); }  ///< true if a model replaces the lens

private:
    RayLine line_of(const ChiefRay& ray) const;

    CameraView view_;
    Vec3d centre_, film_centre_;
    std::optional<RaysFromFilm> surfaces_;
};

/// Chief rays of all points of a camera's film and of a margin around it. Interpolated between traced rays, and
/// extrapolated where the lens has none.
class ChiefRays {
public:
    /// `view`: as for LensChiefRays. `margin`: fraction of the film's size on every side. Throws InputError if the lens
    /// has no chief ray.
    ChiefRays(const Camera& camera, const CameraView& view, double margin);

    /// Chief ray of a film point, mm, in the lens's axes. Points beyond the margin have the ray of the nearest point.
    RayLine at(Vec2<double> film) const;

private:
    /// Rotationally symmetric lens: angle to the axis and signed distance from the centre by film radius.
    struct Radial {
        OddCurve angle, offset;
        double steps_per_mm;
    };
    /// Any other lens: direction and foot over the film.
    struct Plane {
        SmoothGrid<6> grid;
        Vec2<double> first, cells_per_mm;
    };

    std::optional<Radial> radial_rays(double film_radius) const;
    std::optional<Plane> plane_rays(const Film& film, double margin) const;

    LensChiefRays traced_;
    std::optional<Radial> radial_;
    std::optional<Plane> plane_;
};

}  // namespace REALCAM_NAMESPACE
