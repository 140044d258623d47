#include "embree_session.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>
#include <system_error>
#include <utility>

#include "../camera/camera_setup.hpp"
#include "../render/film/film_control_variates.hpp"
#include "../render/film/film_sums.hpp"
#include "../render/lights/traced_lights.hpp"
#include "../render/session/adaptive_sampling.hpp"
#include "../render/session/live_frame.hpp"
#include "../render/session/progress.hpp"
#include "embree_scene.hpp"
#include "host_frame.hpp"
#include "kernels.hpp"
#include "lens_rays.hpp"

namespace realcam {
namespace {

constexpr int kTileSide = SampleSharing::kTileSide;
constexpr std::size_t kDevelopGrain = 4096;  // pixels that are developed by one task

/// Session on the CPU. Renders tiles of pixels in parallel with the kernels of the machine's instruction set
/// (kernels.hpp).
class EmbreeSession final : public Session {
public:
    EmbreeSession() : device_(new_embree_device()) { kernels(); }
    ~EmbreeSession() override {
        cancel();
        scene_.reset();
        rtcReleaseDevice(device_);
    }

    std::string name() const override {
        const auto version = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION);
        return "CPU (Embree " + std::to_string(version / 10000) + '.' + std::to_string(version / 100 % 100) +
               ", x86-64-" + kernels().instruction_set + ", " +
               std::to_string(tbb::this_task_arena::max_concurrency()) + " threads)";
    }

private:
    /// Ignores PupilStart and searches for the pupil from scratch: on a CPU a frame takes so much longer than the
    /// search that discarding a frame with an approximate pupil would cost more.
    void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings, PupilStart,
                 const KeepGoing& keep_going, OwnStop& stop) override {
        const auto work = [&] {
            arena(settings).execute([&] {
                setup_ = last_setup_.make(camera, fast_pupil_tracer(), settings.lens_effects());
                place(scene, camera);
                camera_view_ = setup_->view(scene_->placed().origin_m(), scene_->placed().moves());
                traced_lights_ = traced_lights(scene_->placed().view(), camera_view_, *setup_,
                                               settings.effective_light_tracing(), fast_pupil_tracer());
                camera_view_.traced_lights = traced_lights_.view();
            });
        };
        run_interruptibly(work, keep_going, stop);
        if (stop) throw Cancelled();
    }

    void clear() override {
        const Film& film = camera().film;
        const std::size_t pixels = static_cast<std::size_t>(film.width) * static_cast<std::size_t>(film.height);
        film_.assign(pixels, PixelSum{});
        splats_ = empty_splats();
        const bool learns = settings().pupil_sampling == PupilSampling::pixel;
        known_.assign(learns ? pixels : 0, PixelPupil{});
        found_ = known_;
        if (learns) camera_view_.pixel_pupils = {known_.data(), found_.data()};
        stats_ = {};
    }

    void take_samples(const SampleRange& range, const PixelCounts& counts, bool traces_lights,
                      std::atomic<std::int64_t>& done, OwnStop&) override {
        if (camera_view_.pixel_pupils.known) {
            for (const SampleRange& pass : learning_passes(range)) {
                expose_film(pass, counts.after(pass.first - range.first), settings(), done);
                known_ = found_;
            }
        } else {
            expose_film(range, counts, settings(), done);
        }
        if (traces_lights) splat(splats_, range, settings());
    }

    RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                           std::atomic<std::int64_t>& done, OwnStop&) override {
        RegionSums sums{FilmSums(region.pixels()), {}};
        expose(region, range, counts, settings(), done, sums.pixels, sums.stats);
        return sums;
    }

    std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop&) override {
        std::vector<SplatFilm> splats = empty_splats();
        splat(splats, range, settings());
        return splats;
    }

    void trace_layers(const FilmRegion& region, const SampleRange& range, std::vector<LayerSum>& film,
                      std::atomic<std::int64_t>& done, OwnStop&) override {
        for_tiles(region, range, settings(), [&](const realcam_tile& part) {
            realcam_tile tile = part;
            std::vector<LayerSum> sums(pixels_of(tile));
            tile.sums = sums.data();
            kernels().trace_layers(&tile);
            for_pixels(tile, region,
                       [&](std::size_t in_tile, std::size_t in_region) { film[in_region] += sums[in_tile]; });
            done += samples_of_tile(tile);
        });
    }

    void trace_pixel_centres(std::vector<PixelCentreSurface>& film, OwnStop&) override {
        for_tiles(whole_film(), {settings().seed, 0, 1}, settings(), [&](const realcam_tile& part) {
            realcam_tile tile = part;
            std::vector<PixelCentreSurface> surfaces(pixels_of(tile));
            tile.sums = surfaces.data();
            kernels().trace_pixel_centres(&tile);
            for_pixels(tile, whole_film(),
                       [&](std::size_t in_tile, std::size_t in_region) { film[in_region] = surfaces[in_tile]; });
        });
    }

    std::vector<LayerImage> develop_auxiliary_layers() override {
        return developed_auxiliary_layers(view(), settings().layers, film_exposure_s());
    }

    std::shared_ptr<LiveFrame> start_frame(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                           std::shared_ptr<void> in_progress) override {
        // All later calls wait for the frame, so that the members which its thread uses do not change meanwhile.
        auto work = [this, ranges, curve, film = camera().film,
                     development = Development{film_exposure_s(), camera().iso}, settings = settings(),
                     token = std::move(in_progress)]() mutable {
            const std::shared_ptr<void> until_the_end = std::move(token);
            std::atomic<std::int64_t> done{0};
            for (const SampleRange& range : ranges) {
                expose_film(range, {}, settings, done);
                splat(splats_, range, settings);
            }
            if (is_stopped()) throw Cancelled();
            return arena(settings).execute([&] {
                return developed_codes(view(film, settings), development.exposure_s, development.iso, curve,
                                       parallel_ray_loop({}, kDevelopGrain));
            });
        };
        const Film& film = camera().film;
        try {
            return std::make_shared<HostFrame>(film.width, film.height, samples(),
                                               std::async(std::launch::async, std::move(work)).share());
        } catch (const std::system_error&) {
            throw NoThread();
        }
    }

    Image develop() override {
        Image image = arena(settings()).execute([&] {
            return developed(view(), film_exposure_s(), parallel_ray_loop({}, kDevelopGrain));
        });
        image.stats = stats_;
        image.stats.device = name();
        return image;
    }

    double least_lamp_share() const override {
        return realcam::least_lamp_share(scene_->placed().view(), camera_view_, *setup_,
                                         settings().effective_light_tracing());
    }
    std::vector<float> develop_traced() override { return traced_exposure(splats_, film_exposure_s()); }

    std::vector<std::int64_t> count_samples() override { return samples_of(film_); }
    PlacedCamera placed_camera() const override { return {camera_view_, scene_->placed().origin_m()}; }

    std::size_t frames_in_flight() const override { return 1; }

    void raise_stop() noexcept override { stop_.raise(); }
    void lower_stop() noexcept override { stop_.lower(); }
    bool is_stopped() const override { return stop_.flag(); }

    /// Settings of the camera that only its development depends on.
    struct Development {
        double exposure_s, iso;
    };

    /// Returns the film for its development.
    FilmView view() const { return view(camera().film, settings()); }
    FilmView view(const Film& film, const RenderSettings& settings) const {
        return view_of(film_, film.width, film.height, settings, splats_);
    }

    /// Returns an arena with the requested number of threads.
    static tbb::task_arena arena(const RenderSettings& settings) {
        // For more threads than cores, TBB writes a warning to the console and starts only as many as there are cores.
        const int cores = tbb::info::default_concurrency();
        return tbb::task_arena(settings.threads > 0 ? std::min(settings.threads, cores) : cores);
    }

    /// Builds or updates scene_ if the scene or the position of the camera has changed.
    void place(const Assembly& scene, const Camera& camera) {
        const SceneChange change = scene_change(scene_ ? &scene_->placed() : nullptr, scene, camera);
        if (change == SceneChange::none) return;
        std::unique_ptr<EmbreeScene> last = std::exchange(scene_, nullptr);  // discarded if an update fails
        if (change == SceneChange::transforms) {
            last->move(scene, camera.exposure());
            scene_ = std::move(last);
        } else {
            last.reset();  // frees its memory before the next one is built
            scene_ = std::make_unique<EmbreeScene>(device_, scene, position_when_open(camera), camera.exposure(),
                                                   stop_.flag());
        }
    }

    /// Adds samples to the film.
    void expose_film(const SampleRange& range, const PixelCounts& counts, const RenderSettings& settings,
                     std::atomic<std::int64_t>& done) {
        expose(whole_film(), range, counts, settings, done, film_, stats_);
    }

    /// Adds samples of a region's pixels to `film`, which has the pixels of the region. `counts`: of these pixels. Adds
    /// their cost to `stats`.
    void expose(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                const RenderSettings& settings, std::atomic<std::int64_t>& done, FilmSums& film, RenderStats& stats) {
        const PathSettings path = settings.path();
        const bool shares = shares_samples(camera_view_, settings, counts);
        for_tiles(region, range, settings, [&](const realcam_tile& part) {
            realcam_tile tile = part;
            tile.shares = shares;
            const std::vector<std::uint32_t> tile_counts = counts_of(tile, region, counts, range);
            if (!tile_counts.empty() && *std::max_element(tile_counts.begin(), tile_counts.end()) == 0) return;
            tile.counts = tile_counts.empty() ? nullptr : tile_counts.data();
            tile.path_settings = &path;
            tile.adds_squares = settings.layers.has(Layer::variance);
            tile.adds_half = settings.layers.has_any(kHalfLayers);
            tile.adds_excess = balances_wavelengths(settings);
            FilmSums sums(pixels_of(tile));
            tile.sums = sums.data();
            kernels().render_tile(&tile);
            if (shares && is_stopped()) return;  // the sums of an incomplete tile are invalid
            for_pixels(tile, region,
                       [&](std::size_t in_tile, std::size_t in_region) { film[in_region] += sums[in_tile]; });
            done += samples_of_tile(tile);
            count(tile, stats);
        });
    }

    /// Returns the sample counts of a tile's pixels for a part of a range; empty if every pixel takes all samples.
    static std::vector<std::uint32_t> counts_of(const realcam_tile& tile, const FilmRegion& region,
                                                const PixelCounts& counts, const SampleRange& range) {
        if (!counts.counts) return {};
        const SampleRange visit{tile.seed, tile.first_sample, tile.sample_count};
        const PixelCounts remaining = counts.after(visit.first - range.first);
        std::vector<std::uint32_t> tile_counts(pixels_of(tile));
        for_pixels(tile, region, [&](std::size_t in_tile, std::size_t in_region) {
            tile_counts[in_tile] = remaining.of(in_region, visit);
        });
        return tile_counts;
    }

    /// Returns a film without light for each kind of splatted light.
    std::vector<SplatFilm> empty_splats() const {
        std::vector<SplatFilm> films;
        for (const GhostView& light : splatted_lights(*setup_, traced_lights_))
            films.push_back(SplatFilm::empty(light.light, camera_view_.width, camera_view_.height,
                                             settings().layers.has(Layer::variance) ? 2 : 1,
                                             ghost_units_per_lux(scene_->placed().view(), camera_view_, light)));
        return films;
    }

    /// Adds the splatted light that belongs to a range of samples of each pixel to `films`.
    void splat(std::vector<SplatFilm>& films, const SampleRange& range, const RenderSettings& settings) {
        const std::vector<GhostView> lights = splatted_lights(*setup_, traced_lights_);
        for (std::size_t i = 0; i < lights.size(); ++i) splat_on(films[i], lights[i], range, settings);
    }

    /// Adds one kind of splatted light to its film.
    void splat_on(SplatFilm& film, const GhostView& ghosts, const SampleRange& range, const RenderSettings& settings) {
        const SceneView scene = scene_->placed().view();
        const GhostBlocks blocks = ghost_blocks(camera_view_, range, ghosts);
        const PathSettings path = settings.path();
        constexpr std::uint64_t kBlocksPerTask = 64;
        const std::uint64_t count = blocks.end - blocks.first;
        // Cancels the remaining tasks on a stop: with many samples, even tasks that do nothing would take minutes.
        tbb::task_group_context group;
        const auto run_task = [&](std::uint64_t task) {
            if (is_stopped()) {
                group.cancel_group_execution();
                return;
            }
            realcam_ghosts job{};
            job.scene_view = &scene;
            job.camera_view = &camera_view_;
            job.ghost_view = &ghosts;
            job.embree_scene = scene_->handle();
            job.first_block = blocks.first + task * kBlocksPerTask;
            job.block_count = std::min(kBlocksPerTask, count - task * kBlocksPerTask);
            job.seed = range.seed;
            job.path_settings = &path;
            job.units_per_lux = film.units_per_lux;
            job.stopped = &is_raised;
            job.stop = &stop_.flag();
            job.sums = film.sums.data();
            job.films = static_cast<int>(film.blocks.size());
            kernels().splat_ghosts(&job);
            for (std::size_t k = 0; k < film.blocks.size(); ++k) std::atomic_ref(film.blocks[k]) += job.blocks_done[k];
        };
        arena(settings).execute([&] {
            tbb::parallel_for(std::uint64_t{0}, (count + kBlocksPerTask - 1) / kBlocksPerTask, run_task, group);
        });
    }

    /// Calls visit(tile) in parallel for all tiles of a region with the first kSamplesPerSum samples of the range, then
    /// for all tiles with the next samples, and so on, so that progress is even over the picture. The tiles have no
    /// sums; visit sets these.
    template <class Visit>
    void for_tiles(const FilmRegion& region, const SampleRange& range, const RenderSettings& settings, Visit&& visit) {
        const int columns = (region.width + kTileSide - 1) / kTileSide,
                  rows = (region.height + kTileSide - 1) / kTileSide;
        scene_view_ = scene_->placed().view();
        arena(settings).execute([&] {
            for (std::uint32_t first = 0; first < range.count && !is_stopped();) {
                const std::uint32_t count = std::min(kSamplesPerSum, range.count - first);
                tbb::parallel_for(0, columns * rows, [&](int tile) {
                    if (!is_stopped())
                        visit(tile_at(region, tile % columns * kTileSide, tile / columns * kTileSide,
                                      {range.seed, range.first + first, count}));
                });
                first += count;
            }
        });
    }

    /// Returns the tile whose first pixel lies `right` and `down` pixels from that of the region, for a range of
    /// samples.
    realcam_tile tile_at(const FilmRegion& region, int right, int down, const SampleRange& range) const {
        realcam_tile tile{};
        tile.scene_view = &scene_view_;
        tile.camera_view = &camera_view_;
        tile.embree_scene = scene_->handle();
        tile.x = region.column + right;
        tile.y = region.row + down;
        tile.width = std::min(kTileSide, region.width - right);
        tile.height = std::min(kTileSide, region.height - down);
        tile.first_sample = range.first;
        tile.sample_count = range.count;
        tile.seed = range.seed;
        tile.stopped = &is_raised;
        tile.stop = &stop_.flag();
        return tile;
    }

    /// Value of realcam_tile::stopped.
    static int is_raised(const void* stop) { return *static_cast<const std::atomic<bool>*>(stop); }

    static std::size_t pixels_of(const realcam_tile& tile) {
        return static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    }
    static std::int64_t samples_of_tile(const realcam_tile& tile) {
        return static_cast<std::int64_t>(tile.sample_count) * tile.width * tile.height;
    }

    /// Calls f(pixel index in the tile, pixel index in the region) for all pixels of a tile.
    template <class F>
    static void for_pixels(const realcam_tile& tile, const FilmRegion& region, F&& f) {
        for (int row = 0; row < tile.height; ++row)
            for (int column = 0; column < tile.width; ++column)
                f(static_cast<std::size_t>(row * tile.width + column), region.index(tile.x + column, tile.y + row));
    }

    /// Adds the cost of a tile to `stats`.
    void count(const realcam_tile& tile, RenderStats& stats) {
        const std::lock_guard lock(stats_mutex_);
        stats.lens_seconds += tile.lens_seconds;
        stats.scene_seconds += tile.scene_seconds;
        stats.other_seconds += tile.other_seconds;
        stats.sampled_rays += tile.sampled_rays;
        stats.passed_rays += tile.passed_rays;
        stats.scene_rays += tile.scene_rays;
    }

    RTCDevice device_;
    HostStop stop_;  ///< stops the construction of the scene's BVHs, too
    std::unique_ptr<EmbreeScene> scene_;
    LastSetup last_setup_;
    std::shared_ptr<const CameraSetup> setup_;  ///< owns the data that `camera_view_` points to
    TracedLights traced_lights_;
    CameraView camera_view_{};
    std::vector<PixelPupil> known_, found_;  ///< learned pupils, one per pixel (PixelPupils)
    SceneView scene_view_{};  ///< valid during for_tiles
    FilmSums film_;
    std::vector<SplatFilm> splats_;  ///< one per light of splatted_lights
    std::mutex stats_mutex_;
    RenderStats stats_;
};

}  // namespace

std::unique_ptr<Session> make_embree_session() {
    return std::make_unique<EmbreeSession>();
}

}  // namespace realcam
