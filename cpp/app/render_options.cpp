#include "render_options.hpp"

#include <algorithm>
#include <filesystem>

#include "../camera/default_film.hpp"
#include "../image_io/image_file.hpp"
#include "../io/free_memory.hpp"
#include "../io/lens_file.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

/// Of the CPU backend while it turns its sums into a picture: 40 for the sums, 16 for the picture.
constexpr double kBytesPerPixel = 56;

void check_memory(const Film& film) {
    const double wanted = kBytesPerPixel * film.width * film.height;
    const auto free = static_cast<double>(io::free_memory());
    if (wanted > free)
        throw Error("out of memory: a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                    " pixels needs " + short_number(wanted / 1e9, 3) + " GB, and " + short_number(free / 1e9, 3) +
                    " GB are free; a smaller --resolution is wanted");
}

void check_outputs(const std::vector<std::string>& outputs) {
    for (auto it = outputs.begin(); it != outputs.end(); ++it) {
        image_io::check_image_path(*it);
        if (std::find(outputs.begin(), it, *it) != it) throw InputError("--output: \"" + *it + "\" is given twice");
    }
}

/// A number is a radiance, anything else the name of a file.
void read_environment_word(const std::string& word, RenderRequest& request) {
    if (word.empty()) return;
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (*end != '\0') {
        if (!std::filesystem::exists(word))
            throw InputError("--environment: \"" + word + "\" is neither a number (cd/m^2) nor a file");
        request.environment_file = word;
        return;
    }
    if (!(value >= 0) || !(value < 1e30))
        throw InputError("--environment: \"" + word + "\" is not a luminance in cd/m^2");
    request.environment_cd_m2 = value;
}

}  // namespace

void add_render_options(CLI::App& command, RenderWords& w) {
    const auto option = [&](const char* name, auto& value, const char* help, const char* type) {
        return command.add_option(name, value, help)->type_name(type);
    };
    option("scene", w.scene, "The scene: .obj (with .mtl), .gltf, .glb or .ply", "SCENE")->required();
    option("-o,--output", w.outputs, "Picture to write, .png or .exr; may be repeated", "FILE")
        ->required()
        ->allow_extra_args(false);
    command.option_defaults()->group("Camera");
    option("--lens", w.lens, "Bundled lens (`realcam lens list`) or .toml file", "NAME")->capture_default_str();
    option("--film", w.film, "Film in mm [the lens's, in the shape of the resolution]", "WxH");
    option("--resolution", w.resolution, "Pixels [960 along the longer side]", "WxH");
    option("--position", w.position,
           "Middle of the film, metres [in front of look-at, along +z, such that the scene fills the film]", "X,Y,Z");
    option("--look-at", w.look_at, "Point in the middle of the picture [middle of the scene]", "X,Y,Z");
    option("--up", w.up, "Direction that is up in the picture", "X,Y,Z")->capture_default_str();
    option("--focus", w.focus, "Object plane to film, or inf [the first surface on the axis]", "METRES");
    option("--f-number", w.f_number, "Close the diaphragm to f/N [wide open]", "N");
    option("--exposure-time", w.exposure_time, "Seconds, such as 1/125 [metered: the average lands on middle grey]",
           "TIME");
    option("--iso", w.iso, "Sensitivity", "ISO")->capture_default_str();
    option("--model", w.model, "full, thick, thin or pinhole", "MODEL")->capture_default_str();
    command.option_defaults()->group("Scene");
    option("--scale", w.scale, "Metres per unit of the scene's file", "METRES")->capture_default_str();
    option(
        "--environment", w.environment,
        "Light from all around: cd/m^2, or a latitude-longitude picture [the scene's light; daylight if it has none]",
        "CD_M2|FILE");
    command.option_defaults()->group("Picture");
    option("--spp", w.spp, "Samples per pixel", "N")->capture_default_str();
    option("--seed", w.seed, "Of the random numbers", "N")->capture_default_str();
    option("--max-bounces", w.max_bounces, "Light that bounces this often is seen; 0: direct light only", "N")
        ->capture_default_str();
    option("--tone", w.tone, "Of .png: film (soft highlights) or linear (clipped)", "CURVE")->capture_default_str();
    option("--threads", w.threads, "0: all", "N")->capture_default_str();
    option("--device", w.device, "auto (a GPU if there is one), cpu, cuda, or cuda:1", "DEVICE")->capture_default_str();
}

RenderRequest understand(const RenderWords& w) {
    RenderRequest request;
    check_outputs(w.outputs);
    request.outputs = w.outputs;
    request.scene = w.scene;
    request.device = w.device;
    request.tone = parse_tone(w.tone);
    request.scale = parse_number("--scale", w.scale);
    request.settings = {w.spp, w.seed, w.max_bounces, w.threads};
    validate(request.settings);
    read_environment_word(w.environment, request);

    Camera& camera = request.camera;
    camera.lens = io::read_lens(w.lens);
    if (!w.f_number.empty()) camera.lens = stopped_down(camera.lens, parse_number("--f-number", w.f_number));
    std::optional<std::array<double, 2>> size_mm;
    std::optional<std::array<int, 2>> resolution;
    if (!w.film.empty()) size_mm = parse_size("--film", w.film);
    if (!w.resolution.empty()) resolution = parse_resolution("--resolution", w.resolution);
    camera.film = default_film(camera.lens, size_mm, resolution);
    camera.model = parse_model(w.model);
    camera.iso = parse_number("--iso", w.iso);
    request.meters_exposure = w.exposure_time.empty();
    if (!request.meters_exposure) camera.exposure_time_s = parse_fraction("--exposure-time", w.exposure_time);
    validate(camera);
    check_memory(camera.film);

    if (!w.position.empty()) request.view.position_m = parse_point("--position", w.position);
    if (!w.look_at.empty()) request.view.look_at_m = parse_point("--look-at", w.look_at);
    request.view.up = parse_point("--up", w.up);
    if (!w.focus.empty()) {
        request.view.focus_distance_m = parse_number("--focus", w.focus, true);
        focused(camera.lens, 1000 * *request.view.focus_distance_m);
    }
    return request;
}

}  // namespace realcam::app
