#include "render_options.hpp"

#include <algorithm>

#include "../io/files/uri.hpp"

namespace realcam::app {
bool is_exr(const std::string& path) {
    return io::suffix_of(path) == ".exr";
}

namespace {

bool writes_layers(const RenderWords& w) {
    return std::any_of(w.outputs.begin(), w.outputs.end(), is_exr);
}

/// An empty value would be read as an omitted option.
CLI::Validator not_empty() {
    return CLI::Validator([](std::string& word) { return word.empty() ? "is empty" : ""; }, "", "");
}

void add_option_of(CLI::App& command, RenderWords& words, const shot::ShotKey& key) {
    const auto keep = [&words, &key](const std::string& word) { words.changes.options.emplace_back(&key, word); };
    command.add_option_function<std::string>(key.option, keep, key.help())
        ->type_name(key.placeholder)
        ->group(key.group)
        ->check(not_empty());
}

}  // namespace

void add_shot_options(CLI::App& command, RenderWords& words) {
    command
        .add_option("SCENE", words.scene,
                    "The scene: .obj (with .mtl), .gltf, .glb or .ply; or a shot file: .toml, whose values hold for "
                    "all options that are not given")
        ->type_name("SCENE")
        ->check(not_empty())
        ->required();
    for (const shot::ShotKey& key : shot::shot_keys())
        if (key.option) add_option_of(command, words, key);
    command.get_option("--focal-length")->excludes(command.get_option("--zoom"));
    command.option_defaults()->group("Camera");
    add_lens_options(command, words.lens_file);
    command.option_defaults()->group("Picture");
    command.add_option("--device", words.device, "auto (a GPU if there is one), cpu, cuda, or cuda:1 [auto]")
        ->type_name("DEVICE")
        ->check(not_empty());
}

void add_render_options(CLI::App& command, RenderWords& w) {
    const std::string group = command.option_defaults()->get_group();
    add_shot_options(command, w);
    command.add_flag(
        "--denoise", w.denoises,
        "Take the noise that is left from the picture, by Open Image Denoise (realcam[denoise]) [without --spp: from "
        ".png where the noise goal is not reached]");
    command.add_flag("--no-denoise", w.keeps_noise, "Leave the noise");
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
    shot::ShotRequest request = shot::read_shot(w.scene, w.changes);
    request.lens_options = lens_options_of(w.lens_file);
    request.keeps_noise = w.keeps_noise;
    request.denoises = w.denoises && !w.keeps_noise;
    resolve_noise_goal(request);
    if (writes_layers(w)) return request;
    for (const auto& [key, word] : w.changes.options)
        if (key->name == std::string_view("layers"))
            throw InputError("--layers: layers are written to .exr, and no --output is one");
    request.settings.layers = {};  // layers of a shot file would cost time, and no output could hold them
    return request;
}

}  // namespace realcam::app
