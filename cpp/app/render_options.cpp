#include "render_options.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include "../io/files/file_suffix.hpp"
#include "../render/effect_names.hpp"
#include "../shot/names.hpp"
#include "../shot/shot_file.hpp"
#include "values.hpp"

namespace realcam::app {
bool is_exr(const std::string& path) {
    return io::suffix_of(path) == ".exr";
}

namespace {

/// Between commas.
std::vector<std::string> words_in(const std::string& text) {
    std::vector<std::string> names;
    std::istringstream words(text);
    for (std::string name; std::getline(words >> std::ws, name, ',');) names.push_back(name);
    return names;
}

bool writes_layers(const RenderWords& w) {
    return std::any_of(w.outputs.begin(), w.outputs.end(), is_exr);
}

template <class T>
T whole(const std::string& option, const std::string& word) {
    return static_cast<T>(parse_whole(option, word, std::numeric_limits<T>::max()));
}

/// With the option's name before what is wrong.
template <class Read>
auto named(const std::string& option, const Read& read) {
    try {
        return read();
    } catch (const InputError& error) {
        throw InputError(option + ": " + error.what());
    }
}

/// A number is a radiance, anything else the name of a file.
void read_environment(shot::ShotRequest& request, const std::string& option, const std::string& word) {
    request.environment_cd_m2.reset();
    request.environment_file.clear();
    request.environment_layer.clear();
    if (const auto value = number_in(word)) {
        const auto radiance = static_cast<float>(*value);
        request.environment_cd_m2 = {radiance, radiance, radiance};
        named(option, [&] { shot::check_environment(*request.environment_cd_m2); });
        return;
    }
    if (!std::filesystem::exists(word))
        throw InputError(option + ": \"" + word + "\": there is no such file, and it is no number of cd/m^2");
    request.environment_file = word;
}

/// In place of what a shot file says of the samples.
void read_spp(shot::ShotRequest& request, const std::string& option, const std::string& word) {
    request.sampling = word == "auto" ? shot::Sampling::by_noise : shot::Sampling::counted;
    if (request.sampling == shot::Sampling::by_noise) return;
    request.noise = {};
    request.settings.spp = whole<int>(option, word);
}

template <class T>
T one_of(const std::optional<T>& found, const std::string& option, const char* wanted) {
    if (!found) throw InputError(option + ": " + wanted + " is wanted");
    return *found;
}

int parse_blades(const std::string& option, const std::string& word) {
    return static_cast<int>(parse_whole(option, word, kMaxIrisBlades));
}

using Request = shot::ShotRequest;
using Text = const std::string&;

/// Declares options. What they change is changed in the order in which they are declared.
struct OptionAdder {
    CLI::App& command;
    RenderWords& words;

    /// An empty word would read as an option that was left out.
    static CLI::Validator not_empty() {
        return CLI::Validator([](std::string& word) { return word.empty() ? "is empty" : ""; }, "", "");
    }

    /// `read(request, name, word)`: what the option changes.
    template <class Read>
    void operator()(const char* name, const std::string& help, const char* type, Read read) const {
        const auto keep = [&words = words, name, read](const std::string& word) {
            words.changes.emplace_back([=](Request& request) { read(request, name, word); });
        };
        command.add_option_function<std::string>(name, keep, help)->type_name(type)->check(not_empty());
    }

    /// Whether an option stands in the command line, once that is read.
    auto is_given(const char* name) const {
        return [&command = command, name] { return command.count(name) > 0; };
    }
};

/// Reads a member of the request. What the keys of a shot file say of it is forgotten.
template <class Member, class Parse, class... Keys>
auto into(Member Request::* member, Parse parse, Keys... keys) {
    return [=](Request& request, Text name, Text word) {
        request.*member = parse(name, word);
        (request.forget(keys), ...);
    };
}

void add_lens_and_film(const OptionAdder& option) {
    option.command.option_defaults()->group("Camera");
    option("--lens",
           "Bundled lens (`realcam lens list`), or a lens file: .toml, .zmx, .seq, .len, .dat, .json, .roa "
           "[double-gauss-50mm]",
           "LENS", [](Request& r, Text, Text w) {
               r.lens = w;
               r.zoom.clear();  // a position of the shot file's lens
               r.focal_length_mm.reset();
               r.forget(&CameraKey::lens);
               r.forget(&CameraKey::focal_length_mm);
           });
    add_lens_options(option.command, option.words.lens_file);
    option("--focal-length", "Of a zoom lens, between those of its positions [that of its position]", "MM",
           [](Request& r, Text o, Text w) {
               r.focal_length_mm = parse_number(o, w);
               r.zoom.clear();
               r.forget(&CameraKey::focal_length_mm);
           });
    option.command.get_option("--focal-length")->excludes(option.command.get_option("--zoom"));
    option("--film", "Film in mm [the lens's, in the shape of the resolution]", "WxH",
           into(&Request::film_mm, parse_size));
    option("--film-shift",
           "The film's middle from the lens's axis, mm to the right and up as the picture shows it [0,0]", "X,Y",
           into(&Request::film_shift_mm, parse_shift, &CameraKey::film_right_mm, &CameraKey::film_up_mm));
    option("--resolution", "Pixels [960 along the longer side]", "WxH", into(&Request::resolution, parse_resolution));
}

void add_view(const OptionAdder& option) {
    option("--camera",
           "Camera of a glTF whose place, direction and motion to take, by the name of its node; or none [the first]",
           "NAME", [](Request& r, Text, Text w) {
               r.view.camera = w;  // in place of what a shot file says of the view
               r.view.position_m = r.view.look_at_m = std::nullopt;
               r.motion.clear();
           });
    option("--position", "Middle of the film, metres [in front of the scene, which fills the film: docs/scenes.md]",
           "X,Y,Z", [is_given = option.is_given("--camera")](Request& r, Text o, Text w) {
               if (!is_given()) r.view.camera.clear();
               r.view.position_m = parse_point(o, w);
           });
    option("--look-at", "Point in the middle of the picture [middle of the scene]", "X,Y,Z",
           [is_given = option.is_given("--camera")](Request& r, Text o, Text w) {
               if (!is_given()) r.view.camera.clear();
               r.view.look_at_m = parse_point(o, w);
           });
    option("--up", "Direction that is up in the picture [0,1,0]", "X,Y,Z",
           [](Request& r, Text o, Text w) { r.view.up = parse_point(o, w); });
    option("--focus", "Object plane to film, inf, or auto [auto: the first surface on the axis]", "METRES",
           [](Request& r, Text o, Text w) {
               r.view.focus_distance_m = parse_focus(o, w);
               r.forget(&CameraKey::focus_m);
           });
}

void add_exposure(const OptionAdder& option) {
    option("--f-number", "Close the diaphragm to f/N [wide open]", "N",
           into(&Request::f_number, parse_number, &CameraKey::f_number));
    option("--blades", "Of the diaphragm: 3 to 24, or 0 for a round one [the lens's]", "N",
           into(&Request::blades, parse_blades, &CameraKey::blades));
    option("--blade-rounding", "0: straight edges; 1: the opening is a circle [the lens's]", "SHARE",
           into(&Request::blade_rounding, parse_number, &CameraKey::blade_rounding));
    option("--blade-rotation", "Degrees by which the blades are turned about the axis [the lens's]", "DEGREES",
           into(&Request::blade_rotation_deg, parse_number, &CameraKey::blade_rotation_deg));
    option("--exposure-time", "Seconds, such as 1/125, or auto [auto: the average lands on middle grey]", "TIME",
           into(&Request::exposure_time_s, parse_exposure_time, &CameraKey::exposure_time_s));
    option("--shutter-opens", "When, in seconds of a scene that moves [0]", "SECONDS",
           [](Request& r, Text o, Text w) { r.shutter.opens_s = parse_number(o, w); });
    option("--readout-time", "Of a rolling shutter: seconds from the top row of pixels to the bottom [0]", "SECONDS",
           [](Request& r, Text o, Text w) { r.shutter.readout_time_s = parse_number(o, w); });
    option("--iso", "Sensitivity [100]", "ISO", [](Request& r, Text o, Text w) {
        r.iso = parse_number(o, w);
        r.iso_follows_s.reset();
        r.forget(&CameraKey::iso);
    });
    option("--model", "full, full_double, polynomial, thick, mapped, thin or pinhole [full]", "MODEL",
           [](Request& r, Text, Text w) { r.model = parse_model(w); });
}

void add_scene(const OptionAdder& option) {
    option.command.option_defaults()->group("Scene");
    option("--scale", "Metres per unit of the scene's file [1]", "METRES", into(&Request::scale, parse_number));
    option("--environment",
           "Light from all around: cd/m^2, or a latitude-longitude picture [the scene's light; daylight if it has "
           "none]",
           "CD_M2|FILE", read_environment);
    option("--environment-layer", "Layer of an OpenEXR environment, such as beauty, where it has several", "NAME",
           [](Request& r, Text, Text w) { r.environment_layer = w; });
    option("--environment-scale", "By which the environment's light is multiplied [1]", "FACTOR",
           [](Request& r, Text o, Text w) { r.environment_change.scale = parse_number(o, w); });
    option("--environment-rotation",
           "Degrees by which the environment is turned about the vertical, counterclockwise from above [0]", "DEGREES",
           [](Request& r, Text o, Text w) { r.environment_change.rotation_deg = parse_number(o, w); });
}

void add_samples(const OptionAdder& option) {
    option.command.option_defaults()->group("Picture");
    option(
        "--spp",
        "Samples per pixel, or auto: as many as the noise needs, by tile of the film, until it is 1 code [until it is "
        "2 codes, for 60 seconds at most]",
        "N", read_spp);
    option("--noise", "Unless --spp is a number: noise as a share of a tile's light, such as 0.01", "SHARE",
           [](Request& r, Text o, Text w) {
               r.noise.noise = parse_number(o, w);
               r.noise.noise_codes.reset();
           });
    option("--noise-codes", "The same in 8-bit codes of the developed picture", "CODES",
           [is_given = option.is_given("--noise")](Request& r, Text o, Text w) {
               if (!is_given()) r.noise.noise.reset();
               r.noise.noise_codes = parse_number(o, w);
           });
    option("--seconds", "After which no more samples are taken, unless --spp is a number", "SECONDS",
           [](Request& r, Text o, Text w) { r.noise.seconds = parse_number(o, w); });
    option(
        "--max-spp", "Samples that a pixel gets at most, unless --spp is a number [4096]", "N",
        [](Request& r, Text o, Text w) { r.noise.max_spp = static_cast<std::int64_t>(parse_whole(o, w, 1u << 31)); });
    option("--seed", "Of the random numbers [0]", "N",
           [](Request& r, Text o, Text w) { r.settings.seed = whole<std::uint32_t>(o, w); });
    option("--max-bounces",
           "Light that bounces this often is seen; 0: direct light only [auto: what the shot calls for]", "N",
           [](Request& r, Text o, Text w) {
               r.settings.max_bounces =
                   w == "auto" ? std::nullopt : std::optional(static_cast<int>(parse_whole(o, w, kMostBounces)));
           });
    option("--transport",
           "paths: all ways of light; whitted: direct light, and what mirrors and smooth glass show [paths]", "NAME",
           [](Request& r, Text o, Text w) {
               r.settings.transport = one_of(shot::transport_named(w), o, shot::kTransportNames);
           });
    option("--clamp",
           "Cut off light above this that comes by a bounce: fewer bright dots, and a picture too dark [0: never]",
           "CD_M2", [](Request& r, Text o, Text w) { r.settings.clamp = parse_number(o, w); });
}

void add_picture(const OptionAdder& option) {
    option("--tone", "Tone mapping of developed pictures: film (soft highlights) or linear (clipped) [film]", "CURVE",
           [](Request& r, Text, Text w) { r.tone = parse_tone(w); });
    option("--layers", "Also write to .exr, separated by commas: all, or some of " + layer_names() + " [none]", "NAMES",
           [&words = option.words](Request& r, Text o, Text w) {
               if (!writes_layers(words))
                   throw InputError("--layers: layers are written to .exr, and no --output is one");
               r.settings.layers = named(o, [&] { return layers_named(words_in(w)); });
           });
    option("--effects",
           "What else is simulated or, with a minus, left out, separated by commas after a \"=\": " + effect_names() +
               " [auto: what the shot calls for]",
           "NAMES", [](Request& r, Text o, Text w) {
               r.settings.effects = named(o, [&] { return effects_named(words_in(w)); });
           });
    option("--quality",
           "What auto leaves out is smaller than that of draft (2 pixels, 4 codes), photo (0.5, 1) or reference (0.1, "
           "0.25) [photo]",
           "NAME", [](Request& r, Text o, Text w) {
               r.settings.thresholds = one_of(quality_named(w), o + ": \"" + w + '"', kQualityNames);
           });
    option("--threshold-px", "In pixels, in place of that of the quality", "PIXELS",
           [](Request& r, Text o, Text w) { r.settings.thresholds.pixels = parse_number(o, w); });
    option("--threshold-codes", "In 8-bit codes, in place of that of the quality", "CODES",
           [](Request& r, Text o, Text w) { r.settings.thresholds.codes = parse_number(o, w); });
    option("--illuminant",
           "Of " + effects_that(&EffectInfo::has_wavelengths) +
               ", the spectrum of all light: " + std::string(Illuminant::kWanted) + " [D65]",
           "SPECTRUM", [](Request& r, Text, Text w) { r.settings.illuminant = Illuminant::parse(w); });
}

}  // namespace

void add_shot_options(CLI::App& command, RenderWords& words) {
    const OptionAdder option{command, words};
    command
        .add_option("SCENE", words.scene,
                    "The scene: .obj (with .mtl), .gltf, .glb or .ply; or a shot file: .toml, whose values hold for "
                    "all options that are not given")
        ->type_name("SCENE")
        ->check(OptionAdder::not_empty())
        ->required();
    for (const auto add : {add_lens_and_film, add_view, add_exposure, add_scene, add_samples, add_picture}) add(option);
    option("--threads", "0: all [0]", "N", [](Request& r, Text o, Text w) { r.settings.threads = whole<int>(o, w); });
    command.add_option("--device", words.device, "auto (a GPU if there is one), cpu, cuda, or cuda:1 [auto]")
        ->type_name("DEVICE")
        ->check(OptionAdder::not_empty());
}

void add_render_options(CLI::App& command, RenderWords& w) {
    const std::string group = command.option_defaults()->get_group();
    add_shot_options(command, w);
    const auto denoise = [&w] { w.changes.emplace_back([](shot::ShotRequest& r) { r.denoises = true; }); };
    command.add_flag_callback(
        "--denoise", denoise,
        "Take the noise that is left from the picture, by Open Image Denoise (realcam[denoise]) [without --spp: from "
        ".png where the noise goal is not reached]");
    command.add_flag_callback(
        "--no-denoise",
        [&w] { w.changes.emplace_back([](shot::ShotRequest& r) { r.denoises = !(r.keeps_noise = true); }); },
        "Leave the noise");
    command.add_flag("-v,--verbose", w.verbose, "Also print rays per second, and where the time went");
    command.add_flag("--explain", w.explains, "Also print what --effects auto has decided, and why");
    command.add_flag("--json", w.as_json, "Print the picture's figures and settings as JSON, in place of the text");
    command.add_flag("-q,--quiet", w.is_quiet, "Print warnings and errors alone");
    command.option_defaults()->group("Film");
    CLI::Option* const frames =
        command
            .add_option(
                "--frames", w.frames,
                "Frames of a film: 1-240, or 1-240x10 for every tenth. Their files are numbered, in place of #### in "
                "the name or before its suffix; what is there already stays")
            ->type_name("A-B");
    command.add_option("--fps", w.frames_per_second, "Frames in a second of the scene [24]")
        ->type_name("N")
        ->needs(frames);
    command.add_flag("--again", w.takes_again, "Also take frames that are there already")->needs(frames);
    command.option_defaults()->group(group);
    command
        .add_option("-o,--output", w.outputs,
                    "Picture to write: .png, .jpg, .tif or .webp, or the film as .exr; may be repeated. With --frames "
                    "also .mp4 (realcam[video])")
        ->type_name("FILE")
        ->required()
        ->allow_extra_args(false);
}

shot::ShotRequest understand(const RenderWords& w) {
    shot::ShotRequest request;
    if (shot::is_shot_file(w.scene)) {
        request = shot::read_shot(w.scene);
    } else {
        request.scene = w.scene;
    }
    for (const auto& change : w.changes) change(request);
    if (!w.lens_file.zoom.empty()) {
        request.zoom = w.lens_file.zoom;
        request.focal_length_mm.reset();
        request.forget(&CameraKey::focal_length_mm);
    }
    request.lens_options = lens_options_of(w.lens_file);
    check_environment_change(request);
    check_blades(request);
    if (request.sampling == shot::Sampling::counted && !request.noise.says_nothing())
        throw InputError(
            "--noise, --noise-codes, --seconds and --max-spp say how far --spp auto goes; the number of samples is "
            "given");
    settle_noise_goal(request);
    validate(request.settings);
    // Those of a shot file cost nothing where nobody would see them.
    if (!writes_layers(w)) request.settings.layers = {};
    return request;
}

}  // namespace realcam::app
