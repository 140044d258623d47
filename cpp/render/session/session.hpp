#pragma once
#include <atomic>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "../../camera/effects/dispersion/dispersion_view.hpp"
#include "../../camera/film/camera.hpp"
#include "../../camera/film/develop.hpp"
#include "../../scene/scene_checks.hpp"
#include "../film/film_sums.hpp"
#include "../film/image.hpp"
#include "../layers/layer_film.hpp"
#include "../path/sample_range.hpp"
#include "../settings/render_settings.hpp"
#include "live_frame.hpp"
#include "progress.hpp"

namespace REALCAM_NAMESPACE {

/// Number of samples of each pixel, row by row.
struct SampleCounts {
    int width, height;
    std::vector<std::int64_t> counts;
};

/// Treatment of the samples that were taken before a stop.
enum class Collected { keep, drop };

/// One picture on a device, which accumulates samples as long as scene, camera and settings stay the same. Each `set`
/// prepares only what has changed.
///
/// Calls of several threads run one after the other, except `cancel`, which ends the call of another thread. All
/// functions throw DeviceError; after one the next `set` prepares everything from scratch. `keep_going` and `progress`
/// are called some 20 times a second on the calling thread, and their exceptions propagate.
class Session {
public:
    Session() = default;
    virtual ~Session() = default;
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Name of the device, for people.
    virtual std::string name() const = 0;

    /// Throws InputError and SceneFileError if the scene is invalid, and Cancelled.
    void check(const Assembly& scene, const KeepGoing& keep_going = {});

    /// Sets the scene, camera and settings that are photographed from now on. A new picture begins if parts or
    /// transforms of the scene change, or the lens, film, model or pose of the camera, or the seed, the number of
    /// bounces or another setting of the samples. If something moves, another time of exposure begins one, too.
    /// Otherwise exposure time and ISO only change its development. Throws InputError if there can be no picture, and
    /// Cancelled.
    void set(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
             const KeepGoing& keep_going = {});

    static constexpr std::int64_t kAllSamples = std::numeric_limits<std::int64_t>::max();

    /// Discards all samples.
    void restart(const KeepGoing& keep_going = {});

    /// Takes `spp` more samples of each pixel, and returns when they are complete. Throws InputError if nothing is set,
    /// and Cancelled: samples taken until then are kept, so that pixels may differ in their number of samples.
    void add(int spp, const Progress& progress = {});

    /// Takes samples of the pixels that are noisier than the goal, until all have reached it (see AdaptiveSampling).
    /// Throws InputError if nothing is set, and Cancelled: samples taken until then are kept.
    ReachedNoise add_until(const NoiseGoal& goal, const Progress& progress = {});

    /// Noise that the last `add_until` measured until it ended or was stopped.
    ReachedNoise noise_so_far() const { return noise_so_far_; }

    /// Calls `set`, starts to take settings.spp more samples of each pixel and to develop them, and returns meanwhile.
    /// The next frame may be shot before this one is complete; if the device has its maximum number of frames in
    /// progress, this waits for the oldest. `in_progress`: kept alive by work on the host until that has ended. If the
    /// lens changes from frame to frame, a GPU searches for the pupil near the last one. The second frame without a
    /// change begins a new picture, with the pupil of `set`.
    std::shared_ptr<const LiveFrame> shoot(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                           ToneCurve curve, const KeepGoing& keep_going = {},
                                           std::shared_ptr<void> in_progress = {});

    /// Picture of all samples so far, developed with the camera's exposure time, with the layers of the settings; waits
    /// for frames in progress. Throws InputError if there are no samples, and Cancelled if another thread stops it
    /// meanwhile. `most_layer_samples`: largest number of samples up to which layers are completed.
    Image picture(const KeepGoing& keep_going = {}, std::int64_t most_layer_samples = kAllSamples);

    /// Accumulates some samples of a region's pixels, apart from this picture, which is unchanged: those with indices
    /// from `first`, at most kSamplesPerSum of them. On a CPU, such sums of all regions and samples, added in the order
    /// of the samples, have the same bits as the picture that takes them all at once. `counts`: number of the samples
    /// that each pixel of the region takes, row by row; empty: all of them. Throws InputError and Cancelled.
    RegionSums expose_region(const FilmRegion& region, std::int64_t first, int count,
                             const std::vector<std::uint32_t>& counts = {}, const Progress& progress = {});

    /// expose_region for the layers: the first surfaces of these samples. Throws as `expose_region`.
    std::vector<LayerSum> see_region(const FilmRegion& region, std::int64_t first, int count,
                                     const Progress& progress = {});

    /// Accumulates the light that is traced apart from the samples of pixels, on the whole film, for `count` samples of
    /// each pixel: a film for each such light of the picture, also for 0 samples. The sums are of integers, and so the
    /// same in any order. Throws as `expose_region`.
    std::vector<SplatFilm> expose_splats(std::int64_t first, int count, const Progress& progress = {});

    /// The picture that `picture` would return if this session had accumulated all of `film`. Throws InputError if the
    /// film does not fit this picture, and Cancelled.
    Image picture_of(const AccumulatedFilm& film, const KeepGoing& keep_going = {});

    /// Sample counts of the current film. Waits for frames in progress.
    SampleCounts sample_counts(const KeepGoing& keep_going = {});

    /// Ends all work in progress, from any thread: frames and other threads' calls throw Cancelled. No further sample
    /// begins, so that this takes the time of one sample.
    void cancel(Collected collected = Collected::keep);

protected:
    /// Stop that this call has requested, and withdraws at its end. As a bool: true if any thread has requested a stop.
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

    // Implemented by a device. Except for the three functions of the stop, calls run one after the other, with fewer
    // frames in progress than frames_in_flight().

    /// Prepares the samples that follow. Scene, camera and settings are valid, and the film is discarded. `start`:
    /// method of the pupil search. Throws Cancelled if a stop, which `keep_going` may request, has left something
    /// undone.
    virtual void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings, PupilStart start,
                         const KeepGoing& keep_going, OwnStop& stop) = 0;
    /// True if the pupil is the same as that of a new session.
    virtual bool has_new_pupil() const { return true; }
    /// Clears the film and all counts.
    virtual void clear() = 0;
    /// Takes samples of the pixels, fewer of some if it is stopped. `traces_lights`: also takes the light that is
    /// traced apart and belongs to the range. `done` counts the samples, at least approximately.
    virtual void take(const SampleRange& range, const PixelCounts& counts, bool traces_lights,
                      std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Starts to take samples, and to develop the film after them.
    virtual std::shared_ptr<LiveFrame> start(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                             std::shared_ptr<void> in_progress) = 0;
    virtual Image develop() = 0;
    virtual std::vector<float> develop_traced() = 0;  ///< see traced_exposure
    virtual double least_lamp_share() const { return 1; }  ///< see least_lamp_share in traced_lights.hpp
    /// developed_auxiliary_layers of a film whose samples were taken while the settings requested it.
    virtual std::vector<LayerImage> develop_auxiliary_layers() = 0;
    /// Takes samples of a region apart from the film. `counts`: of the region's pixels.
    virtual RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                                   std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Takes the light that is traced apart from samples of pixels, apart from the film.
    virtual std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop& stop) = 0;
    /// Adds the first surfaces of samples of a region's pixels to `sums`, row by row; ends early if it is stopped.
    /// `done` counts the samples.
    virtual void see_layers(const FilmRegion& region, const SampleRange& range, std::vector<LayerSum>& sums,
                            std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Finds the surface on the ray of each pixel's centre; ends early if it is stopped.
    virtual void see_pixel_centre_surfaces(std::vector<PixelCentreSurface>& film, OwnStop& stop) = 0;
    virtual std::vector<std::int64_t> count_samples() = 0;
    /// The camera in the placed scene, with arrays on the host.
    struct PlacedCamera {
        CameraView view;
        Vec3d origin_m;
    };
    virtual PlacedCamera placed_camera() const = 0;
    virtual std::size_t frames_in_flight() const = 0;

    /// May be called from any thread. A stop lasts until it was lowered as often as it was raised.
    virtual void raise_stop() noexcept = 0;
    virtual void lower_stop() noexcept = 0;
    virtual bool is_stopped() const = 0;

    /// Calls f() once all samples are complete. Throws as `picture`.
    template <class F>
    auto of_all_collected(const KeepGoing& keep_going, F&& f) -> decltype(f()) {
        const Turn turn(mutex_, keep_going);
        wait_for_frames(keep_going);
        if (is_stopped()) throw Cancelled();
        if (!ready_ || is_blank_) throw InputError("there is no picture yet; samples have to be taken first");
        return f();
    }

    const Camera& camera() const { return camera_; }
    FilmRegion whole_film() const { return {0, 0, camera_.film.width, camera_.film.height}; }
    const RenderSettings& settings() const { return settings_; }
    /// Exposure time, reduced by a neutral filter in front of the lens, s.
    double film_exposure_s() const { return camera_.exposure_time_s * settings_.filter_transmittance(); }
    std::int64_t samples() const { return samples_; }  ///< largest number per pixel since the film was cleared

private:
    /// Lock that one thread holds at a time.
    class Turn {
    public:
        Turn(std::timed_mutex& mutex, const KeepGoing& keep_going);

    private:
        std::unique_lock<std::timed_mutex> lock_;
    };

    struct LowerStop {
        Session& session;
        ~LowerStop() { session.lower_stop(); }
    };

    void check_all(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const KeepGoing& keep_going);

    void check_region(const FilmRegion& region) const;

    void wait_for_free_frame(const KeepGoing& keep_going) {
        while (frames_.size() >= frames_in_flight()) wait_for_oldest(keep_going);
    }
    void wait_for_frames(const KeepGoing& keep_going) {
        while (!frames_.empty()) wait_for_oldest(keep_going);
    }
    void wait_for_oldest(const KeepGoing& keep_going);

    /// True if the exposures are at the same time, which matters only if something moves.
    bool is_same_exposure(const Assembly& scene, const Camera& camera) const;

    /// True if the additional sums of PixelSum are those that these layers need.
    bool has_sums_for(LayerSet wanted) const;

    bool is_same_picture(const Assembly& scene, const Camera& camera, const RenderSettings& settings) const;

    void make_ready(const Assembly& wanted_scene, const Camera& wanted_camera, const RenderSettings& settings,
                    PupilStart start, const KeepGoing& keep_going);

    void give_up_samples();

    static std::int64_t mean_of(const std::vector<std::int64_t>& counts);

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(camera_.film.width) * static_cast<std::size_t>(camera_.film.height);
    }

    void forget_layers();

    bool lacks_layers(std::int64_t most) const;

    /// Completes the requested layers up to the samples of the picture. If it is stopped, they start from scratch.
    void see_what_is_missing(std::atomic<std::int64_t>& done, OwnStop& stop, std::int64_t most = kAllSamples);

    /// `auxiliary`, `counts`: functions that return the arrays of developed_auxiliary_layers and the sample counts, for
    /// the same film.
    template <class AuxiliaryLayers, class Counts>
    void add_layers(Image& image, const LayerFilm& layers, AuxiliaryLayers&& auxiliary, Counts&& counts);

    /// Calls work(range, stop) for the samples of a part of the picture, with nothing else in progress.
    template <class Work>
    void take_part(std::int64_t first, int count, const Progress& progress, const std::atomic<std::int64_t>& done,
                   std::size_t pixels, Work&& work);

    /// Seconds that kSampledLayers take for one sample of each pixel; 0 if no such layer is requested.
    double seconds_of_layers(OwnStop& stop);

    ReachedNoise take_until(const NoiseGoal& goal, std::atomic<double>& share, OwnStop& stop);

    /// Calls f(range) for the ranges of `spp` more samples.
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
    bool ready_ = false;  ///< true if the following members are set:
    Assembly scene_;
    Camera camera_;
    RenderSettings settings_;
    std::int64_t samples_ = 0;  ///< number for the pixel with the most: position in the random sequence
    std::int64_t mean_samples_ = 0;  ///< mean over all pixels, rounded up
    bool is_blank_ = true;  ///< true until the first sample begins
    LayerFilm layer_film_;
    ReachedNoise noise_so_far_;
    std::int64_t layer_samples_ = 0;  ///< number of samples that layer_film_.sums holds
    double setup_seconds_ = 0, exposing_seconds_ = 0;  ///< for the current picture
    std::deque<std::shared_ptr<const LiveFrame>> frames_;  ///< frames in progress
};

}  // namespace REALCAM_NAMESPACE
