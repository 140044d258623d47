#include "cuda_session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <utility>

#include "../../camera/camera_setup.hpp"
#include "../../render/film/film_sums.hpp"
#include "../../render/lights/traced_lights.hpp"
#include "../../render/session/adaptive_sampling.hpp"
#include "../../render/session/progress.hpp"
#include "../device/cuda_devices.hpp"
#include "../device/current_device.hpp"
#include "../device/share_array.hpp"
#include "device_frame.hpp"
#include "device_renderer.hpp"
#include "host_scene.hpp"
#include "picture_pool.hpp"

namespace realcam {
namespace {

/// Session on GPUs of this machine. The first one (front) holds the film and takes the splatted light and the layers;
/// all GPUs take samples of the pixels.
class CudaSession final : public Session, public DevicePictures {
public:
    CudaSession(const std::vector<int>& ordinals, PupilTracer tracer) : tracer_(std::move(tracer)) {
        if (cuda_devices().empty()) throw DeviceError(why_no_cuda_device());
        for (const int ordinal : ordinals) {
            name_ += (name_.empty() ? "" : " + ") + cuda_device(ordinal).name;
            renderers_.push_back(make_on_device<DeviceRenderer>(ordinal, ordinal));
            scene_.add(*renderers_.back());
        }
    }
    ~CudaSession() override {
        try {
            cancel();
        } catch (const DeviceError&) {
            // A lost GPU runs no kernels that could be stopped.
        }
    }

    std::string name() const override { return "GPU (" + name_ + ")"; }

    DevicePicture device_picture(const KeepGoing& keep_going) override {
        return with_all_samples(keep_going, [&] { return develop_on_gpu(); });
    }

private:
    void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings, PupilStart start,
                 const KeepGoing& keep_going, OwnStop& stop) override {
        validate_on_gpu(camera);
        setup_ = last_setup_.make(camera, tracer_, settings.lens_effects(), start);
        const auto prepare = [&] { scene_.place(scene, camera, [&] { return !stop; }); };
        if (scene_.change_to(scene, camera) == SceneChange::all) {
            run_interruptibly(prepare, keep_going, stop);
            if (stop) throw Cancelled();
        } else {
            prepare();  // takes less time than starting a thread
        }
        CameraView view = setup_->view(scene_.placed().origin_m(), scene_.placed().moves());
        traced_lights_ =
            traced_lights(scene_.placed().view(), view, *setup_, settings.effective_light_tracing(), tracer_);
        view.traced_lights = traced_lights_.view();
        for (const auto& renderer : renderers_) renderer->set_camera(view);
        set_splats(view);
    }

    bool has_new_pupil() const override { return setup_->has_new_pupil(); }

    /// Sets the sources of splatted light on the first GPU.
    void set_splats(const CameraView& camera) { front().set_splats(splat_sources(camera)); }

    std::vector<SplatSource> splat_sources(const CameraView& camera) const {
        std::vector<SplatSource> sources;
        for (const GhostView& light : splatted_lights(*setup_, traced_lights_))
            sources.push_back({light, ghost_units_per_lux(scene_.placed().view(), camera, light)});
        return sources;
    }

    /// Number of films for each source of splatted light (GhostFilmView).
    int splat_films() const { return settings().layers.has(Layer::variance) ? 2 : 1; }

    void clear() override {
        rows_ = 0;
        film_ = {};
        stats_ = {};
        for (const auto& renderer : renderers_) {
            renderer->clear_counts();
            renderer->forget_pupils(settings().pupil_sampling == PupilSampling::pixel);
        }
        front().clear_splats(width(), height(), splat_films());
    }

    void take_samples(const SampleRange& range, const PixelCounts& counts, bool traces_lights,
                      std::atomic<std::int64_t>& done, OwnStop& stop) override {
        if (rows_ == 0) lay_out_film();
        const auto exposing = std::chrono::steady_clock::now();
        if (settings().pupil_sampling == PupilSampling::pixel) {
            for (const SampleRange& pass : learning_passes(range)) {
                expose_bands(pass, counts.after(pass.first - range.first), stop, done);
                for (const auto& renderer : renderers_) renderer->learn_pupils();
            }
        } else {
            expose_bands(range, counts, stop, done);
        }
        if (traces_lights) front().splat(range, settings().path());
        for (const auto& renderer : renderers_) renderer->wait();
        stats_.seconds += seconds_since(exposing);
    }

    RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                           std::atomic<std::int64_t>& done, OwnStop&) override {
        const auto exposing = std::chrono::steady_clock::now();
        const RenderCounts before = front().counts();
        RegionSums sums{front().sample_region(region, range, settings_of(range), counts), {}};
        set_stats(sums.stats, front().counts() - before, seconds_since(exposing));
        done += static_cast<std::int64_t>(region.pixels()) * range.count;
        return sums;
    }

    std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop&) override {
        CameraView camera = placed_camera().view;
        camera.traced_lights = traced_lights_.view();
        return front().trace_splats(splat_sources(camera), splat_films(), range, settings().path());
    }

    void trace_layers(const FilmRegion& region, const SampleRange& range, std::vector<LayerSum>& film,
                      std::atomic<std::int64_t>& done, OwnStop& stop) override {
        std::vector<LayerSum> sums;
        for_bands(region.row, region.height, stop, [&](int row, int rows) {
            const auto columns = static_cast<std::size_t>(width());
            sums.resize(static_cast<std::size_t>(rows) * columns);
            front().trace_layers({row, rows, range.first, range.count}, range.seed, sums.data(), done);
            for (int r = 0; r < rows; ++r)
                for (int column = region.column; column < region.column + region.width; ++column)
                    film[region.index(column, row + r)] +=
                        sums[static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(column)];
        });
    }

    void trace_pixel_centres(std::vector<PixelCentreSurface>& film, OwnStop& stop) override {
        for_bands(0, height(), stop, [&](int row, int rows) {
            front().trace_pixel_centres({row, rows, 0, 1}, &film[whole_film().index(0, row)]);
        });
    }

    std::vector<LayerImage> develop_auxiliary_layers() override {
        const std::vector<SplatFilm> splats = front().download_splats();
        FilmSums downloaded;
        if (film_fits()) {
            downloaded.resize(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
            front().download_film(downloaded.data());
        }
        return developed_auxiliary_layers(on_host(film_fits() ? downloaded : film_, splats), settings().layers,
                                          film_exposure_s());
    }

    std::shared_ptr<LiveFrame> start_frame(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                           std::shared_ptr<void>) override {
        if (renderers_.size() > 1)
            throw InputError("frames are taken on a single GPU; use device=\"cuda:0\", for example");
        const CurrentDevice current(front().ordinal());
        if (rows_ == 0) {
            front().clear_film(static_cast<std::int64_t>(width()) * height());
            rows_ = height();
        }
        if (!film_fits()) throw DeviceError("the film is larger than the GPU's memory");
        for (const SampleRange& range : ranges) {
            front().add({0, height(), range.first, range.count}, settings_of(range));
            front().splat(range, settings().path());
        }
        const std::shared_ptr<DeviceFrame> frame =
            make_on_device<DeviceFrame>(front().ordinal(), camera().film, samples(), pool_);
        frame->develop(front(), control_variates(), film_exposure_s(), camera().iso, curve);
        return frame;
    }

    Image develop() override {
        Image image;
        if (film_fits()) {
            image.width = width();
            image.height = height();
            const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
            image.exposure = exposures_.acquire(3 * pixels);
            image.depth = depths_.acquire(pixels);
            front().develop(control_variates(), film_exposure_s(), image.exposure.data(), image.depth.data());
        } else {
            const std::vector<SplatFilm> splats = front().download_splats();
            image = developed(on_host(film_, splats), film_exposure_s());
        }
        set_stats(stats_, all_counts(), stats_.seconds);
        image.stats = stats_;
        image.stats.device = name();
        return image;
    }

    double least_lamp_share() const override {
        return realcam::least_lamp_share(scene_.placed().view(),
                                         setup_->view(scene_.placed().origin_m(), scene_.placed().moves()), *setup_,
                                         settings().effective_light_tracing());
    }
    std::vector<float> develop_traced() override {
        return traced_exposure(front().download_splats(), film_exposure_s());
    }

    std::vector<std::int64_t> count_samples() override {
        if (!film_fits()) return samples_of(film_);
        std::vector<std::int64_t> counts(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
        front().count_samples(counts.data());
        return counts;
    }

    PlacedCamera placed_camera() const override {
        const RenderSpaceScene& placed = scene_.placed();
        return {setup_->view(placed.origin_m(), placed.moves()), placed.origin_m()};
    }

    std::size_t frames_in_flight() const override { return 3; }

    void raise_stop() noexcept override {
        for (const auto& renderer : renderers_) renderer->stop_flag().raise();
    }
    void lower_stop() noexcept override {
        for (const auto& renderer : renderers_) {
            try {
                renderer->stop_flag().lower();
            } catch (const DeviceError&) {
                // The next use of a lost GPU reports the error.
            }
        }
    }
    bool is_stopped() const override { return renderers_.front()->stop_flag().is_raised(); }

    DeviceRenderer& front() const { return *renderers_.front(); }
    int width() const { return camera().film.width; }
    int height() const { return camera().film.height; }
    /// True if the first GPU holds the whole film.
    bool film_fits() const { return rows_ == height(); }
    FilmControlVariates control_variates() const { return film_control_variates(settings()); }
    /// Returns a film in host memory for its development.
    FilmView on_host(const FilmSums& film, const std::vector<SplatFilm>& splats) const {
        return view_of(film, width(), height(), settings(), splats);
    }

    /// Render settings for a range of samples, which may have another seed: the seed changes when a low-discrepancy
    /// sequence is exhausted.
    RenderSettings settings_of(const SampleRange& range) const {
        RenderSettings result = settings();
        result.seed = range.seed;
        return result;
    }

    /// Allocates an empty film: on the first GPU, or, if it does not fit, in host memory, to be transferred in bands.
    void lay_out_film() {
        const int rows = make_room();
        const std::int64_t pixels = static_cast<std::int64_t>(width()) * height();
        if (rows == height())
            front().clear_film(pixels);
        else
            film_.assign(static_cast<std::size_t>(pixels), PixelSum{});
        rows_ = rows;
    }

    /// Calls f(first row, row count) for bands of the picture, of about 100 MB of layer data each.
    template <class F>
    void for_bands(int first_row, int row_count, OwnStop& stop, F&& f) {
        constexpr int kPixels = 1 << 20;
        const int max_rows = std::max(1, kPixels / width()), end = first_row + row_count;
        for (int row = first_row; row < end && !stop; row += max_rows) f(row, std::min(max_rows, end - row));
    }

    /// Reserves memory and returns the number of rows that fit into the memory of every GPU.
    int make_room() {
        for (int rows = height();; rows = (rows + 1) / 2) {
            try {
                for (const auto& renderer : renderers_)
                    renderer->reserve_film(static_cast<std::int64_t>(rows) * width(), renderers_.size() > 1);
                return rows;
            } catch (const OutOfDeviceMemory&) {
                if (rows == 1) throw;
            }
        }
    }

    /// Exposes the film band by band; each GPU takes a range of the samples, and the first GPU holds the film. An error
    /// on one GPU stops the others.
    void expose_bands(const SampleRange& range, const PixelCounts& counts, OwnStop& stop,
                      std::atomic<std::int64_t>& done) {
        const std::int64_t columns = width();
        for (int row = 0; row < height() && !stop; row += rows_) {
            const int rows = std::min(rows_, height() - row);
            PixelSum* const band_on_host = film_fits() ? nullptr : film_.data() + row * columns;
            if (band_on_host) front().upload_film(band_on_host, rows * columns);
            const PixelCounts in_band{counts.counts ? counts.counts + row * columns : nullptr, counts.taken};
            expose_band(row, rows, range, in_band, stop, done);
            if (band_on_host) front().download_film(band_on_host);
        }
    }

    /// Exposes some rows, which the first GPU's film holds; the films of the other GPUs are added to it.
    void expose_band(int first_row, int rows, const SampleRange& range, const PixelCounts& counts, OwnStop& stop,
                     std::atomic<std::int64_t>& done) {
        const auto share = [&](std::size_t i) {
            return static_cast<std::uint32_t>(static_cast<std::uint64_t>(range.count) * i / renderers_.size());
        };
        std::vector<std::future<void>> others;
        const auto expose_share = [&](std::size_t i) {
            try {
                DeviceRenderer& renderer = *renderers_[i];
                if (i > 0) renderer.clear_film(static_cast<std::int64_t>(rows) * width());
                renderer.expose({first_row, rows, range.first + share(i), share(i + 1) - share(i)}, settings_of(range),
                                {counts.counts, counts.taken + share(i)}, done);
            } catch (...) {
                stop = true;
                throw;
            }
        };
        for (std::size_t i = 1; i < renderers_.size(); ++i)
            others.push_back(std::async(std::launch::async, expose_share, i));
        expose_share(0);
        for (std::future<void>& other : others) other.get();
        for (std::size_t i = 1; i < renderers_.size(); ++i) front().merge_film(*renderers_[i]);
    }

    /// Develops the film in the memory of the first GPU.
    DevicePicture develop_on_gpu() {
        if (!film_fits()) throw DeviceError("the film is larger than the GPU's memory");
        const CurrentDevice current(front().ordinal());
        const std::int64_t columns = width(), rows = height();
        DeviceArray<float> exposure(static_cast<std::size_t>(3 * columns * rows)),
            depth(static_cast<std::size_t>(columns * rows));
        front().develop_on_gpu(control_variates(), film_exposure_s(), exposure.data(), depth.data());
        int stopped = 0;
        front().stop_flag().download(&stopped, front().stream());
        front().wait();
        if (stopped) throw Cancelled();
        return {share(std::move(exposure), front().ordinal(), {rows, columns, 3}),
                share(std::move(depth), front().ordinal(), {rows, columns})};
    }

    /// Counts of all GPUs since the film was cleared.
    RenderCounts all_counts() const {
        RenderCounts sum{};
        for (const auto& renderer : renderers_) sum += renderer->counts();
        return sum;
    }

    /// Sets the cost of samples from counters. `seconds`: of the wall clock, which the stages share by their clock
    /// cycles.
    static void set_stats(RenderStats& stats, const RenderCounts& counts, double seconds) {
        stats.seconds = seconds;
        stats.sampled_rays = counts.sampled_rays;
        stats.passed_rays = counts.passed_rays;
        stats.scene_rays = counts.scene_rays;
        const double per_clock = counts.all_clocks > 0 ? seconds / static_cast<double>(counts.all_clocks) : 0;
        stats.lens_seconds = per_clock * static_cast<double>(counts.lens_clocks);
        stats.scene_seconds = per_clock * static_cast<double>(counts.scene_clocks);
        stats.other_seconds = seconds - stats.lens_seconds - stats.scene_seconds;
    }

    PupilTracer tracer_;
    std::string name_;
    std::vector<OnDevice<DeviceRenderer>> renderers_;
    FramePool pool_;
    PicturePool exposures_, depths_;
    LastSetup last_setup_;
    std::shared_ptr<const CameraSetup> setup_;
    TracedLights traced_lights_;
    HostScene scene_;
    int rows_ = 0;  ///< rows of the film that a GPU holds at a time; 0: the film is not allocated yet
    FilmSums film_;  ///< the whole film if a GPU holds only a part of it
    RenderStats stats_;  ///< `seconds` accumulates the exposure time until the picture is developed
};

}  // namespace

std::unique_ptr<Session> make_cuda_session(const std::vector<int>& ordinals, PupilTracer tracer) {
    return std::make_unique<CudaSession>(ordinals, std::move(tracer));
}

}  // namespace realcam
