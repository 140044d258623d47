#include "field_rays.hpp"

#include <algorithm>
#include <utility>

#include "../lens/parabasal.hpp"
#include "ray_aiming.hpp"

namespace realcam {

FieldRays field_rays(const LensSystem& lens, double wavelength_nm, const FieldPoint& field,
                     std::vector<PupilPoint> pattern, const RayLoop& loop) {
    const RayAimer aim(lens, wavelength_nm, field);
    FieldRays result{field.angle_rad, 1 / lens.film_radius_of_curvature, {}, std::move(pattern), {}, aim.chief_ray()};
    const std::string where = field.text();
    if (result.chief.status != RayStatus::ok)
        throw InputError("the ray " + where + " through the centre of the stop does not leave lens \"" + lens.name +
                         "\"");
    if (field.film || !lens.is_rotational()) {
        const Vec3d at_film = result.on_film(result.chief, lens.film_distance);
        result.exit_pupil_distance = exit_pupil_distance(lens, wavelength_nm, {at_film.x, at_film.y});
    }
    result.rays = aim_all(aim, result.pattern, stop_bounding_radius(lens), loop);
    if (std::none_of(result.rays.begin(), result.rays.end(),
                     [](const AimedRay& ray) { return ray.status == RayStatus::ok; }))
        throw InputError("none of " + std::to_string(result.rays.size()) + " rays " + where + " passes lens \"" +
                         lens.name + "\"");
    return result;
}

}  // namespace realcam
