// Shots and videos: the classes CameraKey and Shake, and the reading of shot files for realcam.Shot.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <map>
#include <tuple>
#include <utility>

#include "../../camera/film/camera_key.hpp"
#include "../../camera/film/shake.hpp"
#include "../../io/files/image_metadata.hpp"
#include "../../render/session/session.hpp"
#include "../../render/settings/setting_names.hpp"
#include "../../shot/shake_curve.hpp"
#include "../../shot/shot.hpp"
#include "../../shot/shot_file.hpp"
#include "../bindings.hpp"
#include "../scene/picture_readers.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"
#include "owned_session.hpp"
#include "python_view.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Number = std::optional<double>;
/// Point of a shake curve: (time_s, rotation_deg, position_m).
using CurvePoint = std::tuple<double, Triple, Triple>;

constexpr const char* kInterpolations[] = {"linear", "smooth", "step"};  ///< in the order of CameraKeyInterpolation

CameraKeyInterpolation camera_key_interpolation_from(const std::string& name) {
    for (std::size_t i = 0; i < std::size(kInterpolations); ++i)
        if (name == kInterpolations[i]) return static_cast<CameraKeyInterpolation>(i);
    throw InputError("interpolation: \"" + name + "\": expected linear, smooth or step");
}

CameraKey make_key(double time_s, std::optional<LensSystem> lens, Number focus_m, Number focal_length_mm,
                   Number f_number, std::optional<int> blades, Number blade_rounding, Number blade_rotation_deg,
                   Number exposure_time_s, Number iso, std::optional<std::pair<double, double>> film_shift_mm,
                   const std::string& interpolation) {
    CameraKey key{
        time_s, focus_m, focal_length_mm, f_number, exposure_time_s, iso, camera_key_interpolation_from(interpolation)};
    key.lens = std::move(lens);
    key.blades = blades;
    key.blade_rounding = blade_rounding;
    key.blade_rotation_deg = blade_rotation_deg;
    if (film_shift_mm) std::tie(key.film_right_mm, key.film_up_mm) = *film_shift_mm;
    validate(key);
    return key;
}

std::string text_of_key(const CameraKey& key) {
    std::string text = "<realcam.CameraKey at " + digits(key.time_s) + " s";
    const auto add = [&](const char* label, const Number& value, const char* unit) {
        if (value) text += std::string(", ") + label + digits(*value) + unit;
    };
    if (key.lens) text += ", " + key.lens->name;
    add("focus ", key.focus_m, " m");
    add("", key.focal_length_mm, " mm");
    add("f/", key.f_number, "");
    if (key.blades) text += ", " + std::to_string(*key.blades) + " blades";
    add("blades rounded ", key.blade_rounding, "");
    add("blades turned ", key.blade_rotation_deg, " deg");
    add("", key.exposure_time_s, " s");
    add("ISO ", key.iso, "");
    add("film ", key.film_right_mm, " mm right");
    add("film ", key.film_up_mm, " mm up");
    return text + '>';
}

Shake make_shake(double rms_deg, double rms_mm, double corner_hz, std::int64_t seed,
                 const std::vector<CurvePoint>& curve) {
    Shake shake{{}, rms_deg, rms_mm, corner_hz, seed_from(seed)};
    for (const auto& [time_s, rotation_deg, position_m] : curve)
        shake.curve.push_back({time_s, vector_of(rotation_deg), vector_of(position_m)});
    validate(shake);
    return shake;
}

std::string text_of_shake(const Shake& shake) {
    std::string text = "<realcam.Shake";
    if (!shake.curve.empty()) text += " of " + std::to_string(shake.curve.size()) + " keys";
    if (shake.rms_deg > 0) text += " " + digits(shake.rms_deg) + " deg";
    if (shake.rms_mm > 0) text += " " + digits(shake.rms_mm) + " mm";
    return text + '>';
}

/// Returns the angles in degrees and the displacements in metres at these times, arrays (N, 3).
Typed<"tuple[NDArray[float64], NDArray[float64]]", py::tuple> shake_positions(const Shake& shake,
                                                                              const std::vector<double>& times_s) {
    const std::vector<ShakeKey> keys = shake_at(shake, times_s);
    const std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(keys.size()), 3};
    py::array_t<double> angles(shape), positions(shape);
    auto to_angles = angles.mutable_unchecked<2>();
    auto to_positions = positions.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < shape[0]; ++i) {
        const ShakeKey& key = keys[static_cast<std::size_t>(i)];
        const auto fill = [i](auto& to, Vec3d v) { to(i, 0) = v.x, to(i, 1) = v.y, to(i, 2) = v.z; };
        fill(to_angles, key.rotation_deg);
        fill(to_positions, key.position_m);
    }
    return py::make_tuple(angles, positions);
}

Typed<"tuple[tuple[float, tuple[float, float, float], tuple[float, float, float]], ...]", py::tuple> curve_of(
    const Shake& shake) {
    py::list curve;
    for (const ShakeKey& key : shake.curve)
        curve.append(py::make_tuple(key.time_s, triple(key.rotation_deg), triple(key.position_m)));
    return py::tuple(curve);
}

/// Throws InputError if the keys are invalid or the camera cannot be set to one of them.
void check_camera_keys(const Camera& camera, const std::vector<CameraKey>& keys) {
    validate(keys);
    check_keys(keys, "the camera", [&](const CameraKey& key) { check_key(camera, key_at(keys, key.time_s)); });
}

/// Returns the camera of the video frame whose shutter opens at `opens_s`, in seconds of the scene.
Camera camera_at_time(const Camera& camera, const std::vector<CameraKey>& keys, const std::optional<Shake>& shake,
                      double opens_s) {
    const Unlocked unlocked;
    return shot::camera_at(camera, keys, shake.value_or(Shake{}), opens_s);
}

/// Returns the ISO of each frame of a video whose ISO is metered continuously. `frames`: frame numbers; `smoothing_s`:
/// time constant of the adaptation.
std::vector<double> followed_isos(const Assembly& scene, const Camera& camera, const std::vector<CameraKey>& keys,
                                  const RenderSettings& settings, const std::vector<int>& frames,
                                  double frames_per_second, double smoothing_s, const std::string& device) {
    const py::none no_callback;
    const Progress report = progress_of(no_callback);
    return OwnedSession::shared(device).use([&](const auto& session) {
        shot::AutoIso followed(*session, scene, camera, keys, settings, frames_per_second, smoothing_s);
        std::vector<double> isos;
        for (const int frame : frames) isos.push_back(followed.at(frame, report));
        return isos;
    });
}

void bind_key(py::module_& m) {
    py::class_<CameraKey> key(m, "CameraKey", "Keyframe of a camera's settings, at a time of a video.");
    def_hashable_value(key);
    key.def(py::init(&make_key), "time_s"_a, py::kw_only(), "lens"_a = py::none(), "focus_m"_a = py::none(),
            "focal_length_mm"_a = py::none(), "f_number"_a = py::none(), "blades"_a = py::none(),
            "blade_rounding"_a = py::none(), "blade_rotation_deg"_a = py::none(), "exposure_time_s"_a = py::none(),
            "iso"_a = py::none(), "film_shift_mm"_a = py::none(), "interpolation"_a = "linear",
            R"(A setting that is None is interpolated between the neighbouring keys that have a value.
time_s: time of the key, in seconds of the scene.
lens: a cut to another Lens, which the camera has from this key on; before the first key with a lens it has its own.
  focus_m to blade_rotation_deg are interpolated between keys of the same lens only. A lens without keys for focus or
  f-number takes over the last values of the lens before it.
focus_m: distance from the object plane to the film, inf allowed. focal_length_mm: of a zoom lens focused at infinity.
f_number: as engraved. blades: number of diaphragm blades. blade_rounding, blade_rotation_deg: see Lens().
exposure_time_s, iso: exposure. film_shift_mm: (right, up), see Film().
interpolation: from this key to the next: "linear"; "smooth": starts and ends with slope 0, and passes smooth keys in
  between without a stop; "step": constant, with a jump at the next key.
film_shift_mm, blade_rounding, blade_rotation_deg and 1 / focus_m are interpolated linearly, the other numbers in their
logarithms; lens and blades jump. Raises InputError.)")
        .def_readonly("time_s", &CameraKey::time_s, "Time of the key, in seconds of the scene.")
        .def_readonly("lens", &CameraKey::lens, "Lens from this key on; None: no cut.")
        .def_readonly("focus_m", &CameraKey::focus_m, "Distance from the object plane to the film.")
        .def_readonly("focal_length_mm", &CameraKey::focal_length_mm,
                      "Focal length of a zoom lens focused at infinity.")
        .def_readonly("f_number", &CameraKey::f_number, "f-number as engraved.")
        .def_readonly("blades", &CameraKey::blades, "Number of diaphragm blades from this key on.")
        .def_readonly("blade_rounding", &CameraKey::blade_rounding, "0 for straight blade edges to 1 for a circle.")
        .def_readonly("blade_rotation_deg", &CameraKey::blade_rotation_deg, "Rotation of the diaphragm.")
        .def_readonly("exposure_time_s", &CameraKey::exposure_time_s, "Exposure time.")
        .def_readonly("iso", &CameraKey::iso, "Sensitivity.")
        .def_property_readonly(
            "film_shift_mm",
            [](const CameraKey& k) -> std::optional<std::pair<double, double>> {
                if (!k.film_right_mm || !k.film_up_mm) return std::nullopt;
                return std::pair(*k.film_right_mm, *k.film_up_mm);
            },
            "(right, up), shift of the film's centre from the lens's axis.")
        .def_property_readonly(
            "interpolation",
            [](const CameraKey& k) { return kInterpolations[static_cast<std::size_t>(k.interpolation)]; },
            "\"linear\", \"smooth\" or \"step\", from this key to the next.")
        .def("__repr__", &text_of_key);
}

void bind_shake(py::module_& m) {
    py::class_<Shake> shake(m, "Shake", "Camera shake: a measured curve, a random process, or the sum of both.");
    def_hashable_value(shake);
    shake
        .def(py::init(&make_shake), py::kw_only(), "rms_deg"_a = 0.0, "rms_mm"_a = 0.0, "corner_hz"_a = 1.0,
             "seed"_a = 0, "curve"_a = std::vector<CurvePoint>(),
             R"(rms_deg, rms_mm: RMS of each rotation angle and of each displacement of the random process, about and
  along the camera's axes right, up and backward. Each is an independent Gaussian process with the one-sided power
  spectrum 4 rms^2 / (pi corner_hz) / (1 + (f / corner_hz)^2)^2 over the frequency f, up to 10 corner_hz.
corner_hz: corner frequency of the spectrum. seed: of the random numbers.
curve: list of (time_s, (x, y, z) in degrees, (x, y, z) in metres), in increasing order of time; rotations about x, then
  y, then z. Raises InputError.)")
        .def_static(
            "load",
            [](const PathLike& path) {
                const std::string name = path_from(path);
                return Shake{.curve = shot::read_shake_curve(name)};
            },
            "path"_a,
            R"(Reads a curve from a .csv file, whose first line names its columns: time_s, x_deg, y_deg, z_deg, x_m,
y_m, z_m. All but time_s may be missing. Raises InputError with file and line.)")
        .def("at", &shake_positions, "times_s"_a,
             "Returns the rotations (N, 3) in degrees and the displacements (N, 3) in metres of the camera at times "
             "(N,).")
        .def_readonly("rms_deg", &Shake::rms_deg, "RMS of each angle of the random process.")
        .def_readonly("rms_mm", &Shake::rms_mm, "RMS of each displacement of the random process.")
        .def_readonly("corner_hz", &Shake::corner_hz, "Corner frequency of the spectrum.")
        .def_readonly("seed", &Shake::seed, "Seed of the random process.")
        .def_property_readonly("curve", &curve_of,
                               "Measured curve: (time_s, (x, y, z) in degrees, (x, y, z) in metres) for each point.")
        .def("__repr__", &text_of_shake);
}

void bind_shot_keys(py::module_& m) {
    using shot::ShotKey;
    py::class_<ShotKey>(m, "_ShotKey", "Internal. A setting of a shot: a key of shot files.")
        .def_readonly("name", &ShotKey::name, "Name in shot files and in Python.")
        .def_property_readonly(
            "option",
            [](const ShotKey& key) { return key.option ? std::optional<std::string>(key.option) : std::nullopt; },
            "Option of the command line; None: there is none.")
        .def_readonly("group", &ShotKey::group, "Heading of the option in help texts.")
        .def_readonly("placeholder", &ShotKey::placeholder, "Placeholder of the option's value.")
        .def_readonly("text", &ShotKey::text, "Description in help texts.")
        .def_readonly("initial", &ShotKey::initial, "Description of the default; may be empty.")
        .def_readonly("details", &ShotKey::details, "Further sentences of the description; may be empty.")
        .def_property_readonly("help", &ShotKey::help, "Description with the default.");
    m.def(
        "_shot_keys",
        [] {
            const std::span<const ShotKey> keys = shot::shot_keys();
            return std::vector<ShotKey>(keys.begin(), keys.end());
        },
        "Internal. Returns all keys of shot files.");
}

/// Returns pairs of shot key and value, in the order of the keys, for values by key name.
std::vector<std::pair<const shot::ShotKey*, std::string>> options_of(const std::map<std::string, std::string>& values) {
    std::vector<std::pair<const shot::ShotKey*, std::string>> options;
    for (const shot::ShotKey& key : shot::shot_keys())
        if (const auto value = values.find(key.name); value != values.end()) options.emplace_back(&key, value->second);
    return options;
}

/// Returns the attributes of realcam.Shot by name, and true if neither a number of samples nor a noise goal is
/// specified. `path`: shot or scene file. `changes`: TOML text, and `options`: values by key name, which replace the
/// file's (see shot::ShotChanges). `scene_in_memory`: replaces the file's scene; messages then call it by the path.
/// `lens`: replaces the file's lens. `denoises`: true if the picture will be denoised.
Typed<"tuple[_Shot, bool]", py::tuple> read_shot(const PathLike& path, const std::string& changes,
                                                 const std::map<std::string, std::string>& options,
                                                 const std::optional<Assembly>& scene_in_memory,
                                                 std::optional<LensSystem> lens, bool denoises,
                                                 const std::string& device) {
    shot::ShotRequest request;
    Camera camera;
    Assembly scene;
    std::shared_ptr<const View> view;
    std::vector<std::string> notes;
    const shot::PictureReaders readers = picture_readers();
    const std::string name = path_from(path);
    {
        const Unlocked unlocked;
        const shot::ShotChanges changed{changes, options_of(options)};
        request = scene_in_memory ? shot::shot_of_scene(name, changed) : shot::read_shot(name, changed);
        request.lens_in_memory = std::move(lens);
        request.denoises = denoises;
        shot::resolve_noise_goal(request, denoises);
        request.lens_options.keep_going = heed_signals;
        request.lens_options.warn = [&](const std::string& note) { notes.push_back(note); };
        shot::resolve_keys(request);
        camera = shot::camera_of(request);
        view = shot::view_of(request);
        request.lens_options = {};  // its functions refer to local variables
        scene = scene_in_memory ? shot::scene_of(request, *scene_in_memory, readers, heed_signals)
                                : shot::scene_of(request, readers, heed_signals);
    }
    for (const std::string& note : notes) warn(note);
    shot::Shot shot = shot::set_up(request, std::move(camera), std::move(scene));
    if (request.meters_exposure_time()) {
        const py::none no_callback;
        const Progress report = progress_of(no_callback);
        OwnedSession::shared(device).use([&](const auto& session) { meter(shot, request, *session, report); });
    }
    py::dict fields("scene"_a = shot.scene, "camera"_a = shot.camera, "settings"_a = request.settings,
                    "tone"_a = tone_from(*view),
                    "exr_color_space"_a = name_among(kExrColorSpaces, request.exr_color_space),
                    "keys"_a = py::tuple(py::cast(request.keys)),
                    "shake"_a = request.shake.is_still() ? std::nullopt : std::optional(request.shake),
                    "iso_follows_s"_a = request.iso_follows_s);
    return py::make_tuple(std::move(fields), request.sampling == shot::Sampling::unspecified);
}

/// See CalibratedCameraMaker. Called without the GIL.
Camera calibrated_camera(const shot::CalibrationRequest& request, const std::optional<LensSystem>& lens,
                         std::optional<double> film_width_mm, std::optional<double> f_number) {
    const py::gil_scoped_acquire locked;
    try {
        return py::module_::import("realcam.calibration.shot_camera")
            .attr("camera_of_shot")(request.file, request.camera, request.vignetting, lens, film_width_mm, f_number)
            .cast<Camera>();
    } catch (py::error_already_set& error) {
        // Mistakes of the user are reported like those of the shot; all other errors pass through.
        if (!error.matches(py::module_::import("realcam").attr("RealcamError"))) throw;
        throw InputError(py::str(error.value()).cast<std::string>());
    }
}

}  // namespace

void bind_shot(py::module_& m) {
    shot::calibrated_camera_maker() = &calibrated_camera;
    bind_key(m);
    bind_shake(m);
    bind_shot_keys(m);
    m.def("_check_camera_keys", &check_camera_keys, "camera"_a, "keys"_a,
          "Internal. Raises InputError if keys are invalid or the camera cannot be set to one of them.");
    m.def("_camera_at", &camera_at_time, "camera"_a, "keys"_a, "shake"_a, "opens_s"_a,
          "Internal. Returns the camera of the frame whose shutter opens at opens_s, in seconds of the scene.");
    m.def("_frames_to_plan", &shot::frames_to_plan, "numbers"_a, "camera"_a, "keys"_a, "frames_per_second"_a,
          "Internal. Selects from the frame numbers of a video those whose cameras the planner looks at.");
    m.def("_frame_seed", &shot::frame_seed, "seed"_a, "number"_a, "Internal. Returns the seed of a frame of a video.");
    m.def("_followed_isos", &followed_isos, "scene"_a, "camera"_a, "keys"_a, "settings"_a, "frames"_a,
          "frames_per_second"_a, "smoothing_s"_a, "device"_a,
          "Internal. Returns the ISO of each frame of a video with continuous metering. smoothing_s: time constant.");
    m.def("_read_shot", &read_shot, "path"_a, "changes"_a, "options"_a, "scene"_a, "lens"_a, "denoises"_a, "device"_a,
          R"(Internal: use realcam.Shot. Returns the attributes of a Shot, and True if neither spp nor a noise goal is
specified. changes: TOML text that overrides the file; options: values by key name, as on the command line. scene, lens:
replace those of the file unless None. denoises: True if the picture will be denoised. device: meters the exposure.)");
}

}  // namespace realcam::bindings
