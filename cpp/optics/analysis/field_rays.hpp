#pragma once
#include <optional>

#include "../../platform.hpp"
#include "../prescription/lens_system.hpp"
#include "../pupil/film_surface.hpp"
#include "../pupil/pupil_pattern.hpp"
#include "aim_request.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

/// Rays of one object point that fill the stop, behind the lens: the input of wavefronts and spots. Lengths are in mm,
/// and points are relative to the last vertex.
struct FieldRays {
    double field_angle_rad;
    double film_curvature;  ///< 1/mm
    /// Distance from the exit pupil to the film along the chief ray, mm: the mean of both meridians. It is set if the
    /// field is specified by its film point or the lens is not rotationally symmetric; otherwise it is empty.
    std::optional<double> exit_pupil_distance;
    std::vector<PupilPoint> pattern;  ///< target points on the stop
    std::vector<AimedRay> rays;  ///< one per point of the pattern; valid if the status is ok
    AimedRay chief;  ///< ray through the stop's centre, valid even if a rim or an obstruction blocks it

    /// True if ray i passes the lens.
    bool passes(std::size_t i) const { return rays[i].status == RayStatus::ok; }

    /// Returns the intersection of a ray, as an infinite straight line, with a film whose vertex is at z.
    Vec3d on_film(const AimedRay& ray, double z) const {
        const FilmSurface<double> film{z, film_curvature};
        return film.point(film.landing(ray.origin, ray.direction));
    }
};

/// Aims a ray of the field point at every point of the pattern. Throws InputError if the field point is invalid, or if
/// no ray passes the lens, and Cancelled if `loop` is cancelled.
FieldRays field_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                     std::vector<PupilPoint> pattern, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
