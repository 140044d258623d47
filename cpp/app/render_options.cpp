#include "render_options.hpp"

#include <algorithm>

#include "../io/files/uri.hpp"

namespace realcam::app {
bool is_exr(const std::string& path) {
    return io::suffix_of(path) == ".exr";
}

namespace {

bool has_exr_output(const RenderOptions& options) {
    return std::any_of(options.outputs.begin(), options.outputs.end(), is_exr);
}

/// Rejects an empty value, which would be read as an omitted option.
CLI::Validator not_empty() {
    return CLI::Validator([](std::string& value) { return value.empty() ? "is empty" : ""; }, "", "");
}

void add_shot_option(CLI::App& command, RenderOptions& options, const shot::ShotKey& key) {
    const auto store = [&options, &key](const std::string& value) {
        options.changes.options.emplace_back(&key, value);
    };
    command.add_option_function<std::string>(key.option, store, key.help())
        ->type_name(key.placeholder)
        ->group(key.group)
        ->check(not_empty());
}

}  // namespace

void add_shot_options(CLI::App& command, RenderOptions& options) {
    command
        .add_option(
            "SCENE", options.scene,
            "The scene: .obj (with .mtl), .gltf, .glb, .ply or .usd; or a shot file: .toml, whose values apply to "
            "all options that are not specified")
        ->type_name("SCENE")
        ->check(not_empty())
        ->required();
    for (const shot::ShotKey& key : shot::shot_keys())
        if (key.option) add_shot_option(command, options, key);
    command.get_option("--focal-length")->excludes(command.get_option("--zoom"));
    command.option_defaults()->group("Camera");
    add_lens_options(command, options.lens_file);
    command.option_defaults()->group("Picture");
    command.add_option("--device", options.device, "auto (a GPU if there is one), cpu, cuda, or cuda:1 [auto]")
        ->type_name("DEVICE")
        ->check(not_empty());
}

void add_render_options(CLI::App& command, RenderOptions& options) {
    const std::string group = command.option_defaults()->get_group();
    add_shot_options(command, options);
    command.add_flag(
        "--denoise", options.denoises,
        "Remove the remaining noise with Open Image Denoise (realcam[denoise]) [without --spp: only from .png, if the "
        "noise goal is not reached]");
    command.add_flag("--no-denoise", options.keeps_noise, "Do not denoise the picture");
    command.add_flag("-v,--verbose", options.verbose, "Also print rays per second, and the time of each stage");
    command.add_flag("--explain", options.explains, "Also print the decisions of --effects auto, with their reasons");
    command.add_flag("--json", options.as_json, "Print the picture's settings and cost as JSON instead of text");
    command.add_flag("-q,--quiet", options.is_quiet, "Print only warnings and errors");
    command.option_defaults()->group("Video");
    CLI::Option* const frames =
        command
            .add_option(
                "--frames", options.frames,
                "Frames of a video: 1-240, or 1-240x10 for every tenth. The frame number replaces #### in the file "
                "name, or is inserted before its suffix; frames that exist already are not taken again")
            ->type_name("A-B");
    command.add_option("--fps", options.frames_per_second, "Frames per second of the scene's time [24]")
        ->type_name("N")
        ->needs(frames);
    command.add_flag("--again", options.retakes_frames, "Retake frames that exist already")->needs(frames);
    command.option_defaults()->group(group);
    command
        .add_option("-o,--output", options.outputs,
                    "Picture to write: .png, .jpg, .tif or .webp, or .exr for the linear exposure; may be repeated. "
                    "With --frames also .mp4 (realcam[video])")
        ->type_name("FILE")
        ->required()
        ->allow_extra_args(false);
}

shot::ShotRequest request_from_options(const RenderOptions& options) {
    shot::ShotRequest request = shot::read_shot(options.scene, options.changes);
    request.lens_options = lens_options_of(options.lens_file);
    request.keeps_noise = options.keeps_noise;
    request.denoises = options.denoises && !options.keeps_noise;
    resolve_noise_goal(request, request.denoises);
    if (has_exr_output(options)) return request;
    for (const auto& [key, value] : options.changes.options)
        if (key->name == std::string_view("layers"))
            throw InputError("--layers: layers need an .exr file, and no --output is one");
    request.settings.layers = {};  // layers of a shot file would cost time, and no output could hold them
    return request;
}

}  // namespace realcam::app
