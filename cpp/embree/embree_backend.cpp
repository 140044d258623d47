#include "embree_backend.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <chrono>
#include <mutex>

#include "../camera/last_setup.hpp"
#include "../render/pixel_sum.hpp"
#include "../render/run_with_progress.hpp"
#include "../render/scene_change.hpp"
#include "../render/seconds_since.hpp"
#include "embree_scene.hpp"
#include "kernels.hpp"

namespace realcam {
namespace {

constexpr int kTileSide = 32;
/// Samples per pixel after which a tile is left and the next begins, so that the share done grows everywhere.
constexpr std::uint32_t kSamplesPerVisit = 256;

/// The film while it is exposed.
struct ExposingFilm {
    int width, height;
    std::vector<PixelSum> sums;

    ExposingFilm(int w, int h) : width(w), height(h), sums(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

    Image develop(int spp, double exposure_time_s) const {
        Image image;
        image.width = width;
        image.height = height;
        image.spp = spp;
        image.exposure.reserve(3 * sums.size());
        image.depth.reserve(sums.size());
        for (const PixelSum& sum : sums) {
            for (int channel = 0; channel < 3; ++channel)
                image.exposure.push_back(sum.exposure(channel, exposure_time_s, spp));
            image.depth.push_back(sum.mean_depth());
        }
        return image;
    }
};

DeviceError rtc_error(RTCError code) {
    const std::string text = "Embree could not be started: ";
    return DeviceError(text + (code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error " + std::to_string(code)));
}

class EmbreeBackend final : public Backend {
public:
    EmbreeBackend() : device_(rtcNewDevice(nullptr)) {
        if (!device_) throw rtc_error(rtcGetDeviceError(nullptr));
        kernels();
    }
    ~EmbreeBackend() override {
        scene_.reset();
        rtcReleaseDevice(device_);
    }

    std::string name() const override {
        const auto version = rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION);
        return "CPU (Embree " + std::to_string(version / 10000) + '.' + std::to_string(version / 100 % 100) +
               ", x86-64-" + kernels().instruction_set + ", " +
               std::to_string(tbb::this_task_arena::max_concurrency()) + " threads)";
    }

    Image render(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                 const Progress& progress) override {
        const auto start = std::chrono::steady_clock::now();
        validate(settings);
        validate(scene);
        stop_ = false;
        std::atomic<std::int64_t> done{0};
        const double total = static_cast<double>(settings.spp) * camera.film.width * camera.film.height;
        Image image;
        run_with_progress([&] { image = take(scene, camera, settings, done); },
                          [&] { return static_cast<double>(done) / total; }, progress, stop_);
        if (stop_) throw Cancelled();
        image.stats.device = name();
        image.stats.seconds = seconds_since(start);
        return image;
    }

private:
    Image take(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
               std::atomic<std::int64_t>& done) {
        const auto start = std::chrono::steady_clock::now();
        tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
        const auto setup = arena.execute([&] { return last_setup_.make(camera, fast_pupil_tracer()); });
        arena.execute([&] { place(scene, camera); });
        const SceneView scene_view = scene_->placed().view();
        const CameraView camera_view = setup->view(scene_->placed().origin_m());
        ExposingFilm film(camera.film.width, camera.film.height);
        RenderStats stats;
        stats.setup_seconds = seconds_since(start);
        arena.execute([&] { expose(scene_view, camera_view, settings, done, film, stats); });
        if (stop_) return {};
        Image image = film.develop(settings.spp, camera.exposure_time_s);
        image.stats = stats;
        return image;
    }

    void place(const Assembly& scene, const Camera& camera) {
        const SceneChange change = scene_change(scene_ ? &scene_->placed() : nullptr, scene, camera);
        if (change == SceneChange::none) return;
        std::unique_ptr<EmbreeScene> last = std::exchange(scene_, nullptr);  // what fails is not kept
        if (change == SceneChange::transforms) {
            last->move(scene);
            scene_ = std::move(last);
        } else {
            last.reset();  // before the next takes as much memory
            scene_ = std::make_unique<EmbreeScene>(device_, scene, camera.pose.position_m, stop_);
        }
    }

    void expose(const SceneView& scene_view, const CameraView& camera_view, const RenderSettings& settings,
                std::atomic<std::int64_t>& done, ExposingFilm& film, RenderStats& stats) {
        const int columns = (film.width + kTileSide - 1) / kTileSide, rows = (film.height + kTileSide - 1) / kTileSide;
        std::mutex stats_mutex;
        const auto visit = [&](int index, std::uint32_t first, std::uint32_t count) {
            if (stop_) return;
            realcam_tile tile{};
            tile.scene_view = &scene_view;
            tile.camera_view = &camera_view;
            tile.embree_scene = scene_->handle();
            tile.x = index % columns * kTileSide;
            tile.y = index / columns * kTileSide;
            tile.width = std::min(kTileSide, film.width - tile.x);
            tile.height = std::min(kTileSide, film.height - tile.y);
            tile.first_sample = first;
            tile.sample_count = count;
            tile.seed = settings.seed;
            tile.max_bounces = settings.max_bounces;
            tile.stopped = [](const void* stop) -> int { return *static_cast<const std::atomic<bool>*>(stop); };
            tile.stop = &stop_;
            std::vector<PixelSum> sums(static_cast<std::size_t>(tile.width * tile.height));
            tile.sums = sums.data();
            kernels().render_tile(&tile);
            for (int y = 0; y < tile.height; ++y)
                for (int x = 0; x < tile.width; ++x)
                    film.sums[static_cast<std::size_t>(tile.y + y) * static_cast<std::size_t>(film.width) +
                              static_cast<std::size_t>(tile.x + x)] +=
                        sums[static_cast<std::size_t>(y * tile.width + x)];
            done += static_cast<std::int64_t>(count) * tile.width * tile.height;
            const std::lock_guard lock(stats_mutex);
            stats.lens_seconds += tile.lens_seconds;
            stats.scene_seconds += tile.scene_seconds;
            stats.other_seconds += tile.other_seconds;
            stats.sampled_rays += tile.sampled_rays;
            stats.passed_rays += tile.passed_rays;
            stats.scene_rays += tile.scene_rays;
        };
        const auto all = static_cast<std::uint32_t>(settings.spp);
        for (std::uint32_t first = 0; first < all && !stop_; first += kSamplesPerVisit)
            tbb::parallel_for(0, columns * rows,
                              [&](int tile) { visit(tile, first, std::min(kSamplesPerVisit, all - first)); });
    }

    RTCDevice device_;
    std::atomic<bool> stop_{
        false};  ///< of the picture under way; the scene's hierarchies look at it while they are built
    std::unique_ptr<EmbreeScene> scene_;
    LastSetup last_setup_;
};

}  // namespace

std::unique_ptr<Backend> make_embree_backend() {
    return std::make_unique<EmbreeBackend>();
}

PupilTracer fast_pupil_tracer() {
    const auto trace = kernels().trace_block;
    return {[trace](const LensView<float>& view, PupilTracer::Rays& rays) { trace(&view, &rays); },
            [](int count, const PupilTracer::Task& task) {
                tbb::parallel_for(
                    tbb::blocked_range<int>(0, count, 1),
                    [&](const tbb::blocked_range<int>& range) {
                        for (int i = range.begin(); i < range.end(); ++i) task(i);
                    },
                    tbb::simple_partitioner());
            }};
}

}  // namespace realcam
