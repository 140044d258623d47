#include "shot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "../camera/film/camera.hpp"
#include "../camera/models/pinhole_camera.hpp"
#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/lens/lens_file.hpp"
#include "../math/hypotenuse.hpp"
#include "../math/random.hpp"
#include "../number_text.hpp"
#include "../optics/lens/focus.hpp"
#include "../optics/lens/rings.hpp"
#include "../optics/prescription/lens_checks.hpp"
#include "../render/framing/default_view.hpp"
#include "../render/session/metering.hpp"
#include "shot_scene.hpp"

namespace realcam::shot {
namespace {

/// Replaces the diffuse textures of all materials by a picture.
void add_texture(Scene& scene, const std::string& path, const PictureReaders& readers) {
    Texture texture = read_texture(path, io::TextureUse::colour, readers);
    if (scene.uvs.empty()) throw InputError(path + ": the scene has no texture coordinates, which a texture needs");
    const auto index = static_cast<std::int32_t>(scene.textures.size());
    scene.textures.push_back(std::move(texture));
    for (Material& material : scene.materials) material.diffuse_texture = {index, {1, 0, 0}, {0, 1, 0}};
}

/// Passes a warning to the lens reader's function for warnings.
void warn(const ShotRequest& request, const std::string& notice) {
    if (request.lens_options.warn) request.lens_options.warn(notice);
}

/// Rings that set only the blades of the request.
Rings blades_of(const ShotRequest& request) {
    return {{}, request.blades, request.blade_rounding, request.blade_rotation_deg, {}, false, {}};
}

/// Notice about a lens whose design film is smaller than the camera's film; otherwise empty.
std::string film_notice(const LensSystem& lens, const Film& film) {
    const double design_diagonal = hypotenuse(lens.film_width, lens.film_height);
    constexpr double kTolerance = 0.99;  // of the diagonal
    if (design_diagonal >= kTolerance * hypotenuse(film.width_mm, film.height_mm)) return "";
    char text[160];
    std::snprintf(text, sizeof text,
                  "the lens is made for a film of %.4g x %.4g mm, and the shot has %.4g x %.4g mm; film_mm sets "
                  "the film size",
                  lens.film_width, lens.film_height, film.width_mm, film.height_mm);
    return text;
}

/// Runs `work` on a keyframe of a file; its errors begin with the keyframe's position in the file.
template <class Work>
void with_location(const std::string& location, Work&& work) {
    try {
        work();
    } catch (const InputError& error) {
        throw InputError(location + ": " + error.what());
    } catch (const LensFileError& error) {
        if (!error.file.empty()) throw;
        throw InputError(location + ": " + error.what());
    }
}

/// The lens with zoom, f-number and blades of the request. If an option has replaced the shot file's lens, and the lens
/// is slower than the shot file's f-number, it is wide open, with a warning.
LensSystem with_shot_rings(const ShotRequest& request, const LensSystem& lens) {
    Rings rings = blades_of(request);
    if (!request.zoom.empty()) rings.zoom = request.zoom;
    if (request.focal_length_mm) rings.zoom = *request.focal_length_mm;
    rings.f_number = request.f_number;
    rings.opens_as_far_as_it_can = request.f_number_is_of_other_lens;
    LensSystem result = with_rings(lens, rings);
    if (!request.f_number_is_of_other_lens) return result;
    const double opens_to = f_number_at_infinity(result);
    if (*rings.f_number < (1 - kEngravingError) * opens_to)
        warn(request, "the lens opens to f/" + number_text(opens_to, 3) + ", and the shot has f/" +
                          number_text(*rings.f_number, 3) + ": it is wide open");
    return result;
}

/// Throws InputError, with the position in the file, if the camera cannot assume the state of a keyframe.
void check_keys(const ShotRequest& request, const Camera& camera) {
    for (std::size_t i = 0; i < request.keys.size(); ++i)
        with_location(request.key_locations[i], [&] {
            const std::string notice =
                request.keys[i].lens && !request.film_mm ? film_notice(*request.keys[i].lens, camera.film) : "";
            if (!notice.empty()) throw InputError(notice);
            check_key(camera, key_at(request.keys, request.keys[i].time_s));
        });
}

}  // namespace

void check_blades(const ShotRequest& request) {
    try {
        check_iris(
            {request.blades.value_or(0), request.blade_rounding.value_or(0), request.blade_rotation_deg.value_or(0)});
    } catch (const LensFileError& error) {
        throw InputError(error.what());
    }
}

void resolve_noise_goal(PictureRequest& request, bool denoises) {
    if (request.sampling == Sampling::counted) {
        if (!request.noise.says_nothing())
            throw InputError("noise, noise_codes, seconds and max_spp need spp \"auto\"");
        request.settings.noise.reset();
        return;
    }
    NoiseRequest noise = request.noise;
    if (request.sampling == Sampling::unspecified && !noise.noise && !noise.noise_codes) {
        noise.noise_codes = denoises ? kDefaultNoiseBeforeDenoising_codes : kDefaultNoiseGoal.noise;
        if (!noise.seconds) noise.seconds = kDefaultNoiseGoal.seconds;
    }
    request.settings.noise = goal_of(noise);
}

void resolve_keys(ShotRequest& request) {
    io::LensReadOptions options = request.lens_options;
    options.glasses.clear();  // these belong to the first lens
    for (std::size_t i = 0; i < request.keys.size(); ++i)
        if (std::optional<LensSystem>& lens = request.keys[i].lens)
            with_location(request.key_locations[i],
                          [&] { lens = with_rings(io::read_lens(lens->name, options), blades_of(request)); });
    const auto cut = std::find_if(request.keys.begin(), request.keys.end(),
                                  [](const CameraKey& key) { return key.lens.has_value(); });
    const bool zooms =
        std::any_of(request.keys.begin(), cut, [](const CameraKey& key) { return key.focal_length_mm.has_value(); });
    if (zooms && request.f_number) request.keys.front().f_number = std::exchange(request.f_number, {});
}

OcioReader& ocio_reader() {
    static OcioReader reader;
    return reader;
}

namespace {

/// Opens the configuration of a request. Throws InputError.
std::shared_ptr<const OcioConfig> opened(const OcioRequest& ocio) {
    if (!ocio_reader())
        throw InputError(ocio.config +
                         ": this program has no OpenColorIO; the command of the Python package realcam[color] has it");
    if (!ocio.config.starts_with(kBuiltInConfig))
        if (const std::string why = io::why_unreadable(ocio.config); !why.empty())
            throw InputError(ocio.config + ": " + why);
    return ocio_reader()(ocio.config);
}

/// Returns readers that convert pictures from the colour spaces of a request. Throws InputError if the configuration
/// does not have them.
PictureReaders with_color_spaces(const OcioRequest& ocio, PictureReaders readers) {
    if (ocio.environment_color_space.empty() && ocio.texture_color_space.empty()) return readers;
    // Returns a function from the path of a picture to the conversion. Pictures in memory have no rule.
    const auto conversions = [config = opened(ocio)](const std::string& color_space) {
        const bool has_rules = color_space == kFileRules;
        return [=, stated = has_rules ? io::ColorConversion()
                                      : config->to_rec709(color_space, "")](const std::string& path) {
            return has_rules && !path.empty() ? config->to_rec709(color_space, path) : stated;
        };
    };
    if (!ocio.environment_color_space.empty())
        readers.environment = [conversion = conversions(ocio.environment_color_space), read = readers.environment](
                                  const std::string& path, const std::string& layer, const io::ColorConversion&,
                                  const auto& warn) { return read(path, layer, conversion(path), warn); };
    if (!ocio.texture_color_space.empty())
        readers.texture = [conversion = conversions(ocio.texture_color_space), read = readers.texture](
                              const std::string& path, std::span<const std::uint8_t> bytes) {
            std::optional<io::DecodedImage> image = read(path, bytes);
            if (image) image->to_rec709 = conversion(path);
            return image;
        };
    return readers;
}

}  // namespace

std::shared_ptr<const View> view_of(const ShotRequest& request) {
    const OcioRequest& ocio = request.ocio;
    if (ocio.config.empty()) return std::make_shared<ToneView>(request.tone);
    return opened(ocio)->view(ocio.display, ocio.view);
}

CalibratedCameraMaker& calibrated_camera_maker() {
    static CalibratedCameraMaker maker;
    return maker;
}

namespace {

/// Camera with lens and film of a request.
Camera lens_camera(const ShotRequest& request) {
    Camera camera;
    camera.lens = request.lens_in_memory ? *request.lens_in_memory : io::read_lens(request.lens, request.lens_options);
    camera.lens = with_shot_rings(request, camera.lens);
    camera.film = default_film(camera.lens, request.film_mm, request.resolution);
    if (request.film_is_of_other_lens)
        if (const std::string notice = film_notice(camera.lens, camera.film); !notice.empty()) warn(request, notice);
    camera.film.shift_mm = {request.film_shift_mm[0], request.film_shift_mm[1]};
    return camera;
}

/// Camera with lens, film and geometry of the calibration of a request.
Camera calibrated_camera(const ShotRequest& request) {
    if (!calibrated_camera_maker())
        throw InputError("calibrations are read by the Python package of realcam; this program cannot read " +
                         request.calibration.file);
    if (request.film_shift_mm[0] != 0 || request.film_shift_mm[1] != 0)
        throw InputError("film_shift_mm and calibration exclude each other: the principal point shifts the film");
    std::optional<LensSystem> lens = request.lens_in_memory;
    if (!lens && request.lens != "auto")
        lens = with_shot_rings(request, io::read_lens(request.lens, request.lens_options));
    const std::optional<double> width_mm = request.film_mm ? std::optional((*request.film_mm)[0]) : std::nullopt;
    Camera camera = calibrated_camera_maker()(request.calibration, lens, width_mm, request.f_number);
    if (!lens) camera.lens = with_rings(camera.lens, blades_of(request));
    Film& film = camera.film;
    if (request.film_mm && std::fabs((*request.film_mm)[1] / film.height_mm - 1) > 1e-3)
        throw InputError("the film's height is " + number_text((*request.film_mm)[1], 6) +
                         " mm; expected that of the calibration at this width, " + number_text(film.height_mm, 6) +
                         " mm");
    if (request.resolution) {
        const auto [width, height] = *request.resolution;
        if (std::fabs(static_cast<double>(width) * film.height - static_cast<double>(height) * film.width) >
            std::max(film.width, film.height))
            throw InputError("the resolution is " + std::to_string(width) + " x " + std::to_string(height) +
                             "; expected the aspect ratio of the calibration, " + std::to_string(film.width) + " x " +
                             std::to_string(film.height));
        film.width = width;
        film.height = height;
    }
    return camera;
}

/// Distance from the entrance pupil to the film when the shutter opens, m, of a request whose focus distances are
/// measured to the entrance pupil. `camera`: with the first lens.
double opening_pupil_to_film_m(const ShotRequest& request, const Camera& camera) {
    CameraKey key = request.opening_key();
    const std::optional<double> focus_m = std::exchange(key.focus_m, {});
    const double distance_m = focus_m ? *focus_m : request.view.focus_distance_m.value_or(kInfinity);
    try {
        const LensSystem lens = with_key(camera, key).lens;
        double pupil_m = pupil_to_film_m(lens), before_m = kInfinity;
        // Focusing moves the pupil by about the square of focal length / distance of a change of the distance.
        for (int i = 0; i < 20 && !(std::fabs(pupil_m - before_m) < 1e-9); ++i)
            before_m = std::exchange(pupil_m, pupil_to_film_m(focused(lens, 1000 * (distance_m + pupil_m))));
        return pupil_m;
    } catch (const InputError&) {
        check_keys(request, camera);  // throws with the position of the keyframe
        throw;
    }
}

/// Changes focus distances that are measured to the entrance pupil of the lens to those to the film. The pupil is that
/// of the opening lens, in focus, which set_view puts at the origin of the stage's camera: the film keeps its position
/// through focus pulls and cuts.
void measure_focus_to_film(ShotRequest& request, const Camera& camera) {
    if (!request.view_focus_is_to_pupil && !request.key_focus_is_to_pupil) return;
    const double pupil_m = opening_pupil_to_film_m(request, camera);
    const auto add_pupil = [&](std::optional<double>& focus_m) {
        if (focus_m) *focus_m += pupil_m;
    };
    if (std::exchange(request.view_focus_is_to_pupil, false)) add_pupil(request.view.focus_distance_m);
    if (std::exchange(request.key_focus_is_to_pupil, false))
        for (CameraKey& key : request.keys) add_pupil(key.focus_m);
}

}  // namespace

Camera camera_of(ShotRequest& request) {
    Camera camera = request.calibration.file.empty() ? lens_camera(request) : calibrated_camera(request);
    camera.model = request.model;
    camera.iso = request.iso;
    camera.shutter = request.shutter;
    if (request.exposure_time_s) camera.exposure_time_s = *request.exposure_time_s;
    validate(camera);
    measure_focus_to_film(request, camera);
    Camera in_focus = camera;
    if (request.view.focus_distance_m)
        in_focus.lens = focused(std::move(in_focus.lens), 1000 * *request.view.focus_distance_m);
    check_keys(request, in_focus);
    return with_key(std::move(camera), request.opening_key());
}

namespace {

/// Adds additions, texture and environment of a request to its scene.
Assembly completed(const ShotRequest& request, Assembly scene, const PictureReaders& readers,
                   const KeepGoing& keep_going) {
    scene = with_additions(std::move(scene), request.additions, readers, keep_going);
    if (request.texture.empty() && !request.chooses_environment() && !request.air) return scene;
    return with_static_geometry(std::move(scene), [&](Scene& changed) {
        if (!request.texture.empty()) add_texture(changed, request.texture, readers);
        if (!request.environment_file.empty())
            changed.environment =
                readers.environment(request.environment_file, request.environment_layer, {},
                                    [&](const std::string& warning) { changed.warnings.push_back(warning); });
        if (request.environment_cd_m2) {
            changed.environment = {};
            const Vec3f rgb = *request.environment_cd_m2;
            changed.environment.constant = {rgb.x, rgb.y, rgb.z};
        }
        if (request.air) changed.air = *request.air;
        if (request.chooses_environment())
            changed.environment = realcam::changed(std::move(changed.environment), request.environment_change);
    });
}

}  // namespace

Assembly scene_of(const ShotRequest& request, const PictureReaders& file_readers, const KeepGoing& keep_going) {
    const PictureReaders readers = with_color_spaces(request.ocio, file_readers);
    return completed(
        request,
        io::read_scene(request.scene, {request.scale, {}, keep_going, request.variants, request.scene_name},
                       readers.texture),
        readers, keep_going);
}

Assembly scene_of(const ShotRequest& request, Assembly scene, const PictureReaders& readers,
                  const KeepGoing& keep_going) {
    return completed(request, std::move(scene), with_color_spaces(request.ocio, readers), keep_going);
}

Shot set_up(const ShotRequest& request, Camera camera, Assembly scene) {
    Shot shot{std::move(scene), std::move(camera), std::nullopt};
    ViewRequest view = request.view;
    if (const auto focus_m = request.opening_key().focus_m) view.focus_distance_m = focus_m;
    if (!request.motion.empty()) {
        set_motion(shot.camera, request.motion);
        const Pose pose = pose_at(shot.camera, shot.camera.shutter.opens_s);
        view = {pose.position_m, pose.look_at_m, pose.up, view.focus_distance_m, {}};
    }
    if (const SceneCamera* from = set_view(shot.camera, shot.scene, view)) shot.scene_camera = *from;
    if (!request.motion.empty()) set_motion(shot.camera, request.motion);
    shot.has_daylight = !shot.scene.has_light() && !request.chooses_environment();
    if (shot.has_daylight)
        shot.scene = with_static_geometry(std::move(shot.scene),
                                          [&](Scene& changed) { add_daylight(changed, shot.camera.pose); });
    return shot;
}

std::string view_notice(const Shot& shot) {
    if (!shot.scene_camera) return "";
    const auto degrees = [](double radians) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3g", radians * 180 / std::numbers::pi);
        return std::string(text);
    };
    return "the view is that of the scene's camera \"" + shot.scene_camera->name + "\", which saw " +
           degrees(shot.scene_camera->vertical_field_rad) +
           " degrees from its lower edge to its upper one; this lens and film see " +
           degrees(field_of_view(shot.camera).vertical);
}

void meter(Shot& shot, const ShotRequest& request, Session& session, const Progress& progress) {
    if (!request.meters_exposure_time()) return;
    shot.camera.exposure_time_s = metered_exposure_time(session, shot.scene, shot.camera, request.settings, progress);
    shot.is_metered = true;
}

double frame_opens_s(const Camera& camera, int number, double frames_per_second) {
    return camera.shutter.opens_s + (number - 1) / frames_per_second;
}

Camera camera_at(Camera camera, const std::vector<CameraKey>& keys, const Shake& shake, double opens_s) {
    camera.shutter.opens_s = opens_s;
    camera = with_key(std::move(camera), key_at(keys, opens_s));
    return shaken(std::move(camera), shake);
}

std::vector<int> frames_to_plan(const std::vector<int>& numbers, const Camera& camera,
                                const std::vector<CameraKey>& keys, double frames_per_second) {
    std::vector<int> chosen;
    std::optional<LensSystem> lens;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        std::optional<LensSystem> frame_lens = key_at(keys, frame_opens_s(camera, numbers[i], frames_per_second)).lens;
        if (i == 0 || i == numbers.size() / 2 || i + 1 == numbers.size() || frame_lens != lens)
            chosen.push_back(numbers[i]);
        lens = std::move(frame_lens);
    }
    return chosen;
}

std::uint32_t frame_seed(std::uint32_t seed, int number) {
    return hash32(static_cast<std::uint32_t>(number), seed);
}

AutoIso::AutoIso(Session& session, const Assembly& scene, Camera camera, std::vector<CameraKey> keys,
                 RenderSettings settings, double frames_per_second, double smoothing_s)
    : session_(session),
      scene_(scene),
      camera_(std::move(camera)),
      keys_(std::move(keys)),
      settings_(std::move(settings)),
      frames_per_second_(frames_per_second),
      smoothing_s_(smoothing_s) {}

double AutoIso::at(int number, const Progress& progress) {
    constexpr double kMaxAge = 5;  // in units of the smoothing time: older frames have weights below 1%
    const double frames = smoothing_s_ * frames_per_second_;
    const int first = std::max(std::min(number, 1), number - static_cast<int>(std::min(kMaxAge * frames, 1e6)));
    double sum = 0, weights = 0;
    for (int n = first; n <= number; ++n) {
        const double weight = n == number ? 1 : std::exp((n - number) / frames);
        sum += weight * std::log(metered(n, progress));
        weights += weight;
    }
    return std::exp(sum / weights);
}

double AutoIso::metered(int number, const Progress& progress) {
    const auto known = metered_.find(number);
    if (known != metered_.end()) return known->second;
    const Camera camera = camera_at(camera_, keys_, {}, frame_opens_s(camera_, number, frames_per_second_));
    const double time_s = metered_exposure_time(session_, scene_, camera, settings_, progress);
    return metered_[number] = camera.iso * time_s / camera.exposure_time_s;
}

}  // namespace realcam::shot
