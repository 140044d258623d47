#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "../../math/affine.hpp"
#include "../../math/hypotenuse.hpp"
#include "../../math/motion.hpp"
#include "../../optics/lens/paraxial.hpp"
#include "../../optics/lens/ray_pair_table.hpp"
#include "../models/camera_view.hpp"
#include "calibrated_geometry.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxResolution = 32768;  ///< largest number of pixels along a side of the film

/// Film or sensor: the light-sensitive rectangle and its pixel grid.
struct Film {
    double width_mm = 36, height_mm = 24;
    int width = 960, height = 640;  ///< number of pixels
    /// Offset of the film's centre from Pose::position_m, to the right and upwards as seen in the picture.
    Vec2<double> shift_mm = {0, 0};

    bool operator==(const Film&) const = default;

    /// Distance of the film's farthest point from the axis, mm.
    double radius_mm() const {
        return hypotenuse(0.5 * width_mm + std::fabs(shift_mm.x), 0.5 * height_mm + std::fabs(shift_mm.y));
    }
    /// Converts pixel coordinates (column and row from the upper left corner) to film coordinates in mm from the
    /// optical axis, x to the right and y up as in the developed image; and back.
    Vec2<double> point_of(Vec2<double> pixel) const {
        return {(pixel.x / width - 0.5) * width_mm + shift_mm.x, (0.5 - pixel.y / height) * height_mm + shift_mm.y};
    }
    Vec2<double> pixel_of(Vec2<double> point) const {
        return {(0.5 + (point.x - shift_mm.x) / width_mm) * width, (0.5 - (point.y - shift_mm.y) / height_mm) * height};
    }
};

/// Position and orientation of the camera in the scene (metres, right-handed, y up).
struct Pose {
    Vec3d position_m = {0, 0, 0};  ///< centre of the unshifted film (Film::shift_mm is 0)
    Vec3d look_at_m = {0, 0, -1};  ///< point of the scene on the camera's axis, in front of it
    Vec3d up = {0, 1, 0};  ///< direction that is upwards in the picture; any length, not along the viewing direction

    bool operator==(const Pose&) const = default;
};

/// Keyframe of the camera's pose.
struct PoseKey {
    double time_s = 0;
    Pose pose;

    bool operator==(const PoseKey&) const = default;
};

/// Rolling shutter: each row of pixels is exposed for the same time, the top row first.
struct Shutter {
    double opens_s = 0;  ///< time in the scene at which the exposure of the top row begins
    double readout_time_s = 0;  ///< from the start of the top row's exposure to that of a row just below the last one;
                                ///< 0: global shutter
    bool blurs = true;  ///< false: each row sees the scene at the middle of its exposure

    bool operator==(const Shutter&) const = default;
};

/// Lens, film, pose, shutter, exposure time and ISO of a camera.
struct Camera {
    LensSystem lens;
    Film film;
    Pose pose;  ///< pose at time 0 if the camera moves
    CameraModel model = CameraModel::full_lens;
    double exposure_time_s = 1.0 / 125;  ///< exposure time of each row of pixels
    double iso = 100;  ///< sensitivity: 10 / iso lux seconds become middle grey
    Shutter shutter;
    std::vector<PoseKey> motion;  ///< keyframes in increasing order of time; empty: the camera does not move
    std::shared_ptr<const CalibratedGeometry> geometry = nullptr;  ///< that of a calibration; null: the lens's own
    /// Rays of the model polynomial_lens if they were fitted to ray pairs, with `lens` = paraxial_lens(*ray_pairs);
    /// null: they are fitted to the rays of `lens`.
    std::shared_ptr<const RayPairTable> ray_pairs = nullptr;

    bool moves() const { return !motion.empty(); }
    /// Time for which a row of pixels sees the scene, s; 0 without motion blur.
    double seen_time() const { return shutter.blurs ? exposure_time_s : 0.0; }
    /// The interval from the first moment of the first row to the last moment of the last one.
    TimeInterval exposure() const;
};

namespace camera_detail {

// Limits of valid parameters. Beyond them, ray coordinates would leave the range of float32.
inline constexpr double kMinFilm_mm = 1e-6, kMaxFilm_mm = 1e9;  ///< width and height; from a few atoms up to kLongest

inline constexpr double kMinUp = 1e-100, kMaxUp = 1e100;  ///< length of Pose::up; the squares of both limits are finite
/// Exposure time, s, and ISO: both, and the exposure of middle grey, 10 / ISO, are normal float32 numbers.
inline constexpr double kMinExposureSetting = 1e-37, kMaxExposureSetting = 1e38;

}  // namespace camera_detail

/// Throws InputError if the film's resolution, size or shift is out of range.
void validate(const Film& film);

/// Throws InputError if a coordinate is out of range or the viewing direction is zero or parallel to `up`.
void validate(const Pose& pose);

/// Throws InputError if a key is invalid or the key times are not strictly increasing.
void validate(const std::vector<PoseKey>& motion);

/// Throws InputError if a parameter of the camera is invalid or no lens is set.
void validate(const Camera& camera);

namespace camera_detail {

/// Unit vectors of the camera's axes, in the scene: x, y and z of the lens.
struct Axes {
    Vec3d right, up, backward;
};

Axes axes_of(const Pose& pose);

/// Transform from the camera's axes, with the origin at Pose::position_m, to the scene; metres.
Affine<double> scene_from_camera(const Pose& pose);

/// Animated transform scene_from_camera of keyframes.
Motion motion_of(const std::vector<PoseKey>& keys);

/// ThinLens in double precision, mm. inverse_object_distance in 1/mm.
struct IdealLens {
    double image_distance, inverse_object_distance, pupil_radius;
};

/// Ideal lens in the entrance pupil, with the pupil and magnification of the real lens. The film plane is paraxially
/// conjugate to the object plane at focus_distance.
IdealLens ideal_lens_of(const LensSystem& lens, const FirstOrder& data);

/// ideal_lens_of for the render kernels.
ThinLens thin_lens_of(const LensSystem& lens, const FirstOrder& data);

/// Paraxial matrix and exit pupil of the lens. An exit pupil at infinity is replaced by one 1 km away.
ThickLens thick_lens_of(const LensSystem& lens, const FirstOrder& data);

/// Throws InputError if the ideal camera model cannot represent the lens: its pupil lies in the film, at infinity or in
/// the plane in focus.
void validate_ideal(const LensSystem& lens, CameraModel model);

}  // namespace camera_detail

/// Pose of the camera at a time of the scene, s; constant before the first and after the last keyframe.
Pose pose_at(const Camera& camera, double time_s);

/// Pose::position_m at shutter open.
inline Vec3d position_when_open(const Camera& camera) {
    return pose_at(camera, camera.exposure().begin_s).position_m;
}

/// Animates the camera and sets its pose to that at time 0. Throws InputError if a key or the camera is invalid.
void set_motion(Camera& camera, std::vector<PoseKey> keys);

/// True if a render space with this origin is accurate enough for the camera: the camera opens its shutter within ten
/// focus distances of it (10 m when focused at infinity), where float32 still resolves a hundredth of a pixel's width
/// at the plane in focus. The render space is moved to the camera only if this is false.
bool is_near_origin(const Camera& camera, Vec3d origin_m);

/// Throws InputError if the camera's model has no GPU implementation.
void validate_on_gpu(const Camera& camera);

inline constexpr int kDefaultLongSide = 960;  ///< default number of pixels along the film's longer side

/// Completes the user's film settings. Pixels are square unless both size and resolution are given.
/// - Neither: the film of the lens, 960 pixels along its longer side.
/// - The size in mm alone: 960 pixels along its longer side.
/// - The resolution alone: the largest part of the lens's film with its aspect ratio; upright pictures rotate the film.
/// Invalid values are passed through for validate(Camera) to report.
Film default_film(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
                  std::optional<std::array<int, 2>> resolution);

}  // namespace REALCAM_NAMESPACE
