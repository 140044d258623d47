#include "camera.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "../../optics/prescription/lens_checks.hpp"

namespace realcam {

TimeInterval Camera::exposure() const {
    const double begin = shutter.opens_s + 0.5 * (exposure_time_s - seen_time());
    return {begin, begin + shutter.readout_time_s + seen_time()};
}

namespace camera_detail {

namespace {

constexpr double kMaxPosition_m = 1e12;  ///< limit of each coordinate; as for a scene's bounding box

constexpr double kMinLookDistance_m = 1e-9;  ///< least distance of look_at from position
constexpr double kMinUpSine = 1e-9;  ///< least sine of the angle between the viewing direction and `up`

bool is_between(double low, double value, double high) {
    return value >= low && value <= high;
}

bool is_bounded_point(Vec3d v) {
    const auto is_bounded = [](double x) { return std::fabs(x) <= kMaxPosition_m; };
    return is_bounded(v.x) && is_bounded(v.y) && is_bounded(v.z);
}

}  // namespace

}  // namespace camera_detail

void validate(const Film& film) {
    using namespace camera_detail;
    if (film.width < 1 || film.height < 1 || film.width > kMaxResolution || film.height > kMaxResolution)
        throw InputError("the resolution is " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                         " pixels; expected 1 to " + std::to_string(kMaxResolution) + " along each side");
    if (!is_between(kMinFilm_mm, film.width_mm, kMaxFilm_mm) || !is_between(kMinFilm_mm, film.height_mm, kMaxFilm_mm))
        throw InputError("the film's width and height must be positive lengths, from 1e-6 to 1e9 mm");
    if (!is_between(-kMaxFilm_mm, film.shift_mm.x, kMaxFilm_mm) ||
        !is_between(-kMaxFilm_mm, film.shift_mm.y, kMaxFilm_mm))
        throw InputError("the film's shift must be two finite lengths of at most 1e9 mm");
}

void validate(const Pose& pose) {
    using namespace camera_detail;
    if (!is_bounded_point(pose.position_m) || !is_bounded_point(pose.look_at_m))
        throw InputError("the camera's position and look_at must be finite numbers of at most 1e12 m");
    if (!is_between(kMinUp, length(pose.up), kMaxUp))
        throw InputError("the camera's up direction must have a finite length, from 1e-100 to 1e100");
    const Vec3d forward = pose.look_at_m - pose.position_m;
    const double distance = length(forward);
    if (!(distance > kMinLookDistance_m) ||
        !(length(cross(forward, pose.up)) > kMinUpSine * distance * length(pose.up)))
        throw InputError("the camera must look at a point other than its position, and not along its up direction");
}

void validate(const std::vector<PoseKey>& motion) {
    check_keys(motion, "the camera's motion", [](const PoseKey& key) { validate(key.pose); });
}

namespace {

/// Throws InputError if a camera needs more of its lens than the ray pairs that are known.
void check_ray_pairs(const Camera& camera) {
    const std::string start = "the rays of lens \"" + camera.ray_pairs->name + "\" were measured: ";
    if (camera.model != CameraModel::polynomial_lens) throw InputError(start + "the camera's model must be polynomial");
    if (camera.geometry) throw InputError(start + "they have no chief rays, which a calibration moves");
    if (!(camera.lens == paraxial_lens(*camera.ray_pairs)))
        throw InputError(start + "another lens, f-number, focus or zoom needs other measurements");
}

}  // namespace

void validate(const Camera& camera) {
    using namespace camera_detail;
    validate(camera.film);
    if (!is_between(kMinExposureSetting, camera.exposure_time_s, kMaxExposureSetting))
        throw InputError("the exposure time must be a positive number of seconds, from 1e-37 to 1e38");
    if (!is_between(kMinExposureSetting, camera.iso, kMaxExposureSetting))
        throw InputError("the ISO number must be positive, from 1e-37 to 1e38");
    if (camera.lens.stop_index() < 0) throw InputError("the camera has no lens; expected a lens with a stop");
    if (const std::string why = film_distance_error(camera.lens); !why.empty()) throw InputError(why);
    check_film_reach(camera.lens, camera.film.radius_mm());
    if (!(camera.lens.stop_semi_diameter >= 0))
        throw InputError("the radius of the lens's open stop must be a length of 0 or more");
    if (!(std::fabs(camera.shutter.opens_s) <= kMaxTime_s))
        throw InputError("the time at which the shutter opens must lie within 1e9 s");
    if (!is_between(0, camera.shutter.readout_time_s, kMaxTime_s))
        throw InputError("the readout time must be a number of seconds from 0 to 1e9");
    validate(camera.pose);
    validate(camera.motion);
    if (camera.geometry) check_film(*camera.geometry, camera.film);
    if (camera.ray_pairs) check_ray_pairs(camera);
}

namespace camera_detail {

Axes axes_of(const Pose& pose) {
    const Vec3d backward = normalized(pose.position_m - pose.look_at_m);
    const Vec3d right = normalized(cross(pose.up, backward));
    return {right, cross(backward, right), backward};
}

Affine<double> scene_from_camera(const Pose& pose) {
    const Axes axes = axes_of(pose);
    return {axes.right, axes.up, axes.backward, pose.position_m};
}

Motion motion_of(const std::vector<PoseKey>& keys) {
    Motion motion;
    for (const PoseKey& key : keys) {
        motion.times_s.push_back(key.time_s);
        motion.transforms.push_back(scene_from_camera(key.pose));
    }
    return motion;
}

IdealLens ideal_lens_of(const LensSystem& lens, const FirstOrder& data) {
    IdealLens ideal{std::fabs(data.effective_focal_length), 0, 0.5 * data.entrance_pupil_diameter};
    if (data.is_afocal()) {
        // An afocal lens has no conjugate of the film: the height of the chief ray on the film gives the image scale.
        const ParaxialRay chief = trace_paraxial(lens, lens.wavelength_nm, {-data.entrance_pupil_position, 1}, 0,
                                                 static_cast<int>(lens.surfaces.size()));
        ideal.image_distance = std::fabs(chief.height + lens.film_distance * chief.slope);
    } else if (std::isfinite(lens.focus_distance)) {
        const double object = lens.focus_distance - lens.film_position();  // in front of the first vertex
        const double to_pupil = object + data.entrance_pupil_position;
        const ParaxialRay end =
            trace_paraxial(lens, lens.wavelength_nm, {object, 1}, 0, static_cast<int>(lens.surfaces.size()));
        ideal.image_distance = std::fabs(to_pupil / (data.image_index * end.slope));
        ideal.inverse_object_distance = 1 / to_pupil;
    }
    return ideal;
}

ThinLens thin_lens_of(const LensSystem& lens, const FirstOrder& data) {
    const IdealLens ideal = ideal_lens_of(lens, data);
    return {static_cast<float>(ideal.image_distance), static_cast<float>(ideal.inverse_object_distance),
            static_cast<float>(ideal.pupil_radius)};
}

ThickLens thick_lens_of(const LensSystem& lens, const FirstOrder& data) {
    const int count = static_cast<int>(lens.surfaces.size());
    const ParaxialRay height = trace_paraxial(lens, lens.wavelength_nm, {1, 0}, 0, count);
    const ParaxialRay slope = trace_paraxial(lens, lens.wavelength_nm, {0, 1}, 0, count);
    ThickLens thick{};
    // The determinant of the matrix is 1 / image_index.
    thick.A = static_cast<float>(data.image_index * height.height);
    thick.B = static_cast<float>(data.image_index * slope.height);
    thick.C = static_cast<float>(data.image_index * height.slope);
    thick.D = static_cast<float>(data.image_index * slope.slope);
    // A pupil at infinity is replaced by one 1 km away under the same angle.
    constexpr double kFar = 1e6;  // mm
    const double distance = lens.film_position() - data.exit_pupil_position;
    const bool far = !(std::fabs(distance) < kFar);
    const double tangent = data.exit_pupil_diameter / (2 * std::fabs(distance));
    // With the pupil at infinity the quotient is not finite; the slope of a ray from the stop's rim replaces it.
    const double rim = lens.open_stop_radius();
    const double marginal =
        std::fabs(trace_paraxial(lens, lens.wavelength_nm, {rim, 0}, lens.stop_index(), count).slope);
    thick.exit_pupil_distance = static_cast<float>(far ? kFar : distance);
    thick.exit_pupil_radius =
        static_cast<float>(far ? kFar * (std::isfinite(tangent) ? tangent : marginal) : 0.5 * data.exit_pupil_diameter);
    return thick;
}

void validate_ideal(const LensSystem& lens, CameraModel model) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    const std::string start = "the ideal camera models cannot represent lens \"" + lens.name + "\": its ";
    if (model == CameraModel::thick_lens) {
        const ThickLens thick = thick_lens_of(lens, data);
        if (!(std::fabs(thick.exit_pupil_distance) > 0)) throw InputError(start + "exit pupil lies in the film");
        return;
    }
    const ThinLens thin = thin_lens_of(lens, data);
    if (!std::isfinite(data.entrance_pupil_position))
        throw InputError(start + "entrance pupil lies at infinity; use the thick lens");
    if (!std::isfinite(thin.inverse_object_distance) || !(thin.image_distance > 0) ||
        !std::isfinite(thin.image_distance))
        throw InputError(start + "entrance pupil lies in the plane in focus, or its image in the film");
}

}  // namespace camera_detail

Pose pose_at(const Camera& camera, double time_s) {
    if (!camera.moves()) return camera.pose;
    if (time_s <= camera.motion.front().time_s) return camera.motion.front().pose;
    for (const PoseKey& key : camera.motion)
        if (time_s == key.time_s) return key.pose;
    if (time_s > camera.motion.back().time_s) return camera.motion.back().pose;
    const Affine<double> map = camera_detail::motion_of(camera.motion).at(time_s);
    const auto next = std::find_if(camera.motion.begin(), camera.motion.end(),
                                   [&](const PoseKey& key) { return key.time_s > time_s; });
    const PoseKey &from = *(next - 1), &to = *next;
    const double share = (time_s - from.time_s) / (to.time_s - from.time_s);
    // map.z points backward, away from the point looked at.
    const auto distance = [](const Pose& pose) { return length(pose.look_at_m - pose.position_m); };
    const double look_m = (1 - share) * distance(from.pose) + share * distance(to.pose);
    return {map.origin, map.origin - look_m * map.z, map.y};
}

void set_motion(Camera& camera, std::vector<PoseKey> keys) {
    camera.motion = std::move(keys);
    validate(camera);
    camera.pose = pose_at(camera, 0);
}

bool is_near_origin(const Camera& camera, Vec3d origin_m) {
    const double focus_m = std::isfinite(camera.lens.focus_distance) ? camera.lens.focus_distance / 1000 : 1.0;
    return length(position_when_open(camera) - origin_m) <= 10 * focus_m;
}

void validate_on_gpu(const Camera& camera) {
    if (camera.model == CameraModel::full_lens_double)
        throw InputError("the camera model full_double is for the CPU; use device cpu");
}

Film default_film(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
                  std::optional<std::array<int, 2>> resolution) {
    Film film;
    film.width_mm = size_mm ? (*size_mm)[0] : lens.film_width;
    film.height_mm = size_mm ? (*size_mm)[1] : lens.film_height;
    if (!resolution) {
        if (!(film.width_mm > 0) || !(film.height_mm > 0)) return film;
        const double pixels_per_mm = kDefaultLongSide / std::max(film.width_mm, film.height_mm);
        film.width = std::max(1, static_cast<int>(std::lround(film.width_mm * pixels_per_mm)));
        film.height = std::max(1, static_cast<int>(std::lround(film.height_mm * pixels_per_mm)));
        return film;
    }
    film.width = (*resolution)[0];
    film.height = (*resolution)[1];
    if (size_mm || film.width < 1 || film.height < 1) return film;
    if ((film.width < film.height) != (film.width_mm < film.height_mm)) std::swap(film.width_mm, film.height_mm);
    const double pitch = std::min(film.width_mm / film.width, film.height_mm / film.height);
    film.width_mm = pitch * film.width;
    film.height_mm = pitch * film.height;
    return film;
}

}  // namespace realcam
