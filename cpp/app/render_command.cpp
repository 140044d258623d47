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

void say(const std::string& text) {
    std::fprintf(stderr, "realcam: %s\n", text.c_str());
}

/// Runs `work`; if memory runs out, the error names its purpose, `what`.
template <class Work>
auto with_memory_for(const std::string& what, Work&& work) {
    try {
        return work();
    } catch (const std::bad_alloc&) {
        throw Error("out of memory: " + what);
    }
}

bool is_wanted() {
    return Interrupt::signal() == 0;
}

/// Like is_wanted, for work that writes the samples taken so far to a file: false after the final signal.
bool is_to_be_finished() {
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

void check_memory(const Film& film, LayerSet layers) {
    // Memory that the CPU's session needs while it develops its sums into a picture.
    std::size_t bytes_per_pixel = sizeof(PixelSum) + 16;
    if (layers.has_any(kSampledLayers)) bytes_per_pixel += sizeof(LayerSum);
    if (layers.has_any(kPixelCentreLayers)) bytes_per_pixel += sizeof(PixelCentreSurface);
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (layers.has(static_cast<Layer>(i))) bytes_per_pixel += 4 * static_cast<std::size_t>(kLayers[i].channels);
    const double wanted = static_cast<double>(bytes_per_pixel) * film.width * film.height;
    const auto free = static_cast<double>(io::free_memory());
    if (wanted > free)
        throw Error("out of memory: a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                    " pixels needs " + number_text(wanted / 1e9, 3) + " GB, and " + number_text(free / 1e9, 3) +
                    " GB are free; use a smaller --resolution");
}

bool is_file(const std::string& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error);
}

/// One run of the command.
class Run {
public:
    Run(const RenderWords& words, const FilmWriter* film_writer)
        : words_(words), outputs_(words.outputs, film_writer) {}

    void photograph() {
        start_ = std::chrono::steady_clock::now();
        shot::ShotRequest request = understand(words_);
        const std::vector<int> frames = words_.frames ? frame_numbers(*words_.frames) : std::vector<int>();
        if (!(words_.frames_per_second > 0 && std::isfinite(words_.frames_per_second)))
            throw InputError("--fps must be more than 0 frames per second");
        outputs_.check(frames);
        resolve_keys(request);
        Camera camera = camera_of(request);
        const LayerSet written_layers = request.settings.layers;
        std::optional<Denoiser> denoiser = denoiser_for(request);
        if (denoiser) request.settings.layers.add(kDenoiserLayers);
        check_memory(camera.film, request.settings.layers);
        // Created first, because reading a scene may take long.
        const auto session = make_session(words_.device, [this](const std::string& text) { warn(text); });
        shot::Shot shot = set_up_shot(request, std::move(camera));
        for (const std::string& file : frames.empty() ? words_.outputs : outputs_.all_files(frames))
            image_io::check_no_input(file);
        if (!frames.empty()) film_digest_ = film_digest(request, shot.camera, std::to_string(words_.frames_per_second));
        const Darkroom darkroom{*session, denoiser ? &*denoiser : nullptr, written_layers};
        // Until this point the disk is untouched, and a signal may simply end the program.
        const Interrupt interrupt;
        meter_exposure(*session, shot, request);
        if (!frames.empty()) return film(darkroom, shot, request, frames);
        shot.camera = shaken(std::move(shot.camera), request.shake);
        const std::string decisions = settle(*session, shot, request, {});
        for (const std::string& notice : effect_notices(request.settings.effects, shot.camera.lens)) warn(notice);
        const std::string figures = take(darkroom, shot, request, decisions, words_.outputs, is_to_be_finished);
        if (!words_.is_quiet || words_.as_json) std::fputs(figures.c_str(), stdout);
        if (Interrupt::signal() != 0)
            throw Interrupted{Interrupt::signal(), "; the picture has the samples that were taken until then"};
    }

    void plan(bool as_json) {
        shot::ShotRequest request = understand(words_);
        request.settings.effects.is_automatic = true;
        resolve_keys(request);
        Camera camera = camera_of(request);
        const auto session = make_session(words_.device, [this](const std::string& text) { warn(text); });
        shot::Shot shot = set_up_shot(request, std::move(camera));
        meter(shot, request, *session, {});
        shot.camera = shaken(std::move(shot.camera), request.shake);
        const Plan plan = make_plan(*session, shot.scene, shot.camera, request.settings, true, fast_pupil_tracer());
        std::fputs((as_json ? json_of(plan) : text_of(plan, io::name_of(plan.model))).c_str(), stdout);
    }

private:
    /// Everything that turns a shot into a picture.
    struct Darkroom {
        Session& session;
        Denoiser* denoiser;  ///< null: no denoising
        LayerSet written_layers;
    };

    /// Returns a denoiser if the user requested one, or if .png may need one (denoises_if_noisy). If the library is
    /// missing or cannot use the device, a request throws Error; otherwise pictures stay noisy.
    std::optional<Denoiser> denoiser_for(const shot::ShotRequest& request) {
        if (!request.denoises && !denoises_if_noisy(request)) return std::nullopt;
        try {
            return std::optional<Denoiser>(std::in_place, words_.device, request.settings.threads);
        } catch (const Error& error) {  // library missing, or not available for this device
            if (request.denoises) throw;
            why_no_denoiser_ = error.what();
            return std::nullopt;
        }
    }

    /// True if pictures for screens are denoised when they miss the default noise goal.
    bool denoises_if_noisy(const shot::ShotRequest& request) const {
        return request.sampling == shot::Sampling::unsaid && !request.denoises && !request.keeps_noise &&
               !request.settings.layers.has_any(kHalfLayers) &&
               !std::all_of(words_.outputs.begin(), words_.outputs.end(), is_exr);
    }

    void warn(const std::string& text) {
        say("warning: " + text);
        warnings_.push_back(io::one_line(text));
    }

    void inform(const std::string& text) const {
        if (!words_.is_quiet) say(text);
    }

    shot::Shot set_up_shot(const shot::ShotRequest& request, Camera camera) {
        shot::Shot shot = set_up(request, std::move(camera), read_scene(request));
        if (const std::string notice = shot::view_notice(shot); !notice.empty()) inform(notice);
        if (shot.has_daylight)
            inform(
                "the scene holds no light; it gets daylight: a sun of 80 klux from the upper left, and a sky of 5000 "
                "cd/m^2");
        return shot;
    }

    /// Makes the decisions left to the planner, for the frames of a film or, without frames, for a picture. Returns a
    /// one-line summary.
    std::string settle(Session& session, shot::Shot& shot, shot::ShotRequest& request, const std::vector<int>& frames) {
        if (!request.settings.needs_plan()) return "";
        const std::vector<Camera> cameras =
            frames.empty() ? std::vector{shot.camera} : cameras_to_plan(shot, request, frames);
        ResolvedFilm film = until_interrupted([&] {
            ProgressBar planning("planning ", !words_.is_quiet);
            return resolve_film(session, shot.scene, cameras, request.settings, fast_pupil_tracer(), [&](double) {
                planning.show_seconds();
                return is_wanted();
            });
        });
        shot.camera.model = film.model;
        request.settings = std::move(film.settings);
        if (!film.warning.empty()) warn(film.warning);
        if (words_.explains && !words_.as_json && !words_.is_quiet)
            for (const Plan& plan : film.plans)
                std::fputs((text_of(plan, io::name_of(plan.model)) + '\n').c_str(), stdout);
        return film.summary;
    }

    std::vector<Camera> cameras_to_plan(const shot::Shot& shot, const shot::ShotRequest& request,
                                        const std::vector<int>& frames) const {
        std::vector<Camera> cameras;
        for (const int frame : shot::frames_to_plan(frames, shot.camera, request.keys, words_.frames_per_second))
            cameras.push_back(camera_of_frame(shot.camera, request, frame));
        return cameras;
    }

    Camera camera_of_frame(const Camera& camera, const shot::ShotRequest& request, int frame) const {
        return shot::camera_at(camera, request.keys, request.shake,
                               shot::frame_opens_s(camera, frame, words_.frames_per_second));
    }

    /// True if a file is a complete picture of the current frame, taken with the settings of this film.
    bool is_done(const std::string& file) const {
        return is_file(file) && until_interrupted([&] {
                                    return image_io::entry_of_whole_file(file, "realcam:film", is_wanted);
                                }) == frame_digest_;
    }

    /// Takes the frames of a film that are not done yet, and encodes its videos.
    void film(const Darkroom& darkroom, shot::Shot& shot, shot::ShotRequest& request, const std::vector<int>& frames) {
        const std::string decisions = settle(darkroom.session, shot, request, frames);
        const Camera camera = shot.camera;
        // Checks all frames before the first is taken, so that a lens that cannot follow its keys is not reported at
        // the last.
        std::set<std::string> notices;
        for (const int frame : frames) {
            const Camera taken_by = camera_of_frame(camera, request, frame);
            validate_effects(request.settings, taken_by);
            for (const std::string& notice : effect_notices(request.settings.effects, taken_by.lens))
                if (notices.insert(notice).second) warn(notice);
        }
        outputs_.begin();
        const std::uint32_t seed = request.settings.seed;
        std::optional<shot::FollowedIso> followed;
        if (request.iso_follows_s)
            followed.emplace(darkroom.session, shot.scene, camera, request.keys, request.settings,
                             words_.frames_per_second, *request.iso_follows_s);
        std::size_t there = 0, unfit = 0;
        std::string all_figures;
        for (const int frame : frames) {
            const std::vector<std::string> files = outputs_.files_of(frame);
            frame_digest_ = film_digest_ + '-' + std::to_string(frame);
            if (!words_.takes_again) {
                if (std::all_of(files.begin(), files.end(), [&](const auto& file) { return is_done(file); })) {
                    ++there;
                    continue;
                }
                unfit += std::any_of(files.begin(), files.end(), is_file);
            }
            start_ = std::chrono::steady_clock::now();
            shot.camera = camera_of_frame(camera, request, frame);
            if (followed)
                shot.camera.iso =
                    until_interrupted([&] { return followed->at(frame, [](double) { return is_wanted(); }); });
            request.settings.seed = shot::frame_seed(seed, frame);
            const std::string figures = take(darkroom, shot, request, decisions, files);
            if (words_.as_json)
                all_figures += (all_figures.empty() ? "" : ",\n") + figures;
            else if (!words_.is_quiet)
                std::fputs(frame_summary(frame, shot.camera, files).c_str(), stdout);
        }
        if (words_.as_json) std::fputs(("[\n" + all_figures + "]\n").c_str(), stdout);
        if (there > 0)
            inform(std::to_string(there) + " of " + std::to_string(frames.size()) +
                   " frames were there already; --again takes them, too");
        if (unfit > 0)
            inform(std::to_string(unfit) + " of " + std::to_string(frames.size()) +
                   " frames were there, but damaged or taken with other settings, and were taken again");
        const auto films =
            until_interrupted([&] { return outputs_.finish(frames, words_.frames_per_second, is_wanted); });
        for (const std::string& film : films)
            if (!words_.is_quiet && !words_.as_json) std::fputs(("wrote " + film + '\n').c_str(), stdout);
    }

    /// Takes and writes a picture; returns its figures. `finishes`: returns true if a picture that a signal has stopped
    /// is still to be written; empty: such a picture is discarded.
    std::string take(const Darkroom& darkroom, const shot::Shot& shot, const shot::ShotRequest& request,
                     const std::string& decisions, const std::vector<std::string>& files,
                     const KeepGoing& finishes = {}) {
        const KeepGoing& goes_on = finishes ? finishes : KeepGoing(is_wanted);
        Image image = expose(darkroom.session, shot, request, finishes);
        if (!image.shortfall.empty()) warn(image.shortfall);
        const bool is_noisy = !image.shortfall.empty() && denoises_if_noisy(request);
        std::optional<Image> denoised;
        std::string denoiser_name;
        if (darkroom.denoiser && (request.denoises || is_noisy)) {
            denoised = image;
            denoiser_name = darkroom.denoiser->name();
            until_interrupted([&] { denoise(*denoised, darkroom.written_layers, *darkroom.denoiser, goes_on); });
        }
        keep_layers(image, darkroom.written_layers);
        if (is_noisy)
            inform(denoised ? "the remaining noise was removed by " + denoiser_name +
                                  ", except from .exr; --no-denoise keeps it"
                            : "the remaining noise stays: " + why_no_denoiser_);
        const Image& shown = denoised ? *denoised : image;
        if (const std::string notice = exposure_notice(shown, shot.camera, request.tone); !notice.empty()) warn(notice);
        write(request.denoises ? shown : image, shown, shot, request, decisions, denoiser_name, files, goes_on);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        return words_.as_json
                   ? render_as_json(shot, request, image, files, decisions, denoiser_name, warnings_, seconds)
                   : summary(shot, request.settings, image, files, denoiser_name, seconds, words_.verbose);
    }

    Assembly read_scene(const shot::ShotRequest& request) {
        const shot::PictureReaders readers = {
            [](const std::string& path, std::span<const std::uint8_t> bytes) {
                return image_io::read_image(path, bytes);
            },
            [](const std::string& path, const std::string& layer, const image_io::WarnOf& warn) {
                return image_io::read_environment(path, layer, warn);
            }};
        Assembly scene =
            with_memory_for("while reading " + request.scene, [&] { return shot::scene_of(request, readers); });
        inputs_.end();
        const std::vector<std::string>& warnings = scene.static_geometry->warnings;
        constexpr std::size_t kShown = 10;
        for (std::size_t i = 0; i < std::min(kShown, warnings.size()); ++i) warn(warnings[i]);
        if (warnings.size() > kShown) say("and " + std::to_string(warnings.size() - kShown) + " more warnings");
        return scene;
    }

    void meter_exposure(Session& session, shot::Shot& shot, const shot::ShotRequest& request) const {
        until_interrupted([&] {
            ProgressBar metering("metering ", !words_.is_quiet);
            meter(shot, request, session, [&](double done) {
                metering.show(done);
                return is_wanted();
            });
        });
    }

    Image expose(Session& session, const shot::Shot& shot, const shot::ShotRequest& request,
                 const KeepGoing& finishes) const {
        const Film& film = shot.camera.film;
        return until_interrupted([&] {
            ProgressBar rendering("rendering", !words_.is_quiet);
            std::optional<SamplingNotice> notice;
            if (request.settings.noise) inform(notice.emplace(*request.settings.noise, request.sampling).aim());
            const auto show_rendering = [&](double done) {
                if (notice) {
                    done = notice->took(done);
                    if (const std::string text = notice->expectation(); !text.empty()) {
                        rendering.clear();
                        inform(text);
                    }
                }
                rendering.show(done);
                return is_wanted();
            };
            return with_memory_for(
                "for a picture of " + std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels",
                [&] {
                    return take_picture(session, shot.scene, shot.camera, request.settings, show_rendering, finishes);
                });
        });
    }

    /// `raw`: written to .exr; `shown`: to other files.
    void write(const Image& raw, const Image& shown, const shot::Shot& shot, const shot::ShotRequest& request,
               const std::string& decisions, const std::string& denoiser, const std::vector<std::string>& files,
               const KeepGoing& goes_on) const {
        io::ImageMetadata metadata = io::metadata_of(shot.camera, request.settings);
        metadata.plan = decisions;
        metadata.film = frame_digest_;
        metadata.spp = static_cast<int>(raw.spp);
        std::string written;
        for (const std::string& path : files) {
            const Image& image = is_exr(path) ? raw : shown;
            metadata.denoiser = !is_exr(path) || request.denoises ? denoiser : "";
            try {
                image_io::write_image(image_io::view_of(image), path, metadata, request.tone, goes_on);
            } catch (const Cancelled&) {
                throw Interrupted{Interrupt::signal(), written.empty() ? "" : "; written before: " + written};
            }
            written += (written.empty() ? "" : ", ") + path;
        }
    }

    const RenderWords& words_;
    FilmOutputs outputs_;
    std::chrono::steady_clock::time_point start_;
    std::vector<std::string> warnings_;  ///< already printed
    std::string why_no_denoiser_;
    io::InputRecording inputs_;
    std::string film_digest_, frame_digest_;  ///< empty for a still
};

}  // namespace

void add_render_command(CLI::App& app, const FilmWriter* film_writer) {
    CLI::App* command = app.add_subcommand("render", "Photograph a scene through a lens.");
    const auto words = std::make_shared<RenderWords>();
    add_render_options(*command, *words);
    set_examples(
        *command,
        {
            "realcam render scene.glb -o picture.png",
            "realcam render scene.glb -o picture.png -o film.exr --lens tessar-50mm --f-number 5.6 --focus 2.5",
            "realcam render scene.obj -o picture.png --position 0,1.5,4 --look-at 0,1,0 "
            "--exposure-time 1/125 --iso 400",
            "realcam render shot.toml -o picture.png --noise-codes 1 --seconds 300 --json",
            "realcam render shot.toml -o picture.png --spp 16 --denoise",
            "realcam render shot.toml -o frames/shot.####.exr --frames 1-240",
            "realcam render shot.toml -o film.mp4 --frames 1-240 --fps 30",
        });
    command->callback([words, film_writer] { Run{*words, film_writer}.photograph(); });
}

void add_plan_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("plan", "Say which effects a shot calls for, and why.");
    const auto words = std::make_shared<RenderWords>();
    const auto as_json = std::make_shared<bool>(false);
    add_shot_options(*command, *words);
    command->add_flag("--json", *as_json, "Print JSON");
    set_examples(*command, {
                               "realcam plan shot.toml",
                               "realcam plan scene.glb --lens tessar-50mm --f-number 16 --quality draft --json",
                           });
    command->callback([=] { Run(*words, nullptr).plan(*as_json); });
}

}  // namespace realcam::app
