#include "render_command.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "../denoise/denoiser.hpp"
#include "../devices/devices.hpp"
#include "../embree/lens_rays.hpp"
#include "../image_io/image_file.hpp"
#include "../image_io/unfinished_file.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/files/regular_file.hpp"
#include "../io/text/printable.hpp"
#include "../plan/make_plan.hpp"
#include "../plan/plan.hpp"
#include "../render/film/pixel_sum.hpp"
#include "../render/session/take_picture.hpp"
#include "../render/settings/effect_names.hpp"
#include "../render/settings/setting_names.hpp"
#include "../shot/shot.hpp"
#include "help.hpp"
#include "interrupt.hpp"
#include "outputs.hpp"
#include "progress_bar.hpp"
#include "render_json.hpp"
#include "render_notices.hpp"
#include "render_options.hpp"
#include "values.hpp"

namespace realcam::app {
namespace {

void print_message(const std::string& text) {
    std::fprintf(stderr, "realcam: %s\n", text.c_str());
}

/// Runs `work`. If memory runs out, throws Error whose message ends with `purpose`, such as "while reading room.obj".
template <class Work>
auto with_memory_for(const std::string& purpose, Work&& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw Error("out of memory: " + purpose);
    }
}

/// Passed as KeepGoing: false once Ctrl-C or SIGTERM has been received.
bool is_not_interrupted() {
    return Interrupt::signal() == 0;
}

/// Passed as KeepGoing where the samples taken so far are developed and written after a first Ctrl-C: false only after
/// the final signal (Interrupt::is_final).
bool keeps_partial_picture() {
    return !Interrupt::is_final();
}

/// Runs `work`; if it was cancelled, throws Interrupted with the received signal.
template <class Work>
auto until_interrupted(Work&& work) {
    try {
        return work();
    } catch (const Cancelled&) {
        throw Interrupted{Interrupt::signal(), ""};
    }
}

/// Throws Error if the picture and its layers would need more memory than is free.
void check_memory(const Film& film, LayerSet layers) {
    // Memory that the CPU's session needs while it develops its sums into a picture.
    std::size_t bytes_per_pixel = sizeof(PixelSum) + 16;
    if (layers.has_any(kSampledLayers)) bytes_per_pixel += sizeof(LayerSum);
    if (layers.has_any(kPixelCentreLayers)) bytes_per_pixel += sizeof(PixelCentreSurface);
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (layers.has(static_cast<Layer>(i))) bytes_per_pixel += 4 * static_cast<std::size_t>(kLayers[i].channels);
    const double needed_bytes = static_cast<double>(bytes_per_pixel) * film.width * film.height;
    const auto free_bytes = static_cast<double>(io::free_memory());
    if (needed_bytes > free_bytes)
        throw Error("out of memory: a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                    " pixels needs " + number_text(needed_bytes / 1e9, 3) + " GB, and " +
                    number_text(free_bytes / 1e9, 3) + " GB are free; use a smaller --resolution");
}

bool is_file(const std::string& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

/// One run of `realcam render` or `realcam plan`.
class Run {
public:
    Run(const RenderOptions& options, const VideoWriter* video_writer)
        : options_(options), outputs_(options.outputs, video_writer) {}

    /// Renders the picture or frames and writes them. Throws Error, and Interrupted after a signal.
    void render_shot() {
        start_ = std::chrono::steady_clock::now();
        shot::ShotRequest request = request_from_options(options_);
        const std::vector<int> frames = options_.frames ? frame_numbers(*options_.frames) : std::vector<int>();
        if (!(options_.frames_per_second > 0 && std::isfinite(options_.frames_per_second)))
            throw InputError("--fps must be more than 0 frames per second");
        outputs_.check(frames);
        resolve_keys(request);
        Camera camera = camera_of(request);
        view_ = view_of(request);
        const LayerSet written_layers = request.settings.layers;
        std::optional<Denoiser> denoiser = denoiser_for(request);
        if (denoiser) request.settings.layers.add(kDenoiserLayers);
        check_memory(camera.film, request.settings.layers);
        // Created before the scene is read, which may take long: a device that is missing is then reported at once.
        const auto session = make_session(options_.device, [this](const std::string& text) { warn(text); });
        shot::Shot shot = set_up_shot(request, std::move(camera));
        for (const std::string& file : frames.empty() ? options_.outputs : outputs_.all_files(frames))
            image_io::check_is_not_an_input(file);
        if (!frames.empty())
            settings_digest_ = settings_digest(request, shot.camera, std::to_string(options_.frames_per_second));
        const PictureTools tools{*session, denoiser ? &*denoiser : nullptr, written_layers};
        // Until this point the disk is untouched, and a signal may simply end the program.
        const Interrupt interrupt;
        meter_exposure(*session, shot, request);
        if (!frames.empty()) return render_frames(tools, shot, request, frames);
        shot.camera = shaken(std::move(shot.camera), request.shake);
        const std::string plan_summary = resolve_plan(*session, shot, request, {});
        for (const std::string& notice : effect_notices(request.settings.effects, shot.camera.lens)) warn(notice);
        const std::string report =
            take_and_write(tools, shot, request, plan_summary, options_.outputs, keeps_partial_picture);
        if (!options_.is_quiet || options_.as_json) std::fputs(report.c_str(), stdout);
        if (Interrupt::signal() != 0)
            throw Interrupted{Interrupt::signal(), "; the picture contains the samples taken so far"};
    }

    /// Prints which effects the planner chooses for the shot, without rendering it.
    void plan(bool as_json) {
        shot::ShotRequest request = request_from_options(options_);
        request.settings.effects.is_automatic = true;
        resolve_keys(request);
        Camera camera = camera_of(request);
        const auto session = make_session(options_.device, [this](const std::string& text) { warn(text); });
        shot::Shot shot = set_up_shot(request, std::move(camera));
        meter(shot, request, *session, {});
        shot.camera = shaken(std::move(shot.camera), request.shake);
        const Plan plan = make_plan(*session, shot.scene, shot.camera, request.settings, true, fast_pupil_tracer());
        std::fputs((as_json ? json_of(plan) : text_of(plan, name_of(plan.model))).c_str(), stdout);
    }

private:
    /// Session and denoiser with which all pictures of this run are taken.
    struct PictureTools {
        Session& session;
        Denoiser* denoiser;  ///< null: no denoising
        LayerSet written_layers;  ///< layers that the user requested; those for the denoiser are not written
    };

    /// Returns a denoiser if the user requested one, or if .png may need one (denoises_if_noisy). If the library is
    /// missing or cannot use the device, a request throws Error; otherwise pictures stay noisy.
    std::optional<Denoiser> denoiser_for(const shot::ShotRequest& request) {
        if (!request.denoises && !denoises_if_noisy(request)) return std::nullopt;
        try {
            return std::optional<Denoiser>(std::in_place, options_.device, request.settings.threads);
        } catch (const Error& error) {  // library missing, or not available for this device
            if (request.denoises) throw;
            why_no_denoiser_ = error.what();
            return std::nullopt;
        }
    }

    /// True if pictures for screens are denoised when they miss the default noise goal.
    bool denoises_if_noisy(const shot::ShotRequest& request) const {
        return request.sampling == shot::Sampling::unspecified && !request.denoises && !request.keeps_noise &&
               !request.settings.layers.has_any(kHalfLayers) &&
               !std::all_of(options_.outputs.begin(), options_.outputs.end(), is_exr);
    }

    /// Prints a warning, and stores it for the JSON report.
    void warn(const std::string& text) {
        print_message("warning: " + text);
        warnings_.push_back(io::one_line(text));
    }

    /// Prints a message, unless --quiet is set.
    void inform(const std::string& text) const {
        if (!options_.is_quiet) print_message(text);
    }

    /// Reads the scene and places the camera; informs about a view or daylight that the user did not specify.
    shot::Shot set_up_shot(const shot::ShotRequest& request, Camera camera) {
        shot::Shot shot = set_up(request, std::move(camera), read_scene(request));
        if (const std::string notice = shot::view_notice(shot); !notice.empty()) inform(notice);
        if (shot.has_daylight)
            inform(
                "the scene has no light; daylight is added: a sun of 80 klux from the upper left, and a sky of 5000 "
                "cd/m^2");
        return shot;
    }

    /// Plans the camera model and effects that the request leaves to the planner, and sets them in `shot` and
    /// `request`. `frames`: frame numbers of a video, or empty for a single picture. Returns a one-line summary of the
    /// plan; empty if nothing was left to the planner.
    std::string resolve_plan(Session& session, shot::Shot& shot, shot::ShotRequest& request,
                             const std::vector<int>& frames) {
        if (!request.settings.needs_plan()) return "";
        const std::vector<Camera> cameras =
            frames.empty() ? std::vector{shot.camera} : cameras_to_plan(shot, request, frames);
        ResolvedSettings plan = until_interrupted([&] {
            ProgressBar planning("planning ", !options_.is_quiet);
            return resolve_settings(session, shot.scene, cameras, request.settings, fast_pupil_tracer(), [&](double) {
                planning.show_seconds();
                return is_not_interrupted();
            });
        });
        shot.camera.model = plan.model;
        request.settings = std::move(plan.settings);
        if (!plan.warning.empty()) warn(plan.warning);
        if (options_.explains && !options_.as_json && !options_.is_quiet)
            for (const Plan& part : plan.plans) std::fputs((text_of(part, name_of(part.model)) + '\n').c_str(), stdout);
        return plan.summary;
    }

    /// Cameras of the frames from which the effects are planned (shot::frames_to_plan).
    std::vector<Camera> cameras_to_plan(const shot::Shot& shot, const shot::ShotRequest& request,
                                        const std::vector<int>& frames) const {
        std::vector<Camera> cameras;
        for (const int frame : shot::frames_to_plan(frames, shot.camera, request.keys, options_.frames_per_second))
            cameras.push_back(camera_of_frame(shot.camera, request, frame));
        return cameras;
    }

    /// `camera` when the shutter of a frame opens, with its keys and shake.
    Camera camera_of_frame(const Camera& camera, const shot::ShotRequest& request, int frame) const {
        return shot::camera_at(camera, request.keys, request.shake,
                               shot::frame_opens_s(camera, frame, options_.frames_per_second));
    }

    /// True if the file is a complete picture of the current frame, taken with the current settings.
    bool is_complete_frame(const std::string& file) const {
        return is_file(file) &&
               until_interrupted([&] {
                   return image_io::entry_of_complete_picture(file, "realcam:film", is_not_interrupted);
               }) == frame_digest_;
    }

    /// Takes all frames that are not complete yet (with --again, all frames), and encodes the videos.
    void render_frames(const PictureTools& tools, shot::Shot& shot, shot::ShotRequest& request,
                       const std::vector<int>& frames) {
        const std::string plan_summary = resolve_plan(tools.session, shot, request, frames);
        const Camera camera = shot.camera;
        // Checks all frames before the first is taken, so that a lens that cannot follow its keys is reported at once.
        std::set<std::string> notices;
        for (const int frame : frames) {
            const Camera frame_camera = camera_of_frame(camera, request, frame);
            validate_effects(request.settings, frame_camera);
            for (const std::string& notice : effect_notices(request.settings.effects, frame_camera.lens))
                if (notices.insert(notice).second) warn(notice);
        }
        outputs_.create_frame_folders();
        const std::uint32_t seed = request.settings.seed;
        std::optional<shot::AutoIso> auto_iso;
        if (request.iso_follows_s)
            auto_iso.emplace(tools.session, shot.scene, camera, request.keys, request.settings,
                             options_.frames_per_second, *request.iso_follows_s);
        std::size_t complete = 0, outdated = 0;
        std::string all_reports;
        for (const int frame : frames) {
            const std::vector<std::string> files = outputs_.files_of(frame);
            frame_digest_ = settings_digest_ + '-' + std::to_string(frame);
            if (!options_.retakes_frames) {
                if (std::all_of(files.begin(), files.end(),
                                [&](const auto& file) { return is_complete_frame(file); })) {
                    ++complete;
                    continue;
                }
                outdated += std::any_of(files.begin(), files.end(), is_file);
            }
            start_ = std::chrono::steady_clock::now();
            shot.camera = camera_of_frame(camera, request, frame);
            if (auto_iso)
                shot.camera.iso =
                    until_interrupted([&] { return auto_iso->at(frame, [](double) { return is_not_interrupted(); }); });
            request.settings.seed = shot::frame_seed(seed, frame);
            const std::string report = take_and_write(tools, shot, request, plan_summary, files);
            if (options_.as_json)
                all_reports += (all_reports.empty() ? "" : ",\n") + report;
            else if (!options_.is_quiet)
                std::fputs(frame_summary(frame, shot.camera, files).c_str(), stdout);
        }
        if (options_.as_json) std::fputs(("[\n" + all_reports + "]\n").c_str(), stdout);
        if (complete > 0)
            inform(std::to_string(complete) + " of " + std::to_string(frames.size()) +
                   " frames exist already; --again takes them again");
        if (outdated > 0)
            inform(std::to_string(outdated) + " of " + std::to_string(frames.size()) +
                   " frames existed, but were damaged or taken with other settings, and were taken again");
        const auto videos = until_interrupted(
            [&] { return outputs_.encode_videos(frames, options_.frames_per_second, is_not_interrupted); });
        for (const std::string& video : videos)
            if (!options_.is_quiet && !options_.as_json) std::fputs(("wrote " + video + '\n').c_str(), stdout);
    }

    /// Takes a picture, denoises it if requested, and writes it to `files`. Returns the report that the command prints,
    /// as text or JSON. `keep_partial`: returns true if a picture that a signal has stopped is to be written with the
    /// samples taken until then; empty: such a picture is discarded.
    std::string take_and_write(const PictureTools& tools, const shot::Shot& shot, const shot::ShotRequest& request,
                               const std::string& plan_summary, const std::vector<std::string>& files,
                               const KeepGoing& keep_partial = {}) {
        const KeepGoing& keep_going = keep_partial ? keep_partial : KeepGoing(is_not_interrupted);
        Image image = expose(tools.session, shot, request, keep_partial);
        if (!image.shortfall.empty()) warn(image.shortfall);
        const bool is_noisy = !image.shortfall.empty() && denoises_if_noisy(request);
        std::optional<Image> denoised;
        std::string denoiser_name;
        if (tools.denoiser && (request.denoises || is_noisy)) {
            denoised = image;
            denoiser_name = tools.denoiser->name();
            until_interrupted([&] { denoise(*denoised, tools.written_layers, *tools.denoiser, keep_going); });
        }
        keep_layers(image, tools.written_layers);
        if (is_noisy)
            inform(denoised ? "the remaining noise was removed by " + denoiser_name +
                                  ", except from .exr; --no-denoise keeps it"
                            : "the remaining noise stays: " + why_no_denoiser_);
        const Image& for_screen = denoised ? *denoised : image;
        if (const std::string notice = exposure_notice(for_screen, shot.camera, *view_); !notice.empty()) warn(notice);
        write(request.denoises ? for_screen : image, for_screen, shot, request, plan_summary, denoiser_name, files,
              keep_going);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        return options_.as_json
                   ? render_as_json(shot, request, *view_, image, files, plan_summary, denoiser_name, warnings_,
                                    seconds)
                   : summary(shot, request.settings, image, files, denoiser_name, seconds, options_.verbose);
    }

    /// Reads the scene file and its textures, and prints the first ten of its warnings.
    Assembly read_scene(const shot::ShotRequest& request) {
        const shot::PictureReaders readers = {
            [](const std::string& path, std::span<const std::uint8_t> bytes) {
                return image_io::read_image(path, bytes);
            },
            [](const std::string& path, const std::string& layer, const io::ColorConversion& to_rec709,
               const image_io::WarnOf& warn) { return image_io::read_environment(path, layer, warn, {}, to_rec709); }};
        Assembly scene =
            with_memory_for("while reading " + request.scene, [&] { return shot::scene_of(request, readers); });
        inputs_.end();
        const std::vector<std::string>& warnings = scene.static_geometry->warnings;
        constexpr std::size_t kMaxPrinted = 10;
        for (std::size_t i = 0; i < std::min(kMaxPrinted, warnings.size()); ++i) warn(warnings[i]);
        if (warnings.size() > kMaxPrinted)
            print_message("and " + std::to_string(warnings.size() - kMaxPrinted) + " more warnings");
        return scene;
    }

    void meter_exposure(Session& session, shot::Shot& shot, const shot::ShotRequest& request) const {
        until_interrupted([&] {
            ProgressBar metering("metering ", !options_.is_quiet);
            meter(shot, request, session, [&](double done) {
                metering.show(done);
                return is_not_interrupted();
            });
        });
    }

    /// Renders the picture, with a progress bar. See take_and_write for `keep_partial`.
    Image expose(Session& session, const shot::Shot& shot, const shot::ShotRequest& request,
                 const KeepGoing& keep_partial) const {
        const Film& film = shot.camera.film;
        return until_interrupted([&] {
            ProgressBar rendering("rendering", !options_.is_quiet);
            std::optional<SamplingNotice> notice;
            if (request.settings.noise) inform(notice.emplace(*request.settings.noise, request.sampling).goal_text());
            const auto show_rendering = [&](double done) {
                if (notice) {
                    done = notice->update(done);
                    if (const std::string text = notice->duration_notice(); !text.empty()) {
                        rendering.clear();
                        inform(text);
                    }
                }
                rendering.show(done);
                return is_not_interrupted();
            };
            return with_memory_for(
                "for a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
                [&] {
                    return take_picture(session, shot.scene, shot.camera, request.settings, show_rendering,
                                        keep_partial);
                });
        });
    }

    /// Writes the files. `raw`: picture for .exr files; `for_screen`: picture for other files, perhaps denoised.
    /// `plan_summary` and `denoiser` go into the files' metadata. Throws ImageFileError, and Interrupted that names the
    /// files written before.
    void write(const Image& raw, const Image& for_screen, const shot::Shot& shot, const shot::ShotRequest& request,
               const std::string& plan_summary, const std::string& denoiser, const std::vector<std::string>& files,
               const KeepGoing& keep_going) const {
        io::ImageMetadata metadata = io::metadata_of(shot.camera, request.settings);
        metadata.plan = plan_summary;
        metadata.film = frame_digest_;
        metadata.spp = static_cast<int>(raw.spp);
        std::string written;
        for (const std::string& path : files) {
            const Image& image = is_exr(path) ? raw : for_screen;
            metadata.denoiser = !is_exr(path) || request.denoises ? denoiser : "";
            try {
                image_io::write_image(image_io::view_of(image), path, metadata, *view_, request.exr_color_space,
                                      keep_going);
            } catch (const Cancelled&) {
                throw Interrupted{Interrupt::signal(), written.empty() ? "" : "; written before: " + written};
            }
            written += (written.empty() ? "" : ", ") + path;
        }
    }

    const RenderOptions& options_;
    OutputFiles outputs_;
    std::chrono::steady_clock::time_point start_;
    std::shared_ptr<const View> view_;  ///< develops the pictures
    std::vector<std::string> warnings_;  ///< printed so far, for the JSON report
    std::string why_no_denoiser_;  ///< reason why the default denoiser is not available; empty if it is
    io::InputRecording inputs_;  ///< records the files that are read, for settings_digest
    /// Digest of the settings, and the same with the current frame's number; empty for a single picture.
    std::string settings_digest_, frame_digest_;
};

}  // namespace

void add_render_command(CLI::App& app, const VideoWriter* video_writer) {
    CLI::App* command = app.add_subcommand("render", "Photograph a scene through a lens.");
    const auto options = std::make_shared<RenderOptions>();
    add_render_options(*command, *options);
    set_examples(
        *command,
        {
            "realcam render scene.glb -o picture.png",
            "realcam render scene.glb -o picture.png -o exposure.exr --lens tessar-50mm --f-number 5.6 --focus 2.5",
            "realcam render scene.obj -o picture.png --position 0,1.5,4 --look-at 0,1,0 "
            "--exposure-time 1/125 --iso 400",
            "realcam render shot.toml -o picture.png --noise-codes 1 --seconds 300 --json",
            "realcam render shot.toml -o picture.png --spp 16 --denoise",
            "realcam render shot.toml -o frames/shot.####.exr --frames 1-240",
            "realcam render shot.toml -o video.mp4 --frames 1-240 --fps 30",
        });
    command->callback([options, video_writer] { Run{*options, video_writer}.render_shot(); });
}

void add_plan_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("plan", "Print which effects a shot calls for, and why.");
    const auto options = std::make_shared<RenderOptions>();
    const auto as_json = std::make_shared<bool>(false);
    add_shot_options(*command, *options);
    command->add_flag("--json", *as_json, "Print JSON");
    set_examples(*command, {
                               "realcam plan shot.toml",
                               "realcam plan scene.glb --lens tessar-50mm --f-number 16 --quality draft --json",
                           });
    command->callback([=] { Run(*options, nullptr).plan(*as_json); });
}

}  // namespace realcam::app
