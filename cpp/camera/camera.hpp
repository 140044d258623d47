#pragma once
#include <cmath>
#include <vector>

#include "../math/affine.hpp"
#include "../math/hypotenuse.hpp"
#include "../math/motion.hpp"
#include "../optics/lens/paraxial.hpp"
#include "camera_view.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr int kMaxResolution = 32768;

/// The light-sensitive rectangle and its grid of pixels.
struct Film {
    double width_mm = 36, height_mm = 24;
    int width = 960, height = 640;
    /// Offset of the film's centre from Pose::position_m, to the right and upwards as seen in the picture.
    Vec2<double> shift_mm = {0, 0};

    bool operator==(const Film&) const = default;

    /// Distance of the film's farthest point from the axis, mm.
    double radius_mm() const {
        return hypotenuse(0.5 * width_mm + std::fabs(shift_mm.x), 0.5 * height_mm + std::fabs(shift_mm.y));
    }
    /// Converts column and row, counted from the picture's upper left corner, to mm from the axis, right and up as the
    /// picture shows it; and back.
    Vec2<double> place_of(Vec2<double> pixel) const {
        return {(pixel.x / width - 0.5) * width_mm + shift_mm.x, (0.5 - pixel.y / height) * height_mm + shift_mm.y};
    }
    Vec2<double> pixel_of(Vec2<double> place) const {
        return {(0.5 + (place.x - shift_mm.x) / width_mm) * width, (0.5 - (place.y - shift_mm.y) / height_mm) * height};
    }
};

/// Position and orientation of the camera in the scene (metres, right-handed, y up).
struct Pose {
    Vec3d position_m = {0, 0, 0};  ///< centre of the unshifted film (Film::shift_mm is 0)
    Vec3d look_at_m = {0, 0, -1};
    Vec3d up = {0, 1, 0};

    bool operator==(const Pose&) const = default;
};

/// A pose at a time.
struct PoseKey {
    double time_s = 0;
    Pose pose;

    bool operator==(const PoseKey&) const = default;
};

/// When the film is exposed: every row of pixels for the same time, the top one first.
struct Shutter {
    double opens_s = 0;  ///< time in the scene at which the exposure of the top row begins
    double readout_time_s = 0;  ///< from then to where that of a row below the last would begin; 0: all rows together
    bool blurs = true;  ///< false: what a row sees is the scene in the middle of its exposure

    bool operator==(const Shutter&) const = default;
};

/// Lens, film, pose, shutter and the two dials.
struct Camera {
    LensSystem lens;
    Film film;
    Pose pose;  ///< of a camera that moves, at time 0
    CameraModel model = CameraModel::full_lens;
    double exposure_time_s = 1.0 / 125;
    double iso = 100;
    Shutter shutter;
    std::vector<PoseKey> motion;  ///< in rising order of time; empty: it stays where it is

    bool moves() const { return !motion.empty(); }
    /// Time for which a row of pixels sees the scene, s.
    double seen_time() const { return shutter.blurs ? exposure_time_s : 0.0; }
    /// The interval from the first moment of the first row to the last moment of the last one.
    TimeInterval exposure() const;
};

namespace camera_detail {

// Numbers beyond these are no camera's, and those of its rays would leave the range of float32.
inline constexpr double kSmallestFilm = 1e-6, kLargestFilm = 1e9;  ///< each way, mm, as a lens: from a few atoms on

inline constexpr double kShortestUp = 1e-100, kLongestUp = 1e100;  ///< squares of both are numbers
/// Exposure time, s, and ISO number: they and the exposure of middle grey, 10 / ISO, are float32 with all their digits.
inline constexpr double kLeastDial = 1e-37, kMostDial = 1e38;

}  // namespace camera_detail

/// Throws InputError where the film is none.
void validate(const Film& film);

/// Throws InputError where nothing can be seen from there.
void validate(const Pose& pose);

/// Throws InputError where keys are no motion of a camera.
void validate(const std::vector<PoseKey>& motion);

/// Throws InputError where the camera cannot take a picture.
void validate(const Camera& camera);

namespace camera_detail {

struct Axes {
    Vec3d right, up, backward;
};

Axes axes_of(const Pose& pose);

Affine<double> scene_from_camera(const Pose& pose);

Motion motion_of(const std::vector<PoseKey>& keys);

/// ThinLens in double precision.
struct IdealLens {
    double image_distance, inverse_object_distance, pupil_radius;
};

/// Pupil and magnification of the real lens, as an ideal lens in the entrance pupil. The film plane is paraxially
/// conjugate to the object plane at focus_distance.
IdealLens ideal_lens_of(const LensSystem& lens, const FirstOrder& data);

ThinLens thin_lens_of(const LensSystem& lens, const FirstOrder& data);

ThickLens thick_lens_of(const LensSystem& lens, const FirstOrder& data);

/// Throws InputError where an ideal model cannot take the place of the lens.
void validate_ideal(const LensSystem& lens, CameraModel model);

}  // namespace camera_detail

/// Where a camera is at a time.
Pose pose_at(const Camera& camera, double time_s);

/// Pose::position_m when the shutter opens.
inline Vec3d position_when_open(const Camera& camera) {
    return pose_at(camera, camera.exposure().begin_s).position_m;
}

/// Lets a camera move. Throws InputError for keys that are none.
void set_motion(Camera& camera, std::vector<PoseKey> keys);

/// Whether a scene that was placed about this origin serves the camera. It is moved to the camera, and stays where it
/// is while the camera moves by little. At ten focus distances (or 10 m) float32 still resolves a hundredth of a
/// pixel's width at the plane in focus.
bool lies_near(const Camera& camera, Vec3d origin_m);

/// Throws InputError where a GPU has no code for the camera's model.
void validate_on_gpu(const Camera& camera);

}  // namespace REALCAM_NAMESPACE
