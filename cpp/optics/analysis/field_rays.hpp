#pragma once
#include <optional>

#include "../../platform.hpp"
#include "../prescription/lens_system.hpp"
#include "../pupil/film_surface.hpp"
#include "../pupil/pupil_pattern.hpp"
#include "aim_request.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

/// Rays of one object point over the stop, behind the lens: the input of wavefronts and spots. Lengths in mm; points
/// relative to the last vertex.
struct FieldRays {
    double field_angle_rad;
    double film_curvature;  ///< 1/mm
    /// Distance from the exit pupil to the film along the chief ray, mm: the mean of both meridians. Set only if the
    /// field is specified by its film point, or the lens is not a lens of revolution.
    std::optional<double> exit_pupil_distance;
    std::vector<PupilPoint> pattern;
    std::vector<AimedRay> rays;  ///< one per point of the pattern; valid if the status is ok
    AimedRay chief;  ///< through the stop's centre, even if the lens blocks it

    bool passes(std::size_t i) const { return rays[i].status == RayStatus::ok; }

    /// Intersection of a ray, as a straight line, with the film, whose vertex is at z.
    Vec3d on_film(const AimedRay& ray, double z) const {
        const FilmSurface<double> film{z, film_curvature};
        return film.point(film.landing(ray.origin, ray.direction));
    }
};

/// Aims a ray at every point of the pattern. Throws InputError if the field point is invalid or no ray passes the lens,
/// and what `loop` throws to stop it.
FieldRays field_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                     std::vector<PupilPoint> pattern, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
