#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../camera/camera_key.hpp"
#include "../camera/develop.hpp"
#include "../camera/shake.hpp"
#include "../io/lens/lens_file.hpp"
#include "../render/default_view.hpp"
#include "../render/render_settings.hpp"
#include "../scene/environment_change.hpp"
#include "scene_request.hpp"

namespace realcam::shot {

/// Who decides on the number of samples.
enum class Sampling {
    unsaid,    ///< nobody has said: kUnsaidGoal
    counted,   ///< settings.spp
    by_noise,  ///< spp is "auto"
};

/// The noise of a picture of which no number of samples is said, and the time after which it ends all the same.
inline constexpr NoiseGoal kUnsaidGoal = {.noise = 2, .seconds = 60};
/// The noise of such a picture that is to be denoised, which takes at least two thirds of it (docs/denoising.md).
inline constexpr double kUnsaidNoiseToDenoise = 6;

/// What a user says of a photograph, on the command line or in a shot file. What is left out is chosen (shot.hpp).
struct ShotRequest {
    std::string scene;  ///< a file
    double scale = 1;   ///< metres per unit of it
    std::string texture;  ///< a picture for every material; empty: the scene's own
    std::optional<Vec3f> environment_cd_m2;
    std::string environment_file;
    std::string environment_layer;  ///< of an OpenEXR file; empty: the layer that holds the picture
    EnvironmentChange environment_change;  ///< of the environment that was asked for
    SceneRequest additions;

    std::string lens = "double-gauss-50mm";  ///< a bundled one, or a file
    std::optional<LensSystem> lens_in_memory;  ///< in its place
    io::LensReadOptions lens_options;
    std::string zoom;  ///< a position of the lens; empty: as its file gives it
    std::optional<double> focal_length_mm;  ///< of a zoom lens, in place of a position
    std::optional<double> f_number;
    /// A lens was chosen in place of the one of which these were said.
    bool f_number_is_of_other_lens = false, film_is_of_other_lens = false;
    std::optional<int> blades;  ///< of the diaphragm; this and the next two: the lens's where they are left out
    std::optional<double> blade_rounding, blade_rotation_deg;
    std::optional<std::array<double, 2>> film_mm;
    std::array<double, 2> film_shift_mm = {0, 0};  ///< see Film
    std::optional<std::array<int, 2>> resolution;
    ViewRequest view;
    std::vector<PoseKey> motion;  ///< of the camera, in place of position and look_at; empty: it stands still
    Shutter shutter;
    /// Of rings and dials, whose own values below and above are then left out. Their lenses are nothing but the names
    /// of lenses, as `lens`, until settle_keys has read them.
    std::vector<CameraKey> keys;
    std::vector<std::string> key_places;  ///< of each, for messages
    Shake shake;
    std::optional<double> iso_follows_s;  ///< of a film: the ISO number follows the meter, smoothed over so long
    CameraModel model = CameraModel::full_lens;
    std::optional<double> exposure_time_s;
    double iso = 100;

    RenderSettings settings;
    Sampling sampling = Sampling::unsaid;
    NoiseRequest noise;
    bool denoises = false;
    /// --no-denoise. Otherwise pictures for screens that miss the default noise goal are denoised.
    bool keeps_noise = false;
    ToneCurve tone = ToneCurve::film;

    /// What its keys say when the shutter opens.
    CameraKey opening_key() const { return key_at(keys, shutter.opens_s); }
    bool meters_exposure_time() const { return !exposure_time_s && !opening_key().exposure_time_s; }
    bool chooses_environment() const { return environment_cd_m2 || !environment_file.empty(); }
};

/// Brings the goal of the noise into the settings. Throws InputError where samples are counted, but something is said
/// of it. Who says nothing of the noise itself gets that of kUnsaidGoal, and who says nothing of the time either its
/// time.
void settle_noise_goal(ShotRequest& request);

/// Throws InputError where the blades of a request are no diaphragm's.
void check_blades(const ShotRequest& request);

/// Throws InputError unless it is a luminance that a scene can be lit with.
void check_environment(Vec3f radiance_cd_m2);

}  // namespace realcam::shot
