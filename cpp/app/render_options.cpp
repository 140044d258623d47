#include "render_options.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include "../plan/quality.hpp"
#include "../render/effect_names.hpp"
#include "../shot/names.hpp"
#include "../shot/shot_file.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

bool is_shot_file(const std::string& path) {
    return std::filesystem::path(path).extension() == ".toml";
}

/// A number is a radiance, anything else the name of a file.
void read_environment_word(const std::string& word, shot::ShotRequest& request) {
    request.environment_cd_m2.reset();
    request.environment_file.clear();
    if (const auto value = number_in(word)) {
        const auto radiance = static_cast<float>(*value);
        request.environment_cd_m2 = {radiance, radiance, radiance};
        try {
            shot::check_environment(*request.environment_cd_m2);
        } catch (const InputError& error) {
            throw InputError("--environment: " + std::string(error.what()));
        }
        return;
    }
    if (!std::filesystem::exists(word))
        throw InputError("--environment: \"" + word + "\": there is no such file, and it is no number of cd/m^2");
    request.environment_file = word;
}

void read_environment_words(const RenderWords& w, shot::ShotRequest& request) {
    if (!w.environment.empty()) read_environment_word(w.environment, request);
    EnvironmentChange& change = request.environment_change;
    if (!w.environment_scale.empty()) change.scale = parse_number("--environment-scale", w.environment_scale);
    if (!w.environment_rotation.empty())
        change.rotation_deg = parse_number("--environment-rotation", w.environment_rotation);
    check_environment_change(request);
}

void read_camera_words(const RenderWords& w, shot::ShotRequest& request) {
    if (!w.lens.empty()) {
        request.lens = w.lens;
        request.zoom.clear();  // a position of the shot file's lens
    }
    if (!w.lens_file.zoom.empty()) request.zoom = w.lens_file.zoom;
    request.lens_options = lens_options_of(w.lens_file);
    if (!w.f_number.empty()) request.f_number = parse_number("--f-number", w.f_number);
    if (!w.blades.empty()) request.blades = parse_whole("--blades", w.blades, kMaxIrisBlades);
    if (!w.blade_rounding.empty()) request.blade_rounding = parse_number("--blade-rounding", w.blade_rounding);
    if (!w.blade_rotation.empty()) request.blade_rotation_deg = parse_number("--blade-rotation", w.blade_rotation);
    check_blades(request);
    if (!w.film.empty()) request.film_mm = parse_size("--film", w.film);
    if (!w.film_shift.empty()) request.film_shift_mm = parse_shift("--film-shift", w.film_shift);
    if (!w.resolution.empty()) request.resolution = parse_resolution("--resolution", w.resolution);
    if (!w.camera.empty()) {  // in place of what a shot file says of the view
        request.view.camera = w.camera;
        request.view.position_m = request.view.look_at_m = std::nullopt;
        request.motion.clear();
    }
    if (w.camera.empty() && !(w.position.empty() && w.look_at.empty())) request.view.camera.clear();
    if (!w.position.empty()) request.view.position_m = parse_point("--position", w.position);
    if (!w.look_at.empty()) request.view.look_at_m = parse_point("--look-at", w.look_at);
    if (!w.up.empty()) request.view.up = parse_point("--up", w.up);
    if (!w.focus.empty()) request.view.focus_distance_m = parse_focus("--focus", w.focus);
    if (!w.model.empty()) request.model = parse_model(w.model);
    if (!w.exposure_time.empty()) request.exposure_time_s = parse_exposure_time("--exposure-time", w.exposure_time);
    if (!w.shutter_opens.empty()) request.shutter.opens_s = parse_number("--shutter-opens", w.shutter_opens);
    if (!w.readout_time.empty()) request.shutter.readout_time_s = parse_number("--readout-time", w.readout_time);
    if (!w.iso.empty()) request.iso = parse_number("--iso", w.iso);
}

bool is_exr(const std::string& path) {
    const std::string suffix = std::filesystem::path(path).extension().string();
    return suffix.size() == 4 && suffix[0] == '.' && (suffix[1] | 0x20) == 'e' && (suffix[2] | 0x20) == 'x' &&
           (suffix[3] | 0x20) == 'r';
}

/// Between commas.
std::vector<std::string> words_in(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream words(text);
    for (std::string name; std::getline(words >> std::ws, name, ',');) names.push_back(name);
    return names;
}

void read_layer_words(const RenderWords& w, RenderSettings& settings) {
    const bool has_place = std::any_of(w.outputs.begin(), w.outputs.end(), is_exr);
    if (!w.layers.empty()) {
        if (!has_place) throw InputError("--layers: layers are written to .exr, and no --output is one");
        try {
            settings.layers = layers_named(words_in(w.layers));
        } catch (const InputError& error) {
            throw InputError("--layers: " + std::string(error.what()));
        }
    }
    // Those of a shot file cost nothing where nobody would see them.
    if (!has_place) settings.layers = {};
}

void read_sample_words(const RenderWords& w, shot::ShotRequest& request) {
    if (w.spp == "auto") {
        request.has_noise_goal = true;
    } else if (!w.spp.empty()) {  // in place of what a shot file says of noise
        request.has_noise_goal = false;
        request.noise = {};
        request.settings.spp = static_cast<int>(parse_whole("--spp", w.spp, std::numeric_limits<int>::max()));
    }
    const auto read = [](const char* option, const std::string& word, std::optional<double>& value) {
        if (!word.empty()) value = parse_number(option, word);
    };
    if (!w.noise.empty() || !w.noise_codes.empty()) request.noise.noise = request.noise.noise_codes = std::nullopt;
    read("--noise", w.noise, request.noise.noise);
    read("--noise-codes", w.noise_codes, request.noise.noise_codes);
    read("--seconds", w.seconds, request.noise.seconds);
    if (!w.max_spp.empty())
        request.noise.max_spp = static_cast<std::int64_t>(parse_whole("--max-spp", w.max_spp, 1u << 31));
    const bool says_of_noise = !w.noise.empty() || !w.noise_codes.empty() || !w.seconds.empty() || !w.max_spp.empty();
    if (says_of_noise && !request.has_noise_goal)
        throw InputError(
            "--noise, --noise-codes, --seconds and --max-spp say how far --spp auto goes; it is not asked for");
    settle_noise_goal(request);
}

void read_settings_words(const RenderWords& w, RenderSettings& settings) {
    const auto read = [](const char* option, const std::string& word, auto& value) {
        using Value = std::remove_reference_t<decltype(value)>;
        if (!word.empty()) value = static_cast<Value>(parse_whole(option, word, std::numeric_limits<Value>::max()));
    };
    read("--seed", w.seed, settings.seed);
    read("--max-bounces", w.max_bounces, settings.max_bounces);
    read("--threads", w.threads, settings.threads);
    if (!w.transport.empty()) {
        const auto transport = shot::transport_named(w.transport);
        if (!transport) throw InputError(std::string("--transport: ") + shot::kTransportNames + " is wanted");
        settings.transport = *transport;
    }
    try {
        if (!w.effects.empty()) settings.effects = effects_named(words_in(w.effects));
    } catch (const InputError& error) {
        throw InputError("--effects: " + std::string(error.what()));
    }
    if (!w.illuminant.empty()) settings.illuminant = Illuminant::parse(w.illuminant);
    if (!w.clamp.empty()) settings.clamp = static_cast<float>(parse_number("--clamp", w.clamp));
    validate(settings);
}

}  // namespace

void add_shot_options(CLI::App& command, RenderWords& w) {
    const auto option = [&](const char* name, std::string& value, const std::string& help, const char* type) {
        // An empty word would read as an option that was left out.
        const auto not_empty = CLI::Validator([](std::string& word) { return word.empty() ? "is empty" : ""; }, "", "");
        return command.add_option(name, value, help)->type_name(type)->check(not_empty);
    };
    option("scene", w.scene,
           "The scene: .obj (with .mtl), .gltf, .glb or .ply; or a shot file: .toml, whose values hold for all options "
           "that are not given",
           "SCENE")
        ->required();
    command.option_defaults()->group("Camera");
    option("--lens", w.lens,
           "Bundled lens (`realcam lens list`), or a lens file: .toml, .zmx, .seq, .len, .dat, .json, .roa "
           "[double-gauss-50mm]",
           "NAME");
    add_lens_options(command, w.lens_file);
    option("--film", w.film, "Film in mm [the lens's, in the shape of the resolution]", "WxH");
    option("--film-shift", w.film_shift,
           "The film's middle from the lens's axis, mm to the right and up as the picture shows it [0,0]", "X,Y");
    option("--resolution", w.resolution, "Pixels [960 along the longer side]", "WxH");
    option("--camera", w.camera,
           "Camera of a glTF whose place, direction and motion to take, by the name of its node; or none [the first]",
           "NAME");
    option("--position", w.position,
           "Middle of the film, metres [in front of look-at, along +z, such that the scene fills the film]", "X,Y,Z");
    option("--look-at", w.look_at, "Point in the middle of the picture [middle of the scene]", "X,Y,Z");
    option("--up", w.up, "Direction that is up in the picture [0,1,0]", "X,Y,Z");
    option("--focus", w.focus, "Object plane to film, inf, or auto [auto: the first surface on the axis]", "METRES");
    option("--f-number", w.f_number, "Close the diaphragm to f/N [wide open]", "N");
    option("--blades", w.blades, "Of the diaphragm: 3 to 24, or 0 for a round one [the lens's]", "N");
    option("--blade-rounding", w.blade_rounding, "0: straight edges; 1: the opening is a circle [the lens's]", "SHARE");
    option("--blade-rotation", w.blade_rotation, "Degrees by which the blades are turned about the axis [the lens's]",
           "DEGREES");
    option("--exposure-time", w.exposure_time,
           "Seconds, such as 1/125, or auto [auto: the average lands on middle grey]", "TIME");
    option("--shutter-opens", w.shutter_opens, "When, in seconds of a scene that moves [0]", "SECONDS");
    option("--readout-time", w.readout_time,
           "Of a rolling shutter: seconds from the top row of pixels to the bottom [0]", "SECONDS");
    option("--iso", w.iso, "Sensitivity [100]", "ISO");
    option("--model", w.model, "full, full_double, polynomial, thick, mapped, thin or pinhole [full]", "MODEL");
    command.option_defaults()->group("Scene");
    option("--scale", w.scale, "Metres per unit of the scene's file [1]", "METRES");
    option(
        "--environment", w.environment,
        "Light from all around: cd/m^2, or a latitude-longitude picture [the scene's light; daylight if it has none]",
        "CD_M2|FILE");
    option("--environment-scale", w.environment_scale, "By which the environment's light is multiplied [1]", "FACTOR");
    option("--environment-rotation", w.environment_rotation,
           "Degrees by which the environment is turned about the vertical, counterclockwise from above [0]", "DEGREES");
    command.option_defaults()->group("Picture");
    option("--spp", w.spp, "Samples per pixel, or auto: as many as the noise needs, by tile of the film [64]", "N");
    option("--noise", w.noise, "Of --spp auto: noise as a share of a tile's light, such as 0.01", "SHARE");
    option("--noise-codes", w.noise_codes, "The same in 8-bit codes of the developed picture [1]", "CODES");
    option("--seconds", w.seconds, "After which --spp auto takes no more samples [any time]", "SECONDS");
    option("--max-spp", w.max_spp, "Samples of a pixel that --spp auto takes at most [4096]", "N");
    option("--seed", w.seed, "Of the random numbers [0]", "N");
    option("--max-bounces", w.max_bounces, "Light that bounces this often is seen; 0: direct light only [1]", "N");
    option("--transport", w.transport,
           "paths: all ways of light; whitted: direct light, and what mirrors and smooth glass show [paths]", "NAME");
    option("--clamp", w.clamp,
           "Cut off light above this that comes by a bounce: fewer bright dots, and a picture too dark [0: never]",
           "CD_M2");
    option("--tone", w.tone, "Tone mapping of .png: film (soft highlights) or linear (clipped) [film]", "CURVE");
    option("--layers", w.layers,
           "Also write to .exr, separated by commas: all, or some of " + layer_names() + " [none]", "NAMES");
    option("--effects", w.effects,
           "What else is simulated or, with a minus, left out, separated by commas after a \"=\": " + effect_names() +
               " [auto: what the shot calls for]",
           "NAMES");
    option("--quality", w.quality,
           "What auto leaves out is smaller than that of draft (2 pixels, 4 codes), photo (0.5, 1) or reference (0.1, "
           "0.25) [photo]",
           "NAME");
    option("--threshold-px", w.threshold_px, "In pixels, in place of that of the quality", "PIXELS");
    option("--threshold-codes", w.threshold_codes, "In 8-bit codes, in place of that of the quality", "CODES");
    option("--illuminant", w.illuminant,
           "Of " + effects_that(&EffectInfo::has_wavelengths) +
               ", the spectrum of all light: " + std::string(Illuminant::kWanted) + " [D65]",
           "SPECTRUM");
    option("--threads", w.threads, "0: all [0]", "N");
    option("--device", w.device, "auto (a GPU if there is one), cpu, cuda, or cuda:1 [auto]", "DEVICE");
}

void add_render_options(CLI::App& command, RenderWords& w) {
    const std::string group = command.option_defaults()->get_group();
    add_shot_options(command, w);
    command.add_flag("-v,--verbose", w.verbose, "Also print rays per second, and where the time went");
    command.add_flag("--explain", w.explains, "Also print what --effects auto has decided, and why");
    command.add_flag("--json", w.as_json, "Print the picture's figures and settings as JSON, in place of the text");
    command.option_defaults()->group(group);
    command.add_option("-o,--output", w.outputs, "Picture to write, .png or .exr; may be repeated")
        ->type_name("FILE")
        ->required()
        ->allow_extra_args(false);
}

PlanThresholds thresholds_of(const RenderWords& w) {
    const auto thresholds = quality_named(w.quality.empty() ? "photo" : w.quality);
    if (!thresholds) throw InputError("--quality: \"" + w.quality + "\": " + kQualityNames + " is wanted");
    PlanThresholds result = *thresholds;
    if (!w.threshold_px.empty()) result.pixels = parse_number("--threshold-px", w.threshold_px);
    if (!w.threshold_codes.empty()) result.codes = parse_number("--threshold-codes", w.threshold_codes);
    if (!(result.pixels > 0) || !(result.codes > 0))
        throw InputError("--threshold-px and --threshold-codes must be above 0");
    return result;
}

shot::ShotRequest understand(const RenderWords& w) {
    shot::ShotRequest request;
    if (is_shot_file(w.scene)) {
        request = shot::read_shot_file(w.scene);
    } else {
        request.scene = w.scene;
    }
    if (!w.scale.empty()) request.scale = parse_number("--scale", w.scale);
    read_environment_words(w, request);
    read_camera_words(w, request);
    if (!w.tone.empty()) request.tone = parse_tone(w.tone);
    read_sample_words(w, request);
    read_settings_words(w, request.settings);
    read_layer_words(w, request.settings);
    thresholds_of(w);  // nobody should wait for a scene and be told then
    return request;
}

}  // namespace realcam::app
