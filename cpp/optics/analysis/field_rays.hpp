#pragma once
#include <optional>

#include "../../platform.hpp"
#include "../prescription/lens_system.hpp"
#include "../pupil/film_surface.hpp"
#include "../pupil/pupil_pattern.hpp"
#include "aim_request.hpp"
#include "object_point.hpp"

namespace REALCAM_NAMESPACE {

/// The rays of one object point over the stop, behind the lens: what wavefronts and spots are made from. Lengths in mm;
/// points relative to the last vertex.
struct FieldRays {
    double field_angle_rad;
    double film_curvature;  ///< 1/mm
    /// From the exit pupil on the chief ray to the film, mm along the ray: the mean of both meridians. Only where the
    /// field is named by its film point, or the lens is not of revolution.
    std::optional<double> exit_pupil_distance;
    std::vector<PupilPoint> pattern;
    std::vector<AimedRay> rays;  ///< one for each point of the pattern; only those whose status is ok count
    AimedRay chief;  ///< through the middle of the stop, even where the lens blocks it

    bool passes(std::size_t i) const { return rays[i].status == RayStatus::ok; }

    /// Where a ray, as a straight line, meets the film, whose vertex is at z.
    Vec3d on_film(const AimedRay& ray, double z) const {
        const FilmSurface<double> film{z, film_curvature};
        return film.place(film.landing(ray.origin, ray.direction));
    }
};

/// Aims a ray at every point of the pattern. Throws InputError where the field point makes no sense, or where the lens
/// lets none of the rays pass, and what `loop` throws to stop it.
FieldRays field_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                     std::vector<PupilPoint> pattern, const RayLoop& loop = {});

}  // namespace REALCAM_NAMESPACE
