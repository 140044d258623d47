#include "shot_keys.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "../io/text/printable.hpp"
#include "../render/settings/setting_names.hpp"
#include "../scene/scene_checks.hpp"
#include "read_camera_keys.hpp"
#include "shot_table.hpp"

namespace realcam::shot {
namespace {

using Table = const ShotTable&;
using Key = const ShotKey&;
using Request = ShotRequest&;

/// Returns the member of a request, or of a keyframe, at the end of a path of pointers to members.
template <auto... path>
auto& at(auto& r) {
    return (r.*....*path);
}

// Functions to_...: ShotKey::read and ShotKey::read_keyframe of keys of a kind. They store the value of a key in the
// request or keyframe, in the member at `path` if they have this parameter.

template <auto... path>
void to_number(Table t, Key key, auto& r) {
    at<path...>(r) = *t.number(key.name);
}

template <auto... path>
void to_number_or_auto(Table t, Key key, Request r) {
    at<path...>(r) = t.number_or_auto(key.name, key.wanted);
}

template <auto... path>
void to_whole(Table t, Key key, auto& r) {
    at<path...>(r) = t.whole(key.name, *t.number(key.name));
}

template <auto... path>
void to_text(Table t, Key key, Request r) {
    std::string& value = at<path...>(r);
    value = t.name(key.name);
    if (value.empty()) t.fail(t.shown(key.name) + " is empty; expected " + key.wanted, t.find(key.name));
}

template <auto... path>
void to_file(Table t, Key key, Request r) {
    at<path...>(r) = t.path(key.name);
}

template <auto... path>
void to_point(Table t, Key key, Request r) {
    at<path...>(r) = *t.point(key.name);
}

template <auto... path>
void to_pair(Table t, Key key, Request r) {
    const std::vector<double> v = t.numbers(key.name, 2);
    at<path...>(r) = {v[0], v[1]};
}

/// Reads the lens. If it replaces that of the shot file, marks the f-number and film size of the file as those of the
/// former lens.
void to_lens(Table t, Key, Request r) {
    if (const std::string name = lens_of(t); !name.empty()) r.lens = name;
    if (!t.is_changed("lens")) return;
    r.f_number_is_of_other_lens = t.find("f_number") && !t.is_changed("f_number");
    r.film_is_of_other_lens = t.find("film_mm") && !t.is_changed("film_mm");
}

void to_resolution(Table t, Key key, Request r) {
    const std::vector<double> v = t.numbers(key.name, 2);
    r.resolution = {t.whole(key.name, v[0]), t.whole(key.name, v[1])};
}

/// Reads the file of a calibration, or a table [calibration] with its values.
void to_calibration(Table t, Key key, Request r) {
    const toml::node* node = t.find(key.name);
    if (!node->is_table()) {
        r.calibration.file = t.path(key.name);
        return;
    }
    const ShotTable table(*node->as_table(), t.file());
    table.allow({"file", "camera", "vignetting"});
    if (!table.find("file")) table.fail("\"file\" is missing: a calibration");
    r.calibration = {table.path("file"), table.name("camera"), table.path("vignetting")};
}

/// Reads a radiance or the name of a picture. On the command line, a text that is neither a number nor the name of an
/// existing file is an error, because it may be a misspelt number.
void to_environment(Table t, Key key, Request r) {
    if (!t.find(key.name)->is_number()) {
        r.environment_file = t.path(key.name);
        std::error_code error;
        if (t.is_changed(key.name) && !std::filesystem::exists(r.environment_file, error))
            t.fail(t.shown(key.name) + " must be " + key.wanted + "; there is no file " +
                       io::in_quotes(r.environment_file),
                   t.find(key.name));
        return;
    }
    const auto radiance = static_cast<float>(*t.number(key.name));
    r.environment_cd_m2 = {radiance, radiance, radiance};
}

/// Reads the visibility of the air, or a table [air].
void to_air(Table t, Key key, Request r) {
    const toml::node* node = t.find(key.name);
    Air air;
    const auto read_visibility = [&](Table table, const char* name) {
        const double visibility_m = *table.number(name);
        table.checked(name, [&] { air.extinction = extinction_of_visibility(visibility_m); });
    };
    if (!node->is_table()) {
        read_visibility(t, key.name);
        r.air = air;
        return;
    }
    const ShotTable table(*node->as_table(), t.file());
    table.allow({"visibility_m", "extinction_per_m", "albedo", "anisotropy", "margin_m"});
    const auto color = [](Vec3d v) {
        return Color{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    const auto extinction = table.number_or_three("extinction_per_m");
    if (extinction.has_value() == (table.find("visibility_m") != nullptr))
        table.fail("expected either \"visibility_m\" or \"extinction_per_m\"");
    if (extinction)
        air.extinction = color(*extinction);
    else
        read_visibility(table, "visibility_m");
    if (const auto albedo = table.number_or_three("albedo")) air.albedo = color(*albedo);
    if (const auto anisotropy = table.number("anisotropy")) air.anisotropy = static_cast<float>(*anisotropy);
    air.margin_m = table.number("margin_m");
    table.checked(nullptr, [&] { validate(air); });
    r.air = air;
}

void to_model(Table t, Key key, Request r) {
    r.model = *t.named(key.name, [](std::string_view name) { return value_named(kCameraModels, name); }, key.wanted);
}

void to_focus_of_keyframe(Table t, Key key, CameraKey& keyframe) {
    const std::string wanted = "a number of metres or inf";
    keyframe.focus_m = t.number_or_auto(key.name, wanted);
    if (!keyframe.focus_m) t.fail(t.shown(key.name) + " of a key must be " + wanted, t.find(key.name));
}

void to_variants(Table t, Key key, Request r) {
    r.variants = t.texts(key.name);
}

void to_film_shift_of_keyframe(Table t, Key key, CameraKey& keyframe) {
    const std::vector<double> v = t.numbers(key.name, 2);
    keyframe.film_right_mm = v[0];
    keyframe.film_up_mm = v[1];
}

void to_iso_follows(Table t, Key key, Request r) {
    to_number<&ShotRequest::iso_follows_s>(t, key, r);
    if (!(*r.iso_follows_s >= 0))
        t.fail(t.shown(key.name) + " must be a number of seconds, 0 or more", t.find(key.name));
}

constexpr const char *kCamera = "Camera", *kScene = "Scene", *kNumber = "a number";

using R = ShotRequest;
using K = CameraKey;
using V = ViewRequest;
using C = CalibrationRequest;

/// Returns the row with further sentences of its description.
ShotKey with_details(ShotKey key, const char* details) {
    key.details = details;
    return key;
}

// clang-format off
std::vector<ShotKey> camera_and_scene_keys() {
    using enum Syntax;
    return {
        with_details({"lens", "--lens", kCamera, "LENS", text, "a lens",
         "Bundled lens (`realcam lens list`), or a lens file: .toml, .zmx, .seq, .len, .dat, .json, .roa",
         "double-gauss-50mm", {"zoom", "focal_length_mm"}, to_lens},
         "A name with a / or a dot is that of a file."),
        {"zoom", "--zoom", kCamera, "NAME", text, "the name of a zoom position of the lens",
         "Zoom position, by its name in `realcam lens info`", "that of the lens's file", {"focal_length_mm"},
         to_text<&R::zoom>},
        {"focal_length_mm", "--focal-length", kCamera, "MM", number, kNumber,
         "Focal length of a zoom lens, between those of its positions", "that of the zoom position", {"zoom"},
         to_number<&R::focal_length_mm>, to_number<&K::focal_length_mm>, true},
        {"film_mm", "--film", kCamera, "WxH", size, "a width and a height in mm, such as 36x24",
         "Size of the film in mm", "the lens's, with the aspect ratio of the resolution", {}, to_pair<&R::film_mm>},
        {"film_shift_mm", "--film-shift", kCamera, "X,Y", two_numbers, "two lengths in mm, such as 0,8",
         "Offset of the film's centre from the optical axis, in mm to the right and up in the picture", "0,0", {},
         to_pair<&R::film_shift_mm>, to_film_shift_of_keyframe},
        with_details({"calibration", "--calibration", kCamera, "FILE", text, "a calibration file, or a table",
         "Calibration whose geometry the camera has, with the light of the lens; --lens auto chooses one",
         "the geometry of the lens", {"film_shift_mm"}, to_calibration},
         "In a shot file also a table [calibration] with file, camera and vignetting; see docs/calibration.md."),
        {"calibration_camera", "--calibration-camera", kCamera, "NAME", text, "the name of a camera of the calibration",
         "One of several cameras of the calibration", "the only one", {}, to_text<&R::calibration, &C::camera>},
        {"vignetting", "--vignetting", kCamera, "FILE", text, "a flat field, or a lensfun database",
         "Measured falloff in place of the lens's, for a calibrated camera", "the lens's", {},
         to_file<&R::calibration, &C::vignetting>},
        {"resolution", "--resolution", kCamera, "WxH", size, "a width and a height in pixels, such as 960x640",
         "Number of pixels", "960 along the longer side", {}, to_resolution},
        with_details({"camera", "--camera", kCamera, "NAME", text, "the name of a camera of the scene, or none,",
         "Camera of a glTF or USD scene whose position, direction and motion are used, by its name; or none",
         "the first, without position and direction", {"position_m", "look_at_m", "pose"}, to_text<&R::view, &V::camera>},
         "See docs/scenes.md."),
        with_details({"position_m", "--position", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1.5,-2",
         "Position of the film's centre, in metres", "in front of the scene, so that it fills the film: docs/scenes.md",
         {"camera", "pose"}, to_point<&R::view, &V::position_m>},
         "It is the centre before film_shift_mm is applied."),
        {"look_at_m", "--look-at", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1.5,-2",
         "Point at the centre of the picture, in metres", "centre of the scene", {"camera", "pose"},
         to_point<&R::view, &V::look_at_m>},
        {"up", "--up", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1,0",
         "Direction that is up in the picture", "0,1,0", {}, to_point<&R::view, &V::up>},
        {"focus_m", "--focus", kCamera, "METRES", distance_or_auto, "a number of metres, inf or auto",
         "Distance from the object plane to the film in metres, or inf", "auto: the first surface on the axis", {},
         to_number_or_auto<&R::view, &V::focus_distance_m>, to_focus_of_keyframe, true},
        {"f_number", "--f-number", kCamera, "N", number, kNumber, "Close the diaphragm to f/N", "wide open", {},
         to_number<&R::f_number>, to_number<&K::f_number>, true},
        with_details({"blades", "--blades", kCamera, "N", whole, "a whole number",
         "Number of diaphragm blades, 3 to 24, or 0 for a round opening", "the lens's", {}, to_whole<&R::blades>,
         to_whole<&K::blades>, true},
         "The area of the opening, and so the f-number, does not depend on it. Wide open, the blades are behind "
         "the rim and have no effect."),
        {"blade_rounding", "--blade-rounding", kCamera, "FRACTION", number, kNumber,
         "Curvature of the blades' edges, from 0 (straight) to 1 (circular opening)", "the lens's", {}, to_number<&R::blade_rounding>,
         to_number<&K::blade_rounding>, true},
        {"blade_rotation_deg", "--blade-rotation", kCamera, "DEGREES", number, kNumber,
         "Rotation of the blades about the axis, in degrees", "the lens's", {}, to_number<&R::blade_rotation_deg>,
         to_number<&K::blade_rotation_deg>, true},
        {"exposure_time_s", "--exposure-time", kCamera, "TIME", number_or_auto,
         "a number of seconds, such as 0.5 or 1/125, or auto",
         "Exposure time in seconds, such as 1/125, or auto", "auto: the average is middle grey", {},
         to_number_or_auto<&R::exposure_time_s>, to_number<&K::exposure_time_s>},
        {"shutter_opens_s", "--shutter-opens", kCamera, "SECONDS", number, kNumber,
         "Time at which the shutter opens, in seconds of the scene's time",
         "0", {}, to_number<&R::shutter, &Shutter::opens_s>},
        with_details({"readout_time_s", "--readout-time", kCamera, "SECONDS", number, kNumber,
         "Readout time of a rolling shutter, in seconds from the top row of pixels to the bottom", "0", {},
         to_number<&R::shutter, &Shutter::readout_time_s>},
         "0 is a global shutter (docs/motion.md)."),
        with_details({"iso_follows_s", nullptr, kCamera, "SECONDS", number, kNumber,
         "In a video, the ISO number follows the meter, smoothed over this many seconds", "constant ISO number", {},
         to_iso_follows},
         "See docs/animation.md."),
        {"iso", "--iso", kCamera, "ISO", number, kNumber, "Sensitivity as an ISO number", "100", {"iso_follows_s"},
         to_number<&R::iso>, to_number<&K::iso>},
        with_details({"model", "--model", kCamera, "MODEL", text, one_of(kCameraModels),
         "Camera model: " + one_of(kCameraModels), "full", {}, to_model},
         "full_double is the full lens in double precision, on a CPU; polynomial is fitted to the lens's rays; "
         "mapped is a thin lens with the real one's distortion and vignetting."),
        {"scale", "--scale", kScene, "METRES", number, kNumber, "Metres per unit of the scene's file", "1", {},
         to_number<&R::scale>},
        {"scene_name", "--scene-name", kScene, "NAME", text, "the name or the index of a scene",
         "Scene of a glTF file with several, by its name or index", "the file's own", {}, to_text<&R::scene_name>},
        {"variants", "--variants", kScene, "SELECTIONS", names, "variants such as /Chair{color=red}",
         "Variants of a USD stage, separated by commas, such as /Chair{color=red}", "the stage's own", {}, to_variants},
        {"texture", nullptr, kScene, "FILE", text, "a picture", "Picture that textures all materials",
         "the scene's own", {}, to_file<&R::texture>},
        with_details({"environment", "--environment", kScene, "CD_M2|FILE", number_or_file,
         "a picture, or a number of cd/m^2",
         "Environment light: a uniform luminance in cd/m^2, or a latitude-longitude picture",
         "the scene's light; daylight if it has none", {"environment_cd_m2", "environment_layer"}, to_environment},
         "A picture is an .exr, .hdr, .png or other image file (docs/scenes.md)."),
        {"environment_cd_m2", nullptr, kScene, "CD_M2", number, "a number or three",
         "Radiance of a uniform environment in cd/m^2: one number for grey, or red, green and blue", "environment",
         {"environment", "environment_layer"},
         [](Table t, Key key, Request r) { r.environment_cd_m2 = static_cast<Vec3f>(*t.number_or_three(key.name)); }},
        with_details({"environment_layer", "--environment-layer", kScene, "NAME", text, "a layer's name",
         "Layer of an OpenEXR environment with several, such as beauty", "the beauty or only layer", {},
         to_text<&R::environment_layer>},
         "See docs/scenes.md."),
        {"environment_scale", "--environment-scale", kScene, "FACTOR", number, kNumber,
         "Factor by which the environment's light is multiplied", "1", {},
         to_number<&R::environment_change, &EnvironmentChange::scale>},
        with_details({"environment_rotation_deg", "--environment-rotation", kScene, "DEGREES", number, kNumber,
         "Rotation of the environment about the vertical in degrees, counterclockwise as seen from above", "0", {},
         to_number<&R::environment_change, &EnvironmentChange::rotation_deg>},
         "See docs/scenes.md."),
        with_details({"air", "--visibility", kScene, "METRES", number, "a visibility in metres, or a table",
         "Visibility in fog or haze, in metres", "clear air", {}, to_air},
         "In a shot file also a table [air] with the air's other properties; see docs/fog.md."),
    };
}
// clang-format on

}  // namespace

std::span<const ShotKey> shot_keys() {
    static const std::vector<ShotKey> keys = [] {
        std::vector<ShotKey> all = camera_and_scene_keys();
        std::ranges::move(picture_keys(), std::back_inserter(all));
        return all;
    }();
    return keys;
}

const ShotKey& shot_key(std::string_view name) {
    return *std::ranges::find(shot_keys(), name, &ShotKey::name);
}

}  // namespace realcam::shot
