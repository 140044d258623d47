#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "../camera/film/camera_key.hpp"
#include "../camera/film/develop.hpp"
#include "../camera/film/shake.hpp"
#include "../io/lens/lens_file.hpp"
#include "../render/framing/default_view.hpp"
#include "../render/settings/render_settings.hpp"
#include "../scene/scene.hpp"
#include "calibrated_camera.hpp"
#include "ocio.hpp"
#include "scene_request.hpp"

namespace realcam::shot {

/// How the number of samples is determined.
enum class Sampling {
    unspecified,    ///< the user has not specified it: kDefaultNoiseGoal applies
    counted,   ///< settings.spp samples per pixel
    by_noise,  ///< spp is "auto": samples are taken until the noise goal is reached
};

/// Noise goal (2 of 255 codes) and time limit of a picture for which the user has specified no number of samples.
inline constexpr NoiseGoal kDefaultNoiseGoal = {.noise = 2, .seconds = 60};
/// Noise goal in codes for such a picture if it is denoised, which removes at least two thirds of the noise
/// (docs/denoising.md).
inline constexpr double kDefaultNoiseBeforeDenoising_codes = 6;

/// Settings of a picture as the user specifies them: the noise goal is not resolved yet (resolve_noise_goal).
struct PictureRequest {
    RenderSettings settings;
    Sampling sampling = Sampling::unspecified;
    NoiseRequest noise;
};

/// Specification of a photograph, from the command line or a shot file. Values that it omits are chosen by set_up and
/// meter (shot.hpp).
struct ShotRequest : PictureRequest {
    std::string scene;  ///< scene file
    double scale = 1;   ///< metres per unit of the scene file
    std::vector<std::string> variants;  ///< of a USD stage (io::SceneFileOptions)
    std::string scene_name;  ///< in a glTF file (io::SceneFileOptions)
    std::string texture;  ///< picture for all materials; empty: the scene's own textures
    std::optional<Vec3f> environment_cd_m2;  ///< radiance of a uniform environment, linear Rec. 709
    std::string environment_file;            ///< latitude-longitude picture; empty: none
    std::string environment_layer;  ///< layer of an OpenEXR file; empty: the layer that holds the picture
    EnvironmentChange environment_change;  ///< scale and rotation of the requested environment
    std::optional<Air> air;  ///< replaces that of the scene
    SceneRequest additions;                ///< objects, materials and lights that are added to the scene

    std::string lens = "double-gauss-50mm";  ///< bundled lens, or a lens file
    std::optional<LensSystem> lens_in_memory;  ///< used instead of `lens`
    io::LensReadOptions lens_options;
    std::string zoom;  ///< zoom position of the lens; empty: as in its file
    std::optional<double> focal_length_mm;  ///< for a zoom lens, in place of a position
    std::optional<double> f_number;
    /// True if the f-number or the film size is that of the shot file or of the stage's camera, and the lens is not:
    /// an option has replaced it, or the stage has none.
    bool f_number_is_of_other_lens = false, film_is_of_other_lens = false;
    /// True if the focus distance in `view`, or those in `keys`, are measured to the entrance pupil of the lens, as in
    /// USD stages. camera_of changes them to distances to the film.
    bool view_focus_is_to_pupil = false, key_focus_is_to_pupil = false;
    std::optional<int> blades;  ///< number of blades of the diaphragm; missing blade properties are those of the lens
    std::optional<double> blade_rounding, blade_rotation_deg;
    std::optional<std::array<double, 2>> film_mm;  ///< width and height
    std::array<double, 2> film_shift_mm = {0, 0};  ///< see Film
    CalibrationRequest calibration;
    std::optional<std::array<int, 2>> resolution;  ///< columns and rows of pixels
    ViewRequest view;
    std::vector<PoseKey> motion;  ///< motion of the camera, instead of the position in `view`; empty: it does not move
    Shutter shutter;
    /// Keyframes of the camera's rings and dials, which replace the values in this struct. Their lenses hold only
    /// names, as `lens` does, until resolve_keys has read them.
    std::vector<CameraKey> keys;
    std::vector<std::string> key_locations;  ///< position of each key in the file, for messages
    Shake shake;
    /// Smoothing time of the ISO number in a video whose ISO number follows the meter (AutoIso).
    std::optional<double> iso_follows_s;
    CameraModel model = CameraModel::full_lens;
    std::optional<double> exposure_time_s;
    double iso = 100;

    bool denoises = false;  ///< set by --denoise
    /// Set by --no-denoise. Otherwise pictures for screens that miss the default noise goal are denoised.
    bool keeps_noise = false;
    ToneCurve tone = ToneCurve::film;
    OcioRequest ocio;
    ExrColorSpace exr_color_space = ExrColorSpace::rec709;

    /// State of the keyframes when the shutter opens.
    CameraKey opening_key() const { return key_at(keys, shutter.opens_s); }
    /// True if neither the request nor a keyframe specifies the exposure time.
    bool meters_exposure_time() const { return !exposure_time_s && !opening_key().exposure_time_s; }
    /// True if the request specifies an environment, which replaces that of the scene.
    bool chooses_environment() const { return environment_cd_m2 || !environment_file.empty(); }
};

/// Sets the noise goal in the settings. Throws InputError if the number of samples is specified together with parts of
/// the goal. If neither is specified, the goal is kDefaultNoiseGoal or, if the picture will be denoised,
/// kDefaultNoiseBeforeDenoising_codes; if no time is specified either, the limit of kDefaultNoiseGoal applies.
void resolve_noise_goal(PictureRequest& request, bool denoises = false);

/// Throws InputError if the blades of a request do not form a valid diaphragm.
void check_blades(const ShotRequest& request);

/// Throws InputError if the radiance is invalid for an environment.
void check_environment(Vec3f radiance_cd_m2);

}  // namespace realcam::shot
