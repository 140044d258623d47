#include "pinhole_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../../math/hypotenuse.hpp"
#include "../../math/matrix2.hpp"
#include "../../optics/analysis/scene_bundle.hpp"
#include "../../optics/lens/chief_ray.hpp"
#include "../../optics/trace/film_frame.hpp"
#include "../../optics/trace/lens_path.hpp"
#include "../../optics/trace/lens_trace.hpp"

namespace realcam {

namespace {

/// Central projection of a lens by a camera model. An ideal lens has its own image distance. The film of a real lens
/// lies where its picture is sharpest, which is not quite the paraxial focus. Its image distance follows from the
/// paraxial chief ray.
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

/// Projection of a centred, rotationally symmetric lens.
FilmPinhole pinhole_of_rotational_lens(const Camera& camera) {
    const CentralLens lens = central_lens(camera.lens, camera.model);
    const double f = lens.image_distance;
    return {{0, 0, lens.position - camera.lens.film_position()}, {{f, 0}, {0, f}}, {0, 0}};
}

/// Projection of a lens of any kind, from chief rays of film points close to the centre, by differences over four
/// points with an error of fourth order. Contains NaN if a chief ray does not exist.
FilmPinhole pinhole_of_any_lens(const LensSystem& lens) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const RaysFromFilm rays(lens, lens.wavelength_nm);
    const std::optional<ChiefRay> middle = chief_ray_of_film_point(rays, {0, 0});
    if (!middle) return {{kNaN, kNaN, kNaN}, {}, {}};
    const Vec3d towards = -middle->scene_direction;
    const AcrossRay across(towards);
    // `direction`: x / z and y / z in the axes of computer vision. `position`, `slope`: position and slope in the plane
    // perpendicular to the central chief ray.
    struct ChiefRayCoordinates {
        Vec2<double> direction = {kNaN, kNaN}, position = direction, slope = direction;
    };
    const auto coordinates_of = [&](const std::optional<ChiefRay>& chief) {
        if (!chief) return ChiefRayCoordinates{};
        const Vec3d d = -chief->scene_direction, from = chief->scene - middle->scene;
        const double ahead = dot(d, towards), along = dot(from, towards);
        const Vec2<double> at = across.of(from), direction = across.of(d),
                           slope = {direction.x / ahead, direction.y / ahead};
        return ChiefRayCoordinates{{-d.x / d.z, d.y / d.z}, {at.x - along * slope.x, at.y - along * slope.y}, slope};
    };
    const double step = 1e-3 * rays.film_distance();
    // Derivatives by x to the right and y down on the film, as in the picture.
    Matrix2 direction{}, position{}, slope{};
    for (const bool is_y : {false, true}) {
        const auto at = [&](double steps) {
            return coordinates_of(
                chief_ray_of_film_point(rays, is_y ? Vec2<double>{0, steps * step} : Vec2<double>{-steps * step, 0}));
        };
        const ChiefRayCoordinates near[] = {at(1), at(-1)}, far[] = {at(2), at(-2)};
        const auto set = [&](Matrix2& to, Vec2<double> ChiefRayCoordinates::* value) {
            const auto derivative = [&](double Vec2<double>::* part) {
                const auto get = [&](const ChiefRayCoordinates& ray) { return ray.*value.*part; };
                return (8 * (get(near[0]) - get(near[1])) - (get(far[0]) - get(far[1]))) / (12 * step);
            };
            (is_y ? to.first.y : to.first.x) = derivative(&Vec2<double>::x);
            (is_y ? to.second.y : to.second.x) = derivative(&Vec2<double>::y);
        };
        set(direction, &ChiefRayCoordinates::direction);
        set(position, &ChiefRayCoordinates::position);
        set(slope, &ChiefRayCoordinates::slope);
    }
    // Distance along the central chief ray to where the chief rays cross, averaged over both meridians.
    const double ahead = -0.5 * (position * slope.inverse()).trace();
    const Vec3d centre = middle->scene + ahead * towards - Vec3d{0, 0, camera_film_position(lens)};
    const Matrix2 scale = direction.inverse();
    const Vec2<double> axis = scale * coordinates_of(middle).direction;
    return {centre, scale, {-axis.x, -axis.y}};
}

}  // namespace

Vec3d centre_of_projection_mm(const Camera& camera) {
    const Vec3d centre =
        (camera.lens.is_rotational() ? pinhole_of_rotational_lens(camera) : pinhole_of_any_lens(camera.lens)).centre;
    if (std::isfinite(centre.x + centre.y + centre.z)) return centre;
    return {0, 0, -camera_film_position(camera.lens)};
}

std::optional<PinholeCamera> pinhole_camera(const Camera& camera, const Pose& pose) {
    const Film& film = camera.film;
    PinholeCamera result{};
    Vec3d centre_mm;
    if (camera.geometry) {
        const CalibratedGeometry& geometry = *camera.geometry;
        centre_mm = centre_of_projection_mm(camera);
        result.focal_x = film.width * geometry.pinhole.focal_x;
        result.column_by_y = film.width * geometry.pinhole.skew;
        result.focal_y = film.height * geometry.pinhole.focal_y;
        result.centre_x = film.width * geometry.pinhole.centre_x;
        result.centre_y = film.height * geometry.pinhole.centre_y;
    } else {
        const FilmPinhole lens =
            camera.lens.is_rotational() ? pinhole_of_rotational_lens(camera) : pinhole_of_any_lens(camera.lens);
        if (!std::isfinite(lens.centre.z) || !std::isfinite(lens.scale.first.x + lens.scale.second.y))
            return std::nullopt;
        const double columns = film.width / film.width_mm, rows = film.height / film.height_mm;
        centre_mm = lens.centre;
        result.focal_x = columns * lens.scale.first.x;
        result.column_by_y = columns * lens.scale.first.y;
        result.row_by_x = rows * lens.scale.second.x;
        result.focal_y = rows * lens.scale.second.y;
        const Vec2<double> axis = film.pixel_of({lens.middle.x, -lens.middle.y});
        result.centre_x = axis.x;
        result.centre_y = axis.y;
    }
    const camera_detail::Axes axes = camera_detail::axes_of(pose);
    result.right = axes.right;
    result.down = -axes.up;
    result.forward = -axes.backward;
    result.centre_m =
        pose.position_m + 0.001 * (centre_mm.x * axes.right + centre_mm.y * axes.up + centre_mm.z * axes.backward);
    result.translation_m = {-dot(result.right, result.centre_m), -dot(result.down, result.centre_m),
                            -dot(result.forward, result.centre_m)};
    return result;
}

Pose pose_at_mid_exposure(const Camera& camera) {
    const TimeInterval exposure = camera.exposure();
    return pose_at(camera, 0.5 * (exposure.begin_s + exposure.end_s));
}

double picture_angle(const Camera& camera, double image_height_mm) {
    if (camera.ray_pairs) return camera.ray_pairs->field_angle(image_height_mm);
    const LensSystem lens = centred(camera.lens);
    if (has_real_pupil(camera.model) || camera.model == CameraModel::mapped_lens)
        return widest_field_angle(lens, image_height_mm);
    camera_detail::validate_ideal(lens, camera.model);
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    if (camera.model != CameraModel::thick_lens)
        return std::atan(image_height_mm / static_cast<double>(camera_detail::thin_lens_of(lens, data).image_distance));
    // Chief ray through the centre of the exit pupil, from the last vertex to the front one.
    const ThickLens thick = camera_detail::thick_lens_of(lens, data);
    const double slope = image_height_mm / static_cast<double>(thick.exit_pupil_distance);
    const double height = image_height_mm - lens.film_distance * slope;
    return std::fabs(std::atan(static_cast<double>(thick.A) * slope - static_cast<double>(thick.C) * height));
}

FieldOfView field_of_view(const Camera& camera) {
    if (camera.geometry) {
        const CalibratedGeometry& geometry = *camera.geometry;
        // From the axis to either side, because a fisheye may see more than 180 degrees in all.
        const auto to_axis = [&](double x, double y) { return std::acos(-geometry.direction_at({x, y}).z); };
        return {to_axis(0, geometry.pinhole.centre_y) + to_axis(1, geometry.pinhole.centre_y),
                to_axis(geometry.pinhole.centre_x, 0) + to_axis(geometry.pinhole.centre_x, 1),
                std::max(to_axis(0, 0) + to_axis(1, 1), to_axis(0, 1) + to_axis(1, 0))};
    }
    const double x = 0.5 * camera.film.width_mm, y = 0.5 * camera.film.height_mm;
    const double right = std::fabs(camera.film.shift_mm.x), up = std::fabs(camera.film.shift_mm.y);
    // Angle between the film point farthest from the axis and the opposite one, which may lie on the same side.
    const auto between = [&](double far, double opposite) {
        const double angle = picture_angle(camera, far);
        return opposite == far ? 2 * angle
                               : angle + std::copysign(picture_angle(camera, std::fabs(opposite)), opposite);
    };
    const double beyond = (x + right) * (x - right) + (y + up) * (y - up);
    return {between(x + right, x - right), between(y + up, y - up),
            between(hypotenuse(x + right, y + up), std::copysign(hypotenuse(x - right, y - up), beyond))};
}

std::optional<Vec3d> entrance_pupil_position_m(const Camera& camera) {
    const LensSystem& lens = camera.lens;
    if (camera.geometry || !lens.is_rotational()) {
        const std::optional<PinholeCamera> pinhole = pinhole_camera(camera, camera.pose);
        return pinhole ? std::optional(pinhole->centre_m) : std::nullopt;
    }
    const double pupil_mm = first_order(lens, lens.wavelength_nm).entrance_pupil_position;
    if (!std::isfinite(pupil_mm)) return std::nullopt;
    const Vec3d backward = camera_detail::axes_of(camera.pose).backward;
    return camera.pose.position_m - (0.001 * (lens.film_position() - pupil_mm)) * backward;
}

Vec3d film_centre_m(const Camera& camera) {
    const camera_detail::Axes axes = camera_detail::axes_of(camera.pose);
    const Vec2<double> shift = camera.film.shift_mm;
    // The image on the film is inverted in both directions.
    return camera.pose.position_m - (0.001 * shift.x) * axes.right - (0.001 * shift.y) * axes.up;
}

namespace {

/// Meridional rays of one film point, aimed at fractions of the last surface's semi-diameter.
class MeridionalRays {
public:
    MeridionalRays(const LensSystem& lens, double image_height_mm)
        : path_(lens, LightDirection::to_scene, lens.wavelength_nm),
          origin_{image_height_mm, 0, lens.film_distance},
          rim_(lens.surfaces.back().clear_semi_diameter) {
        const LensView<double> view = path_.view();
        to_stop_.assign(view.surfaces, view.surfaces + (view.count - lens.stop_index()));
        to_stop_.back().rim_squared = std::numeric_limits<double>::max();
        to_stop_.back().has_blades = false;
    }

    /// Traces rays that are aimed at these fractions of the last surface's semi-diameter, -1 to 1, through the lens or
    /// only to its stop.
    template <int N>
    LensRays<double, N> trace(const double (&aims)[N], bool only_to_stop) const {
        LensView<double> view = path_.view();
        if (only_to_stop) {
            view.surfaces = to_stop_.data();
            view.count = static_cast<int>(to_stop_.size());
        }
        LensRays<double, N> rays;
        for (int i = 0; i < N; ++i) {
            rays.origin.set(i, origin_);
            rays.direction.set(i, path_.entry_index * normalized(Vec3d{rim_ * aims[i], 0, 0} - origin_));
            rays.status[i] = 0;
        }
        trace_lens(view, rays);
        return rays;
    }

private:
    LensPath<double> path_;
    Vec3d origin_;
    double rim_;
    std::vector<SurfaceView<double>> to_stop_;  ///< surfaces from the last one to the stop, which blocks nothing
};

/// Signed angle to the axis, in the meridional plane, of a direction towards the scene, rad.
double angle_of(Vec3d direction) {
    return std::atan2(-direction.x, -direction.z);
}

}  // namespace

double field_angle(const LensSystem& lens, double image_height_mm) {
    constexpr int kRays = 512, kMinPassed = 8, kHalvings = 60;
    const MeridionalRays meridian(lens, image_height_mm);
    double aims[kRays];
    for (int i = 0; i < kRays; ++i) aims[i] = (2 * i + 1.0) / kRays - 1;
    const LensRays<double, kRays> rays = meridian.trace(aims, false);
    double sum = 0;
    int passed = 0;
    for (int i = 0; i < kRays; ++i) {
        if (rays.status[i] != 0) continue;
        sum += angle_of(rays.direction[i]);
        ++passed;
    }
    if (passed >= kMinPassed) return std::fabs(sum / passed);
    // Bisection for the chief ray, which crosses the axis at the stop.
    const LensRays<double, kRays> at_stop = meridian.trace(aims, true);
    for (int i = 1; i < kRays; ++i) {
        const bool above = at_stop.origin.x[i] > 0;
        if (at_stop.status[i - 1] != 0 || at_stop.status[i] != 0 || (at_stop.origin.x[i - 1] > 0) == above) continue;
        double low = aims[i - 1], high = aims[i];
        for (int k = 0; k < kHalvings; ++k) {
            const double middle[1] = {0.5 * (low + high)};
            const LensRays<double, 1> ray = meridian.trace(middle, true);
            ((ray.origin.x[0] > 0) == above ? high : low) = middle[0];
        }
        const double middle[1] = {high};
        const LensRays<double, 1> chief = meridian.trace(middle, false);
        if (chief.status[0] == 0) return std::fabs(angle_of(chief.direction[0]));
    }
    return passed > 0 ? std::fabs(sum / passed) : std::numeric_limits<double>::quiet_NaN();
}

double widest_field_angle(const LensSystem& lens, double image_height_mm) {
    for (int i = 0; i < 50; ++i) {
        const double angle = field_angle(lens, image_height_mm * (1 - 0.02 * i));
        if (std::isfinite(angle)) return angle;
    }
    return 0;
}

}  // namespace realcam
