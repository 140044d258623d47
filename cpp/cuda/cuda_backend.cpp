#include "cuda_backend.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>

#include "../camera/last_setup.hpp"
#include "../render/run_with_progress.hpp"
#include "../render/seconds_since.hpp"
#include "cuda_devices.hpp"
#include "device_renderer.hpp"
#include "host_scene.hpp"
#include "on_device.hpp"

namespace realcam {
namespace {

using Renderers = std::vector<OnDevice<DeviceRenderer>>;

/// Whether a picture is to end early; told to all GPUs that take it.
class PictureStop {
public:
    explicit PictureStop(const Renderers& renderers) : renderers_(renderers) {}
    ~PictureStop() {
        if (!stopped_) return;
        for (const auto& renderer : renderers_) {
            try {
                renderer->stop_flag().lower();
            } catch (const DeviceError&) {
                // A GPU that is lost says so to whoever uses it next.
            }
        }
    }
    PictureStop(const PictureStop&) = delete;
    PictureStop& operator=(const PictureStop&) = delete;

    void operator=(bool) {
        if (stopped_.exchange(true)) return;
        for (const auto& renderer : renderers_) renderer->stop_flag().raise();
    }
    operator bool() const { return stopped_; }

private:
    const Renderers& renderers_;
    std::atomic<bool> stopped_{false};
};

class CudaBackend final : public Backend {
public:
    CudaBackend(const std::vector<int>& ordinals, PupilTracer tracer) : tracer_(std::move(tracer)) {
        if (cuda_devices().empty()) throw DeviceError(why_no_cuda_device());
        for (const int ordinal : ordinals) {
            name_ += (name_.empty() ? "" : " + ") + cuda_device(ordinal).name;
            renderers_.push_back(make_on_device<DeviceRenderer>(ordinal, ordinal));
            scene_.add(*renderers_.back());
        }
    }

    std::string name() const override { return "GPU (" + name_ + ")"; }

    Image render(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                 const Progress& progress) override {
        const auto start = std::chrono::steady_clock::now();
        validate(settings);
        validate(scene);
        const std::shared_ptr<const CameraSetup> setup = last_setup_.make(camera, tracer_);
        scene_.place(scene, camera);
        const CameraView view = setup->view(scene_.origin_m());
        for (const auto& renderer : renderers_) renderer->set_camera(view);

        Image image;
        image.width = camera.film.width;
        image.height = camera.film.height;
        image.spp = settings.spp;
        image.stats.setup_seconds = seconds_since(start);
        const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
        image.exposure.resize(3 * pixels);
        image.depth.resize(pixels);
        const auto exposing = std::chrono::steady_clock::now();
        expose(settings, camera.exposure_time_s, progress, image);
        collect_counts(seconds_since(exposing), image.stats);
        image.stats.device = name();
        image.stats.seconds = seconds_since(start);
        return image;
    }

private:
    void expose(const RenderSettings& settings, double exposure_time_s, const Progress& progress, Image& image) {
        PictureStop stop(renderers_);
        std::atomic<std::int64_t> done{0};
        const double total = static_cast<double>(settings.spp) * image.width * image.height;
        const auto work = [&] {
            int rows = make_room(image);
            for (int row = 0; row < image.height && !stop; row += rows) {
                rows = std::min(rows, image.height - row);
                expose_band(row, rows, image.width, settings, stop, done);
                const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width);
                if (!stop)
                    renderers_.front()->develop(settings.spp, exposure_time_s, image.exposure.data() + 3 * first,
                                                image.depth.data() + first);
            }
        };
        run_with_progress(work, [&] { return static_cast<double>(done) / total; }, progress, stop);
        if (stop) throw Cancelled();
    }

    /// How many rows of the picture fit into every GPU's memory at once.
    int make_room(const Image& image) {
        for (int rows = image.height;; rows = (rows + 1) / 2) {
            try {
                for (const auto& renderer : renderers_)
                    renderer->reserve_film(static_cast<std::int64_t>(rows) * image.width, renderers_.size() > 1);
                return rows;
            } catch (const OutOfDeviceMemory&) {
                if (rows == 1) throw;
            }
        }
    }

    /// All samples of some rows: each GPU takes a range of them. One that fails stops the others.
    void expose_band(int first_row, int rows, int columns, const RenderSettings& settings, PictureStop& stop,
                     std::atomic<std::int64_t>& done) {
        const auto share = [&](std::size_t i) {
            return static_cast<std::uint32_t>(static_cast<std::uint64_t>(settings.spp) * i / renderers_.size());
        };
        std::vector<std::future<void>> others;
        const auto expose_share = [&](std::size_t i) {
            try {
                DeviceRenderer& renderer = *renderers_[i];
                renderer.clear_film(static_cast<std::int64_t>(rows) * columns);
                renderer.expose({first_row, rows, share(i), share(i + 1) - share(i)}, settings, done);
            } catch (...) {
                stop = true;
                throw;
            }
        };
        for (std::size_t i = 1; i < renderers_.size(); ++i)
            others.push_back(std::async(std::launch::async, expose_share, i));
        expose_share(0);
        for (std::future<void>& other : others) other.get();
        for (std::size_t i = 1; i < renderers_.size() && !stop; ++i) renderers_.front()->merge_film(*renderers_[i]);
    }

    void collect_counts(double seconds, RenderStats& stats) {
        RenderCounts sum{};
        for (const auto& renderer : renderers_) {
            const RenderCounts counts = renderer->take_counts();
            sum.sampled_rays += counts.sampled_rays;
            sum.passed_rays += counts.passed_rays;
            sum.scene_rays += counts.scene_rays;
            sum.lens_clocks += counts.lens_clocks;
            sum.scene_clocks += counts.scene_clocks;
            sum.all_clocks += counts.all_clocks;
        }
        stats.sampled_rays = sum.sampled_rays;
        stats.passed_rays = sum.passed_rays;
        stats.scene_rays = sum.scene_rays;
        const double per_clock = sum.all_clocks > 0 ? seconds / static_cast<double>(sum.all_clocks) : 0;
        stats.lens_seconds = per_clock * static_cast<double>(sum.lens_clocks);
        stats.scene_seconds = per_clock * static_cast<double>(sum.scene_clocks);
        stats.other_seconds = seconds - stats.lens_seconds - stats.scene_seconds;
    }

    PupilTracer tracer_;
    std::string name_;
    Renderers renderers_;
    LastSetup last_setup_;
    HostScene scene_;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const std::vector<int>& ordinals, PupilTracer tracer) {
    return std::make_unique<CudaBackend>(ordinals, std::move(tracer));
}

}  // namespace realcam
