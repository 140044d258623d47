#pragma once
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../scene/scene_checks.hpp"
#include "adaptive_sampling.hpp"
#include "image.hpp"
#include "layer_film.hpp"
#include "left_out_motion.hpp"
#include "live_frame.hpp"
#include "motion_vectors.hpp"
#include "render_settings.hpp"
#include "run_with_progress.hpp"
#include "sample_range.hpp"
#include "seconds_since.hpp"

namespace REALCAM_NAMESPACE {

/// The number of samples of each pixel, row by row.
struct SampleCounts {
    int width, height;
    std::vector<std::int64_t> counts;
};

/// What becomes of the samples that were taken before a stop.
enum class Collected { keep, drop };

/// One picture on a device, which collects samples for as long as scene, camera and settings stay the same. Of what
/// changes from one `set` to the next, only that is prepared again.
///
/// Threads take turns: a call waits for that of another thread, but for `cancel`, which ends it. All functions throw
/// DeviceError; after one the next `set` prepares everything anew. `keep_going` and `progress` are asked some 20 times
/// a second on the calling thread, and what they throw comes out.
class Session {
public:
    Session() = default;
    virtual ~Session() = default;
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// The device, for people.
    virtual std::string name() const = 0;

    /// Throws InputError and SceneFileError for a scene that makes no picture, and Cancelled.
    void check(const Assembly& scene, const KeepGoing& keep_going = {}) {
        const Turn turn(mutex_, keep_going);
        checks_.check(scene, {}, keep_going);
    }

    /// What is photographed from now on. A scene with other parts or transforms, a camera with another lens, film,
    /// model or pose, another seed or number of bounces begin a new picture, and where something moves another time of
    /// exposure, too; else exposure time and ISO only develop it anew. Throws InputError for what makes no picture, and
    /// Cancelled.
    void set(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
             const KeepGoing& keep_going = {}) {
        const Turn turn(mutex_, keep_going);
        check_all(scene, camera, settings, keep_going);
        make_way(keep_going);
        make_ready(scene, camera, settings, keep_going);
    }

    /// Gives up all samples.
    void restart(const KeepGoing& keep_going = {}) {
        const Turn turn(mutex_, keep_going);
        make_way(keep_going);
        give_up_samples();
    }

    /// Takes so many samples more of each pixel, and returns when they are there. Throws InputError where nothing is
    /// set, and Cancelled: what was taken until then stays, so that pixels may differ in their number of samples.
    void add(int spp, const Progress& progress = {}) {
        validate_spp(spp);
        const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
        const Turn turn(mutex_, keep_going);
        if (!ready_) throw InputError("nothing is set that could be photographed; set() prepares it");
        make_way(keep_going);
        OwnStop stop(*this);
        std::atomic<std::int64_t> done{0};
        const double total = static_cast<double>(spp) * camera_.film.width * camera_.film.height *
                             (settings_.layers.has_any(kSampledLayers) ? 2 : 1);
        const auto work = [&] {
            expose(spp, [&](const SampleRange& range) { take(range, {}, done, stop); });
            mean_samples_ += spp;
            see_what_is_missing(done, stop);
        };
        const auto begin = std::chrono::steady_clock::now();
        // Layers may have to catch up with more samples than these.
        run_with_progress(work, [&] { return std::min(1.0, static_cast<double>(done) / total); }, progress, stop);
        exposing_seconds_ += seconds_since(begin);
        if (stop) throw Cancelled();
    }

    /// Takes samples of the pixels that are noisier than wanted, until none is (see AdaptiveSampling). Throws
    /// InputError where nothing is set, and Cancelled: what was taken until then stays.
    ReachedNoise add_until(const NoiseGoal& goal, const Progress& progress = {}) {
        validate(goal);
        const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
        const Turn turn(mutex_, keep_going);
        if (!ready_) throw InputError("nothing is set that could be photographed; set() prepares it");
        settle(keep_going);
        OwnStop stop(*this);
        std::atomic<double> share{0};
        ReachedNoise reached;
        const auto work = [&] {
            reached = take_until(goal, share, stop);
            std::atomic<std::int64_t> done{0};
            see_what_is_missing(done, stop);
        };
        const auto begin = std::chrono::steady_clock::now();
        run_with_progress(work, [&] { return share.load(); }, progress, stop);
        exposing_seconds_ += seconds_since(begin);
        if (stop) throw Cancelled();
        return reached;
    }

    /// `set`, and starts to take settings.spp samples more of each pixel and to develop them; returns while that goes
    /// on. The next frame may be shot before this one is there: where the device has as many under way as it takes,
    /// this waits for the oldest. `under_way`: kept by what works on the host until that has ended.
    std::shared_ptr<const LiveFrame> shoot(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                           ToneCurve curve, const KeepGoing& keep_going = {},
                                           std::shared_ptr<void> under_way = {}) {
        const Turn turn(mutex_, keep_going);
        check_all(scene, camera, settings, keep_going);
        make_way(keep_going);
        make_ready(scene, camera, settings, keep_going);
        std::vector<SampleRange> ranges;
        expose(settings.spp, [&](const SampleRange& range) { ranges.push_back(range); });
        mean_samples_ += settings.spp;
        try {
            frames_.push_back(start(ranges, curve, std::move(under_way)));
        } catch (...) {
            ready_ = false;
            throw;
        }
        return frames_.back();
    }

    /// All that was collected, developed with the camera's exposure time, and the layers of the settings; waits for
    /// frames under way. Throws InputError where there is nothing, and Cancelled where another thread stops it
    /// meanwhile.
    Image picture(const KeepGoing& keep_going = {}) {
        return of_all_collected(keep_going, [&] {
            if (lacks_layers()) {
                OwnStop stop(*this);
                std::atomic<std::int64_t> done{0};
                run_heeding([&] { see_what_is_missing(done, stop); }, keep_going, stop);
                if (stop) throw Cancelled();
            }
            Image image = develop();
            add_layers(image);
            image.spp = mean_samples_ == samples_ ? samples_ : mean_of(count_samples());
            image.stats.setup_seconds = setup_seconds_;
            image.stats.seconds = setup_seconds_ + exposing_seconds_;
            return image;
        });
    }

    /// Of the film that is set; waits for frames under way.
    SampleCounts sample_counts(const KeepGoing& keep_going = {}) {
        const Turn turn(mutex_, keep_going);
        settle(keep_going);
        const auto [width, height] = std::pair(camera_.film.width, camera_.film.height);
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        return {width, height, ready_ && !is_blank_ ? count_samples() : std::vector<std::int64_t>(pixels)};
    }

    /// Ends what is under way, from any thread: frames and other threads' calls throw Cancelled. No sample is begun any
    /// more, so that it takes the time of one.
    void cancel(Collected collected = Collected::keep) {
        raise_stop();
        const std::unique_lock lock(mutex_);
        const LowerStop lower{*this};
        settle({});
        if (collected == Collected::drop) give_up_samples();
    }

protected:
    /// What this call itself has asked to stop, and takes back at its end. As a bool: whether anybody has.
    class OwnStop {
    public:
        explicit OwnStop(Session& session) : session_(session) {}
        ~OwnStop() {
            if (raised_) session_.lower_stop();
        }
        OwnStop(const OwnStop&) = delete;
        OwnStop& operator=(const OwnStop&) = delete;

        void operator=(bool) {
            if (!raised_.exchange(true)) session_.raise_stop();
        }
        operator bool() const { return session_.is_stopped(); }

    private:
        Session& session_;
        std::atomic<bool> raised_{false};
    };

    // What a device does. But for the three of the stop, they are called in turn, with fewer frames under way than
    // frames_in_flight().

    /// Makes ready what follows. Scene, camera and settings are valid, and the film is given up. Throws Cancelled where
    /// the stop, which `keep_going` may ask for, has left something undone.
    virtual void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                         const KeepGoing& keep_going, OwnStop& stop) = 0;
    /// An empty film, and nothing counted.
    virtual void clear() = 0;
    /// Takes samples of the pixels, or fewer of some where it is stopped. `done` counts them, at least about.
    virtual void take(const SampleRange& range, const PixelCounts& counts, std::atomic<std::int64_t>& done,
                      OwnStop& stop) = 0;
    /// Starts to take samples, and to develop what is there then.
    virtual std::shared_ptr<LiveFrame> start(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                             std::shared_ptr<void> under_way) = 0;
    virtual Image develop() = 0;
    /// Layer::variance of a film whose samples were taken while the settings asked for it.
    virtual LayerImage develop_variance() = 0;
    /// Adds what the samples of all pixels see first to the film; ends early where it is stopped. `done` counts them.
    virtual void see_layers(const SampleRange& range, std::vector<LayerSum>& film, std::atomic<std::int64_t>& done,
                            OwnStop& stop) = 0;
    /// The surface in the middle ray of each pixel; ends early where it is stopped.
    virtual void see_middle_surfaces(std::vector<MiddleSurface>& film, OwnStop& stop) = 0;
    virtual std::vector<std::int64_t> count_samples() = 0;
    /// The camera in the placed scene, with arrays on the host.
    struct PlacedCamera {
        CameraView view;
        Vec3d origin_m;
    };
    virtual PlacedCamera placed_camera() const = 0;
    virtual std::size_t frames_in_flight() const = 0;

    /// From any thread. A stop stands until it was lowered as often as it was raised.
    virtual void raise_stop() noexcept = 0;
    virtual void lower_stop() noexcept = 0;
    virtual bool is_stopped() const = 0;

    /// f() of a film on which all is collected. Throws as `picture`.
    template <class F>
    auto of_all_collected(const KeepGoing& keep_going, F&& f) -> decltype(f()) {
        const Turn turn(mutex_, keep_going);
        settle(keep_going);
        if (is_stopped()) throw Cancelled();
        if (!ready_ || is_blank_) throw InputError("there is no picture yet; samples have to be taken first");
        return f();
    }

    const Camera& camera() const { return camera_; }
    const RenderSettings& settings() const { return settings_; }
    std::int64_t samples() const { return samples_; }  ///< of the pixel that has most, since the film was empty

private:
    /// Held by one thread at a time.
    class Turn {
    public:
        Turn(std::timed_mutex& mutex, const KeepGoing& keep_going) : lock_(mutex, std::defer_lock) {
            while (!lock_.try_lock_for(std::chrono::milliseconds(50)))
                if (keep_going && !keep_going()) throw Cancelled();
        }

    private:
        std::unique_lock<std::timed_mutex> lock_;
    };

    struct LowerStop {
        Session& session;
        ~LowerStop() { session.lower_stop(); }
    };

    void check_all(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const KeepGoing& keep_going) {
        validate(settings);
        validate(camera);
        validate_effects(settings, camera);
        checks_.check(scene, {}, keep_going);
    }

    void make_way(const KeepGoing& keep_going) {
        while (frames_.size() >= frames_in_flight()) wait_for_oldest(keep_going);
    }
    void settle(const KeepGoing& keep_going) {
        while (!frames_.empty()) wait_for_oldest(keep_going);
    }
    void wait_for_oldest(const KeepGoing& keep_going) {
        wait(*frames_.front(), keep_going);
        frames_.pop_front();
    }

    /// Where nothing moves it does not matter when the shutter is open.
    bool is_same_exposure(const Assembly& scene, const Camera& camera) const {
        return camera.motion == camera_.motion &&
               ((!scene.moves() && !camera.moves()) ||
                (camera.shutter == camera_.shutter && camera.exposure_time_s == camera_.exposure_time_s));
    }

    bool is_same_picture(const Assembly& scene, const Camera& camera, const RenderSettings& settings) const {
        return same_parts(scene, scene_) && same_transforms(scene, scene_) && camera.lens == camera_.lens &&
               camera.film == camera_.film && camera.pose == camera_.pose && camera.model == camera_.model &&
               is_same_exposure(scene, camera) && settings.seed == settings_.seed &&
               settings.path() == settings_.path() && settings.effects == settings_.effects &&
               settings.illuminant == settings_.illuminant &&
               (settings_.layers.has(Layer::variance) || !settings.layers.has(Layer::variance));
    }

    void make_ready(const Assembly& wanted_scene, const Camera& wanted_camera, const RenderSettings& settings,
                    const KeepGoing& keep_going) {
        const auto changed = without_left_out_motion(wanted_scene, wanted_camera, settings.effects);
        const Assembly& scene = changed ? changed->scene : wanted_scene;
        const Camera& camera = changed ? changed->camera : wanted_camera;
        if (!ready_ || !is_same_picture(scene, camera, settings)) {
            ready_ = false;  // whatever fails from here on, the next call begins anew
            give_up_samples();
            scene_ = {};  // before the next takes as much memory
            OwnStop stop(*this);
            const auto begin = std::chrono::steady_clock::now();
            prepare(scene, camera, settings, keep_going, stop);
            setup_seconds_ = seconds_since(begin);
            scene_ = scene;
            ready_ = true;
        }
        camera_ = camera;
        settings_ = settings;
    }

    void give_up_samples() {
        samples_ = mean_samples_ = 0;
        exposing_seconds_ = 0;
        is_blank_ = true;
        forget_layers();
    }

    static std::int64_t mean_of(const std::vector<std::int64_t>& counts) {
        double sum = 0;
        for (const std::int64_t count : counts) sum += static_cast<double>(count);
        return std::llround(sum / static_cast<double>(counts.size()));
    }

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(camera_.film.width) * static_cast<std::size_t>(camera_.film.height);
    }

    void forget_layers() {
        layer_film_ = {};
        layer_samples_ = 0;
    }

    bool lacks_layers() const {
        return (settings_.layers.has_any(kSampledLayers) && layer_samples_ < mean_samples_) ||
               (settings_.layers.has_any(kMiddleLayers) && layer_film_.middle.empty());
    }

    /// Brings the layers that are wanted up to the samples of the picture. Where it is stopped they begin anew.
    void see_what_is_missing(std::atomic<std::int64_t>& done, OwnStop& stop) {
        if (!lacks_layers() || stop) return;
        try {
            if (settings_.layers.has_any(kMiddleLayers) && layer_film_.middle.empty()) {
                layer_film_.middle.resize(pixel_count());
                see_middle_surfaces(layer_film_.middle, stop);
            }
            if (settings_.layers.has_any(kSampledLayers)) {
                layer_film_.sums.resize(pixel_count());
                while (layer_samples_ < mean_samples_ && !stop) {
                    const SampleRange range = next_samples(settings_.seed, layer_samples_, mean_samples_);
                    layer_samples_ += range.count;
                    see_layers(range, layer_film_.sums, done, stop);
                }
            }
        } catch (...) {
            forget_layers();
            ready_ = false;
            throw;
        }
        if (stop) forget_layers();
    }

    void add_layers(Image& image) {
        const LayerSet wanted = settings_.layers;
        if (wanted.has_any(kSampledLayers) || wanted.has_any(kMiddleLayers)) {
            const SurfaceIds ids(scene_);
            image.layers = developed(layer_film_, wanted, ids);
            if (wanted.has(Layer::motion)) {
                const PlacedCamera placed = placed_camera();
                image.layers.push_back(
                    motion_vectors(layer_film_.middle, scene_, camera_, placed.view, placed.origin_m));
            }
            if (wanted.has(Layer::object_id)) image.object_names = ids.object_names();
            if (wanted.has(Layer::material_id)) image.material_names = ids.names_of_materials();
        }
        if (wanted.has(Layer::variance)) image.layers.push_back(develop_variance());
        if (wanted.has(Layer::sample_count)) {
            constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
            LayerImage counts{Layer::sample_count, {}, {}};
            for (const std::int64_t count : count_samples())
                counts.numbers.push_back(static_cast<std::uint32_t>(std::min(count, kMost)));
            image.layers.push_back(std::move(counts));
        }
        std::sort(image.layers.begin(), image.layers.end(),
                  [](const LayerImage& a, const LayerImage& b) { return a.layer < b.layer; });
    }

    ReachedNoise take_until(const NoiseGoal& goal, std::atomic<double>& share, OwnStop& stop) {
        // Fewer would tell nothing of how noisy they are; more would be too many where all is even.
        constexpr std::int64_t kFirst = 8;
        const auto begin = std::chrono::steady_clock::now();
        std::atomic<std::int64_t> done{0};
        const auto take_round = [&](std::int64_t count, const std::uint32_t* counts) {
            std::uint32_t before = 0;
            expose(count, [&](const SampleRange& range) {
                take(range, {counts, before}, done, stop);
                before += range.count;
            });
        };
        const bool is_new = is_blank_;
        if (is_new) {
            mean_samples_ = std::min(kFirst, goal.most_samples / 2);
            take_round(mean_samples_, nullptr);
        }
        AdaptiveSampling tiles(camera_.film.width, camera_.film.height, goal, camera_.iso, develop().exposure,
                               count_samples());
        const auto pixels = static_cast<double>(pixel_count());
        double taken = is_new ? static_cast<double>(mean_samples_) * pixels : 0;
        while (!stop) {
            double affordable = kInfinity;
            if (std::isfinite(goal.seconds)) {
                const double spent = seconds_since(begin);
                affordable = taken > 0 ? taken / spent * (goal.seconds - spent) : kFirst * pixels;
            }
            const std::vector<std::uint32_t> counts = tiles.next(affordable);
            const std::uint32_t most = *std::max_element(counts.begin(), counts.end());
            if (most == 0) break;
            take_round(most, counts.data());
            double round = 0;
            for (const std::uint32_t count : counts) round += count;
            mean_samples_ += static_cast<std::int64_t>(std::ceil(round / pixels));
            taken += round;
            tiles.add(develop().exposure, counts);
            share = std::max(share.load(), std::min(1.0, taken / (taken + tiles.left())));
        }
        return tiles.reached();
    }

    /// f(range) for the ranges of so many samples more.
    template <class F>
    void expose(std::int64_t spp, F&& f) {
        try {
            if (is_blank_) clear();
            is_blank_ = false;
            for (const std::int64_t end = samples_ + spp; samples_ < end;) {
                const SampleRange range = next_samples(settings_.seed, samples_, end);
                samples_ += range.count;
                f(range);
            }
        } catch (...) {
            ready_ = false;
            throw;
        }
    }

    std::timed_mutex mutex_;
    SceneChecks checks_;
    bool ready_ = false;  ///< for what follows:
    Assembly scene_;
    Camera camera_;
    RenderSettings settings_;
    std::int64_t samples_ = 0;  ///< of the pixel that has most: the place in the random sequence
    std::int64_t mean_samples_ = 0;  ///< of all pixels, rounded up
    bool is_blank_ = true;  ///< no sample was begun
    LayerFilm layer_film_;
    std::int64_t layer_samples_ = 0;  ///< of mean_samples_, those that layer_film_.sums holds
    double setup_seconds_ = 0, exposing_seconds_ = 0;  ///< of the picture
    std::deque<std::shared_ptr<const LiveFrame>> frames_;  ///< under way
};

}  // namespace REALCAM_NAMESPACE
