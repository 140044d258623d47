#include "shot_keys.hpp"

#include <filesystem>

#include "../io/text/printable.hpp"
#include "../render/settings/effect_names.hpp"
#include "read_camera_keys.hpp"
#include "shot_table.hpp"

namespace realcam::shot {
namespace {

using Table = const ShotTable&;
using Key = const ShotKey&;
using Request = ShotRequest&;

/// Returns the member of a request at the end of a path of pointers to members.
template <auto... path>
auto& at(Request r) {
    return (r.*....*path);
}

/// Type of a value, or of the value in a std::optional.
template <class Value>
struct ValueOf {
    using type = Value;
};
template <class Value>
struct ValueOf<std::optional<Value>> {
    using type = Value;
};

// Functions to_...: ShotKey::read of keys of a kind. They store the value of a key in the request, in the member at
// `path` if they have this parameter.

template <auto... path>
void to_number(Table t, Key key, Request r) {
    at<path...>(r) = *t.number(key.name);
}

template <auto... path>
void to_number_or_auto(Table t, Key key, Request r) {
    at<path...>(r) = t.number_or_auto(key.name, key.wanted);
}

template <auto... path>
void to_whole(Table t, Key key, Request r) {
    using Value = typename ValueOf<std::remove_reference_t<decltype(at<path...>(r))>>::type;
    at<path...>(r) = t.whole<Value>(key.name, *t.number(key.name));
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

/// Runs `work`, which parses the names that a key lists; its errors begin with the key.
template <class Work>
void of_names(Table t, Key key, const Work& work) {
    try {
        work();
    } catch (const InputError& error) {
        t.fail(t.shown(key.name) + ": " + error.what(), t.find(key.name));
    }
}

template <auto find, auto... path>
void to_named(Table t, Key key, Request r) {
    at<path...>(r) = *t.named(key.name, find, key.wanted);
}

/// Reads a part of the noise goal, and checks it together with the parts read before.
template <auto read>
void to_noise(Table t, Key key, Request r) {
    read(t, key, r);
    t.checked(key.name, [&] { goal_of(r.noise); });
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

/// Reads the number of samples or "auto", for which the noise goal applies.
void to_spp(Table t, Key key, Request r) {
    const std::optional<double> spp = t.number_or_auto(key.name, key.wanted);
    r.sampling = spp ? Sampling::counted : Sampling::by_noise;
    if (spp) r.settings.spp = t.whole(key.name, *spp);
}

void to_max_bounces(Table t, Key key, Request r) {
    const std::optional<double> bounces = t.number_or_auto(key.name, key.wanted);
    r.settings.max_bounces = bounces ? std::optional(t.whole(key.name, *bounces)) : std::nullopt;
}

void to_effects(Table t, Key key, Request r) {
    const std::vector<std::string> names = t.texts(key.name);
    of_names(t, key, [&] { r.settings.effects = effects_named(names); });
}

void to_variants(Table t, Key key, Request r) {
    r.variants = t.texts(key.name);
}

void to_layers(Table t, Key key, Request r) {
    const std::vector<std::string> names = t.texts(key.name);
    of_names(t, key, [&] { r.settings.layers = layers_named(names); });
}

/// Converts a text, a number or a table [[wavelength_nm, value], ...] to an Illuminant or a LensFilter.
template <class Spectrum>
Spectrum spectrum_of(const toml::node& node, Spectrum (*from_number)(double), const std::string& key) {
    if (const auto* text = node.as_string()) return Spectrum::parse(text->get());
    if (node.is_number()) return from_number(node.value_or(0.0));
    std::vector<SpectrumPoint> points;
    if (const toml::array* pairs = node.as_array()) {
        for (const toml::node& item : *pairs) {
            const toml::array* pair = item.as_array();
            if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number()) {
                points.clear();
                break;
            }
            points.push_back({(*pair)[0].value_or(0.0), (*pair)[1].value_or(0.0)});
        }
    }
    if (points.empty())
        throw InputError(key + ": expected " + Spectrum::kWanted +
                         "; in a shot file a table is [[400, 0.5], [550, 1], [700, 0.2]]");
    return Spectrum::table(std::move(points));
}

void to_illuminant(Table t, Key key, Request r) {
    t.checked(key.name, [&] { r.settings.illuminant = spectrum_of(*t.find(key.name), &Illuminant::line, key.name); });
}

void to_filter(Table t, Key key, Request r) {
    t.checked(key.name,
              [&] { r.settings.lens_filter = spectrum_of(*t.find(key.name), &LensFilter::neutral, key.name); });
}

void to_iso_follows(Table t, Key key, Request r) {
    to_number<&ShotRequest::iso_follows_s>(t, key, r);
    if (!(*r.iso_follows_s >= 0))
        t.fail(t.shown(key.name) + " must be a number of seconds, 0 or more", t.find(key.name));
}

constexpr const char *kCamera = "Camera", *kScene = "Scene", *kPicture = "Picture", *kNumber = "a number";

using R = ShotRequest;
using V = ViewRequest;
using S = RenderSettings;

// clang-format off
std::vector<ShotKey> all_keys() {
    using enum Syntax;
    return {
        {"lens", "--lens", kCamera, "LENS", text, "a lens",
         "Bundled lens (`realcam lens list`), or a lens file: .toml, .zmx, .seq, .len, .dat, .json, .roa",
         "double-gauss-50mm", {"zoom", "focal_length_mm"}, to_lens},
        {"zoom", "--zoom", kCamera, "NAME", text, "the name of a zoom position of the lens",
         "Zoom position, by its name in `realcam lens info`", "as the lens's file gives it", {"focal_length_mm"},
         to_text<&R::zoom>},
        {"focal_length_mm", "--focal-length", kCamera, "MM", number, kNumber,
         "Focal length of a zoom lens, between those of its positions", "that of its position", {"zoom"},
         to_number<&R::focal_length_mm>},
        {"film_mm", "--film", kCamera, "WxH", size, "a width and a height in mm, such as 36x24",
         "Size of the film in mm", "the lens's, with the aspect ratio of the resolution", {}, to_pair<&R::film_mm>},
        {"film_shift_mm", "--film-shift", kCamera, "X,Y", two_numbers, "two lengths in mm, such as 0,8",
         "Offset of the film's centre from the optical axis, in mm to the right and up in the picture", "0,0", {},
         to_pair<&R::film_shift_mm>},
        {"resolution", "--resolution", kCamera, "WxH", size, "a width and a height in pixels, such as 960x640",
         "Number of pixels", "960 along the longer side", {}, to_resolution},
        {"camera", "--camera", kCamera, "NAME", text, "the name of a camera of the scene, or none,",
         "Camera of a glTF or USD scene whose position, direction and motion are used, by its name; or none",
         "the first, without position and direction", {"position_m", "look_at_m", "pose"}, to_text<&R::view, &V::camera>},
        {"position_m", "--position", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1.5,-2",
         "Position of the film's centre, in metres", "in front of the scene, so that it fills the film: docs/scenes.md",
         {"camera", "pose"}, to_point<&R::view, &V::position_m>},
        {"look_at_m", "--look-at", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1.5,-2",
         "Point at the centre of the picture, in metres", "centre of the scene", {"camera", "pose"},
         to_point<&R::view, &V::look_at_m>},
        {"up", "--up", kCamera, "X,Y,Z", three_numbers, "three numbers, such as 0,1,0",
         "Direction that is up in the picture", "0,1,0", {}, to_point<&R::view, &V::up>},
        {"focus_m", "--focus", kCamera, "METRES", distance_or_auto, "a number of metres, inf or auto",
         "Distance from object plane to film in metres, inf, or auto", "auto: the first surface on the axis", {},
         to_number_or_auto<&R::view, &V::focus_distance_m>},
        {"f_number", "--f-number", kCamera, "N", number, kNumber, "Close the diaphragm to f/N", "wide open", {},
         to_number<&R::f_number>},
        {"blades", "--blades", kCamera, "N", whole, "a whole number",
         "Number of diaphragm blades, 3 to 24, or 0 for a round opening", "the lens's", {}, to_whole<&R::blades>},
        {"blade_rounding", "--blade-rounding", kCamera, "SHARE", number, kNumber,
         "Curvature of the blades' edges, from 0 (straight) to 1 (circular opening)", "the lens's", {}, to_number<&R::blade_rounding>},
        {"blade_rotation_deg", "--blade-rotation", kCamera, "DEGREES", number, kNumber,
         "Rotation of the blades about the axis, in degrees", "the lens's", {}, to_number<&R::blade_rotation_deg>},
        {"exposure_time_s", "--exposure-time", kCamera, "TIME", number_or_auto,
         "a number of seconds, such as 0.5 or 1/125, or auto",
         "Exposure time in seconds, such as 1/125, or auto", "auto: the average is middle grey", {},
         to_number_or_auto<&R::exposure_time_s>},
        {"shutter_opens_s", "--shutter-opens", kCamera, "SECONDS", number, kNumber,
         "Time at which the shutter opens, in seconds of the scene's time",
         "0", {}, to_number<&R::shutter, &Shutter::opens_s>},
        {"readout_time_s", "--readout-time", kCamera, "SECONDS", number, kNumber,
         "Readout time of a rolling shutter, in seconds from the top row of pixels to the bottom", "0", {},
         to_number<&R::shutter, &Shutter::readout_time_s>},
        {"iso_follows_s", nullptr, kCamera, "SECONDS", number, kNumber,
         "In a video, the ISO number follows the meter, smoothed over this many seconds", "constant ISO number", {},
         to_iso_follows},
        {"iso", "--iso", kCamera, "ISO", number, kNumber, "Sensitivity as an ISO number", "100", {"iso_follows_s"},
         to_number<&R::iso>},
        {"model", "--model", kCamera, "MODEL", text, kModelNames, std::string("Camera model: ") + kModelNames, "full", {},
         to_named<model_named, &R::model>},
        {"scale", "--scale", kScene, "METRES", number, kNumber, "Metres per unit of the scene's file", "1", {},
         to_number<&R::scale>},
        {"variants", "--variants", kScene, "SELECTIONS", names, "variants such as /Chair{color=red}",
         "Variants of a USD stage, separated by commas, such as /Chair{color=red}", "the stage's own", {}, to_variants},
        {"texture", nullptr, kScene, "FILE", text, "a picture", "Picture that textures all materials",
         "the scene's own", {}, to_file<&R::texture>},
        {"environment", "--environment", kScene, "CD_M2|FILE", number_or_file, "a picture, or a number of cd/m^2",
         "Environment light: a uniform radiance in cd/m^2, or a latitude-longitude picture",
         "the scene's light; daylight if it has none", {"environment_cd_m2", "environment_layer"}, to_environment},
        {"environment_cd_m2", nullptr, kScene, "CD_M2", number, "a number or three",
         "Radiance of a uniform environment in cd/m^2: grey, or red, green and blue", "environment",
         {"environment", "environment_layer"},
         [](Table t, Key key, Request r) { r.environment_cd_m2 = static_cast<Vec3f>(*t.number_or_three(key.name)); }},
        {"environment_layer", "--environment-layer", kScene, "NAME", text, "a layer's name",
         "Layer of an OpenEXR environment, such as beauty, where it has several", "the beauty or only layer", {},
         to_text<&R::environment_layer>},
        {"environment_scale", "--environment-scale", kScene, "FACTOR", number, kNumber,
         "Factor by which the environment's light is multiplied", "1", {},
         to_number<&R::environment_change, &EnvironmentChange::scale>},
        {"environment_rotation_deg", "--environment-rotation", kScene, "DEGREES", number, kNumber,
         "Rotation of the environment about the vertical in degrees, counterclockwise as seen from above", "0", {},
         to_number<&R::environment_change, &EnvironmentChange::rotation_deg>},
        {"spp", "--spp", kPicture, "N", whole_or_auto, "a whole number or auto",
         "Samples per pixel, or auto: by tile of the film, until the noise goal is reached, by default 1 code",
         "until the noise is 2 codes, for 60 seconds at most", {"noise", "noise_codes", "seconds", "max_spp"}, to_spp},
        {"noise", "--noise", kPicture, "SHARE", number, kNumber,
         "Noise goal, unless spp is a number: relative to a tile's light, such as 0.01", "", {"noise_codes", "spp"},
         to_noise<to_number<&R::noise, &NoiseRequest::noise>>},
        {"noise_codes", "--noise-codes", kPicture, "CODES", number, kNumber,
         "The same noise goal in 8-bit codes of the developed picture", "", {"noise", "spp"},
         to_noise<to_number<&R::noise, &NoiseRequest::noise_codes>>},
        {"seconds", "--seconds", kPicture, "SECONDS", number, kNumber,
         "Time limit for taking samples, unless spp is a number", "", {},
         to_noise<to_number<&R::noise, &NoiseRequest::seconds>>},
        {"max_spp", "--max-spp", kPicture, "N", whole, "a whole number",
         "Largest number of samples per pixel, unless spp is a number", "4096", {},
         to_noise<to_whole<&R::noise, &NoiseRequest::max_spp>>},
        {"seed", "--seed", kPicture, "N", whole, "a whole number", "Seed of the random numbers", "0", {},
         to_whole<&R::settings, &S::seed>},
        {"max_bounces", "--max-bounces", kPicture, "N", whole_or_auto, "a whole number or auto",
         "Largest number of bounces of light; 0: direct light only", "auto: what the shot calls for", {},
         to_max_bounces},
        {"transport", "--transport", kPicture, "NAME", text, kTransportNames,
         "paths: all light paths; whitted: direct light, and reflections and refractions of mirrors and smooth glass",
         "paths", {},
         to_named<transport_named, &R::settings, &S::transport>},
        {"clamp_cd_m2", "--clamp", kPicture, "CD_M2", number, kNumber,
         "Largest radiance of indirect light in cd/m^2: fewer fireflies, but a picture that is too dark", "0: no limit", {},
         to_number<&R::settings, &S::clamp>},
        {"tone", "--tone", kPicture, "CURVE", text, kToneNames,
         "Tone mapping of developed pictures: film (soft highlights) or linear (clipped)", "film", {},
         to_named<tone_named, &R::tone>},
        {"layers", "--layers", kPicture, "NAMES", names, "names of layers",
         "Layers also written to .exr, separated by commas: all, or some of " + layer_names(), "none", {}, to_layers},
        {"effects", "--effects", kPicture, "NAMES", names, "names of effects",
         "Effects that are also simulated or, with a minus, left out, separated by commas after a "
         "\"=\": " + effect_names(),
         "auto: what the shot calls for", {}, to_effects},
        {"quality", "--quality", kPicture, "NAME", text, kQualityNames,
         "Size below which effects are left out by auto: draft (2 pixels, 4 codes), photo (0.5, 1) or reference (0.1, "
         "0.25)", "photo", {"threshold_px", "threshold_codes"}, to_named<quality_named, &R::settings, &S::thresholds>},
        {"threshold_px", "--threshold-px", kPicture, "PIXELS", number, kNumber,
         "Threshold in pixels, instead of that of the quality", "", {},
         to_number<&R::settings, &S::thresholds, &PlanThresholds::pixels>},
        {"threshold_codes", "--threshold-codes", kPicture, "CODES", number, kNumber,
         "Threshold in 8-bit codes, instead of that of the quality", "", {},
         to_number<&R::settings, &S::thresholds, &PlanThresholds::codes>},
        {"illuminant", "--illuminant", kPicture, "SPECTRUM", text, "a spectrum",
         "Spectrum of all light, for " + effects_that(&EffectInfo::has_wavelengths) + ": " +
             std::string(Illuminant::kWanted), "D65", {}, to_illuminant},
        {"lens_filter", "--lens-filter", kPicture, "FILTER", text, "a filter",
         "Filter in front of the lens: " + std::string(LensFilter::kWanted), "none", {}, to_filter},
        {"threads", "--threads", kPicture, "N", whole, "a whole number", "Number of threads; 0: all", "0", {},
         to_whole<&R::settings, &S::threads>},
    };
}
// clang-format on

}  // namespace

std::span<const ShotKey> shot_keys() {
    static const std::vector<ShotKey> keys = all_keys();
    return keys;
}

}  // namespace realcam::shot
