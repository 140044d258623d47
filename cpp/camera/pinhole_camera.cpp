#include "pinhole_camera.hpp"

#include <cmath>
#include <limits>

#include "../math/matrix2.hpp"
#include "../optics/analysis/scene_bundle.hpp"
#include "../optics/lens/chief_ray.hpp"

namespace realcam {

namespace {

/// An ideal lens has its own image distance. The film of a real lens lies where its picture is sharpest, which is not
/// quite the paraxial focus. Its image distance follows from the paraxial chief ray.
CentralLens central_lens(const LensSystem& lens, CameraModel model) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (model == CameraModel::pinhole || model == CameraModel::thin_lens)
        return {data.entrance_pupil_position, camera_detail::ideal_lens_of(lens, data).image_distance};
    const ParaxialRay chief = trace_paraxial(lens, lens.wavelength_nm, {-data.entrance_pupil_position, 1}, 0,
                                             static_cast<int>(lens.surfaces.size()));
    return {data.entrance_pupil_position, std::fabs(chief.height + lens.film_distance * chief.slope)};
}

/// Projection of a lens to first order: film coordinates in mm, x to the right and y down as in the picture, are scale
/// (x / z, y / z) + middle, in the axes of computer vision.
struct FilmPinhole {
    Vec3d centre;  ///< centre of projection, from the film centre in the camera's axes, mm
    Matrix2 scale;
    Vec2<double> middle;
};

FilmPinhole pinhole_of_round_lens(const Camera& camera) {
    const CentralLens lens = central_lens(camera.lens, camera.model);
    const double f = lens.image_distance;
    return {{0, 0, lens.position - camera.lens.film_position()}, {{f, 0}, {0, f}}, {0, 0}};
}

/// Computed from chief rays of film points close to the centre, by differences over four points with an error of fourth
/// order. Contains NaN if a chief ray does not exist.
FilmPinhole pinhole_of_any_lens(const LensSystem& lens) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const RaysFromFilm rays(lens, lens.wavelength_nm);
    const std::optional<ChiefRay> middle = chief_ray_of_film_point(rays, {0, 0});
    if (!middle) return {{kNone, kNone, kNone}, {}, {}};
    const Vec3d towards = -middle->scene_direction;
    const AcrossRay across(towards);
    // `direction`: x / z and y / z in the axes of computer vision. `position`, `slope`: position and slope in the plane
    // perpendicular to the central chief ray.
    struct Seen {
        Vec2<double> direction = {kNone, kNone}, position = direction, slope = direction;
    };
    const auto seen_from = [&](const std::optional<ChiefRay>& chief) {
        if (!chief) return Seen{};
        const Vec3d d = -chief->scene_direction, from = chief->scene - middle->scene;
        const double ahead = dot(d, towards), along = dot(from, towards);
        const Vec2<double> at = across.of(from), direction = across.of(d),
                           slope = {direction.x / ahead, direction.y / ahead};
        return Seen{{-d.x / d.z, d.y / d.z}, {at.x - along * slope.x, at.y - along * slope.y}, slope};
    };
    const double step = 1e-3 * rays.film_distance();
    Matrix2 direction{}, position{},
        slope{};  // derivatives by x to the right and y down on the film, as in the picture
    for (const bool is_y : {false, true}) {
        const auto at = [&](double steps) {
            return seen_from(
                chief_ray_of_film_point(rays, is_y ? Vec2<double>{0, steps * step} : Vec2<double>{-steps * step, 0}));
        };
        const Seen near[] = {at(1), at(-1)}, far[] = {at(2), at(-2)};
        const auto set = [&](Matrix2& to, Vec2<double> Seen::* value) {
            const auto by = [&](double Vec2<double>::* part) {
                const auto of = [&](const Seen& seen) { return seen.*value.*part; };
                return (8 * (of(near[0]) - of(near[1])) - (of(far[0]) - of(far[1]))) / (12 * step);
            };
            (is_y ? to.first.y : to.first.x) = by(&Vec2<double>::x);
            (is_y ? to.second.y : to.second.x) = by(&Vec2<double>::y);
        };
        set(direction, &Seen::direction);
        set(position, &Seen::position);
        set(slope, &Seen::slope);
    }
    // Distance along the central chief ray to where the chief rays cross, averaged over both meridians.
    const double ahead = -0.5 * (position * slope.inverse()).trace();
    const Vec3d centre = middle->scene + ahead * towards - Vec3d{0, 0, camera_film_position(lens)};
    const Matrix2 scale = direction.inverse();
    const Vec2<double> shown = scale * seen_from(middle).direction;
    return {centre, scale, {-shown.x, -shown.y}};
}

}  // namespace

std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose) {
    const FilmPinhole lens =
        camera.lens.is_rotational() ? pinhole_of_round_lens(camera) : pinhole_of_any_lens(camera.lens);
    if (!std::isfinite(lens.centre.z) || !std::isfinite(lens.scale.first.x + lens.scale.second.y)) return std::nullopt;
    const Film& film = camera.film;
    const double columns = film.width / film.width_mm, rows = film.height / film.height_mm;
    PinholeCamera result{};
    result.focal_x = columns * lens.scale.first.x;
    result.column_by_y = columns * lens.scale.first.y;
    result.row_by_x = rows * lens.scale.second.x;
    result.focal_y = rows * lens.scale.second.y;
    const Vec2<double> axis = film.pixel_of({lens.middle.x, -lens.middle.y});
    result.centre_x = axis.x;
    result.centre_y = axis.y;
    const camera_detail::Axes axes = camera_detail::axes_of(pose);
    result.right = axes.right;
    result.down = -axes.up;
    result.forward = -axes.backward;
    result.centre_m = pose.position_m +
                      0.001 * (lens.centre.x * axes.right + lens.centre.y * axes.up + lens.centre.z * axes.backward);
    result.translation_m = {-dot(result.right, result.centre_m), -dot(result.down, result.centre_m),
                            -dot(result.forward, result.centre_m)};
    return result;
}

Pose middle_pose(const Camera& camera) {
    const TimeInterval exposure = camera.exposure();
    return pose_at(camera, 0.5 * (exposure.begin_s + exposure.end_s));
}

}  // namespace realcam
