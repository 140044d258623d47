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

/// Number of samples of each pixel of a film, row by row.
struct SampleCounts {
    int width, height;
    std::vector<std::int64_t> counts;
};

/// Treatment of the samples that were accumulated before a cancellation.
enum class OnCancel {
    keep,  ///< they remain part of the picture
    drop,  ///< the picture starts from scratch
};

/// One picture on a device. It accumulates samples as long as scene, camera and settings stay the same; each `set`
/// prepares only what has changed. The class holds what is common to all devices: the order of the calls, layers and
/// adaptive sampling. A backend implements the virtual functions.
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

    /// Name of the device, for display.
    virtual std::string name() const = 0;

    /// Throws InputError and SceneFileError if the scene is invalid, and Cancelled.
    void check(const Assembly& scene, const KeepGoing& keep_going = {});

    /// Sets the scene, camera and settings of the following samples. A new picture begins if parts or transforms of the
    /// scene change, or the lens, film, model or pose of the camera, or a setting that the samples depend on, such as
    /// the seed or the number of bounces. If something moves, another time or duration of the exposure begins one, too;
    /// otherwise exposure time and ISO change only the development of the picture. Throws InputError if an argument is
    /// invalid or the camera does not support the settings, and Cancelled.
    void set(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
             const KeepGoing& keep_going = {});

    /// No limit, as an argument of `picture`.
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

    /// Live view: calls `set`, starts to take settings.spp more samples of each pixel and to develop all samples so
    /// far, and returns a handle of that frame at once. The next frame may be started before this one is complete; if
    /// the device has its maximum number of frames in progress, this waits for the oldest. `curve`: tone curve of the
    /// frame. `in_progress`: an object that is kept alive until the work of the frame on host threads has ended. If the
    /// lens changes from frame to frame, a GPU searches for the pupil near that of the last frame, which is faster and
    /// less exact; the second frame without a change begins a new picture with the exact pupil.
    std::shared_ptr<const LiveFrame> shoot(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                           ToneCurve curve, const KeepGoing& keep_going = {},
                                           std::shared_ptr<void> in_progress = {});

    /// Returns the picture of all samples so far, developed with the camera's exposure time, with the layers of the
    /// settings. Waits for frames in progress. Layers take as many samples per pixel as the picture has, but at most
    /// `max_layer_samples`. Throws InputError if there are no samples, and Cancelled.
    Image picture(const KeepGoing& keep_going = {}, std::int64_t max_layer_samples = kAllSamples);

    // The next three functions render a part of the picture, for rendering it on several machines. They leave the
    // picture of this session unchanged.

    /// Returns the sums of the samples with the indices [first, first + count) of a region's pixels; `count` is at most
    /// kSamplesPerSum. On a CPU, the sums of all parts, added in the order of the samples, equal those of a single
    /// rendering bit by bit. `counts`: how many of these samples each pixel of the region takes, row by row; empty: all
    /// of them. Throws InputError and Cancelled.
    RegionSums sample_region(const FilmRegion& region, std::int64_t first, int count,
                             const std::vector<std::uint32_t>& counts = {}, const Progress& progress = {});

    /// Returns the sums for kSampledLayers of such samples of a region's pixels. Throws as `sample_region`.
    std::vector<LayerSum> layer_sums_of_region(const FilmRegion& region, std::int64_t first, int count,
                                               const Progress& progress = {});

    /// Returns the splatted light (SplattedLight) that belongs to such samples of all pixels: one film for each kind of
    /// light of the picture, also if `count` is 0. The sums are integers, so that parts can be added in any order.
    /// Throws as `sample_region`.
    std::vector<SplatFilm> sample_splats(std::int64_t first, int count, const Progress& progress = {});

    /// Develops a film that was merged from parts: returns the picture that `picture` would return if this session had
    /// accumulated `film`. Throws InputError if the film does not fit the scene, camera and settings, and Cancelled.
    Image picture_of(const AccumulatedFilm& film, const KeepGoing& keep_going = {});

    /// Returns the sample counts of the current film. Waits for frames in progress.
    SampleCounts sample_counts(const KeepGoing& keep_going = {});

    /// Ends all work in progress; may be called from any thread. Frames and other threads' calls throw Cancelled.
    /// Returns when the samples in progress are complete.
    void cancel(OnCancel collected = OnCancel::keep);

protected:
    /// Stop request of one call, which is withdrawn when the call ends. Assigning true requests a stop of the device's
    /// work; as a bool, it is true if any thread has requested one.
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

    // Implemented by a backend. Except for raise_stop, lower_stop and is_stopped, calls run one after the other, with
    // fewer frames in progress than frames_in_flight().

    /// Prepares the device for the following samples. Scene, camera and settings have been checked, and the film has
    /// been discarded. `start`: method of the pupil search. Throws Cancelled if it was stopped before it was complete;
    /// returning false from `keep_going` requests a stop.
    virtual void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings, PupilStart start,
                         const KeepGoing& keep_going, OwnStop& stop) = 0;
    /// True if the pupil was found from scratch, as in a new session.
    virtual bool has_new_pupil() const { return true; }
    /// Clears the film and all counts.
    virtual void clear() = 0;
    /// Takes samples of all pixels and adds them to the film; if it is stopped, some pixels have fewer samples.
    /// `traces_lights`: true if the splatted light that belongs to the range is taken, too. `done`: incremented by the
    /// number of samples, at least approximately.
    virtual void take_samples(const SampleRange& range, const PixelCounts& counts, bool traces_lights,
                              std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Starts a live frame: takes samples of all pixels, and then develops the film. Returns at once.
    virtual std::shared_ptr<LiveFrame> start_frame(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                                   std::shared_ptr<void> in_progress) = 0;
    /// Develops the film to exposure and depth, with the cost of the samples.
    virtual Image develop() = 0;
    /// Returns traced_exposure of the film.
    virtual std::vector<float> develop_traced() = 0;
    /// Returns least_lamp_share (traced_lights.hpp) of the scene.
    virtual double least_lamp_share() const { return 1; }
    /// Returns developed_auxiliary_layers of the film, for the layers of the settings.
    virtual std::vector<LayerImage> develop_auxiliary_layers() = 0;
    /// Takes samples of a region's pixels without adding them to the film. `counts`: of the region's pixels.
    virtual RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                                   std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Takes the splatted light that belongs to a range of samples without adding it to the film.
    virtual std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop& stop) = 0;
    /// Traces samples of a region's pixels to their first surfaces, and adds the results to `sums`, row by row; ends
    /// early if it is stopped. `done`: incremented by the number of samples.
    virtual void trace_layers(const FilmRegion& region, const SampleRange& range, std::vector<LayerSum>& sums,
                              std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Finds the surface on the ray of each pixel's centre, row by row; ends early if it is stopped.
    virtual void trace_pixel_centres(std::vector<PixelCentreSurface>& film, OwnStop& stop) = 0;
    /// Returns the number of samples of each pixel.
    virtual std::vector<std::int64_t> count_samples() = 0;
    /// View of the camera in render space, with arrays on the host.
    struct PlacedCamera {
        CameraView view;
        Vec3d origin_m;  ///< origin of render space in the scene
    };
    virtual PlacedCamera placed_camera() const = 0;
    /// Maximum number of live frames in progress.
    virtual std::size_t frames_in_flight() const = 0;

    // Stop of the device's work. These may be called from any thread; a stop lasts until it was lowered as often as it
    // was raised.
    virtual void raise_stop() noexcept = 0;
    virtual void lower_stop() noexcept = 0;
    virtual bool is_stopped() const = 0;

    /// Waits until all samples in progress are complete, and returns f(). Throws as `picture`.
    template <class F>
    auto with_all_samples(const KeepGoing& keep_going, F&& f) -> decltype(f()) {
        const SessionLock lock(mutex_, keep_going);
        wait_for_frames(keep_going);
        if (is_stopped()) throw Cancelled();
        if (!is_ready_ || is_blank_) throw InputError("there is no picture yet; it needs samples first");
        return f();
    }

    // Camera and settings of the current picture, and its pixels.
    const Camera& camera() const { return camera_; }
    FilmRegion whole_film() const { return {0, 0, camera_.film.width, camera_.film.height}; }
    const RenderSettings& settings() const { return settings_; }
    /// Exposure time, reduced by a neutral filter in front of the lens, s.
    double film_exposure_s() const { return camera_.exposure_time_s * settings_.filter_transmittance(); }
    /// Largest number of samples of a pixel since the film was cleared.
    std::int64_t samples() const { return samples_; }

private:
    /// Lock of the session, which lets calls of several threads run one after the other. The constructor waits for it,
    /// and throws Cancelled if `keep_going` returns false.
    class SessionLock {
    public:
        SessionLock(std::timed_mutex& mutex, const KeepGoing& keep_going);

    private:
        std::unique_lock<std::timed_mutex> lock_;
    };

    /// Lowers a raised stop on destruction.
    struct LowerStop {
        Session& session;
        ~LowerStop() { session.lower_stop(); }
    };

    /// Throws InputError if scene, camera or settings are invalid or do not fit each other, and Cancelled.
    void check_all(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   const KeepGoing& keep_going);

    /// Throws InputError if a region does not lie on the film.
    void check_region(const FilmRegion& region) const;

    /// Waits until another live frame can be started.
    void wait_for_free_frame(const KeepGoing& keep_going) {
        while (frames_.size() >= frames_in_flight()) wait_for_oldest(keep_going);
    }
    /// Waits for all live frames.
    void wait_for_frames(const KeepGoing& keep_going) {
        while (!frames_.empty()) wait_for_oldest(keep_going);
    }
    void wait_for_oldest(const KeepGoing& keep_going);

    /// Returns true if the exposure shows the same motion as that of camera_.
    bool is_same_exposure(const Assembly& scene, const Camera& camera) const;

    /// Returns true if PixelSum::auxiliary of the film holds the sums that these layers need.
    bool has_sums_for(LayerSet requested) const;

    /// Returns true if samples of these arguments can be added to the current film.
    bool is_same_picture(const Assembly& scene, const Camera& camera, const RenderSettings& settings) const;

    /// Returns the scene with the shapes that its deforming objects have in the middle of the exposure of the film.
    Assembly with_shapes_in_exposure(const Assembly& scene, const Camera& camera, const EffectChoice& effects);

    /// Prepares the device for a scene, camera and settings, and begins a new picture if they require it.
    void prepare_changes(const Assembly& requested_scene, const Camera& requested_camera,
                         const RenderSettings& settings, PupilStart start, const KeepGoing& keep_going);

    /// Begins a new picture without samples.
    void discard_samples();

    /// Returns the rounded mean.
    static std::int64_t mean_of(const std::vector<std::int64_t>& counts);

    std::size_t pixel_count() const {
        return static_cast<std::size_t>(camera_.film.width) * static_cast<std::size_t>(camera_.film.height);
    }

    /// Discards the accumulated layers, but not the film.
    void discard_layers();

    /// Returns true if requested layers lack samples that the picture has, up to `max_samples` per pixel.
    bool is_missing_layers(std::int64_t max_samples) const;

    /// Takes these samples. If it is stopped, the layers are discarded. `done`: incremented by the number of samples.
    void complete_layers(std::atomic<std::int64_t>& done, OwnStop& stop, std::int64_t max_samples = kAllSamples);

    /// Adds the requested layers to a picture, in the order of Layer. `auxiliary()`, `counts()`: return the layers of
    /// developed_auxiliary_layers and the sample counts, of the same film.
    template <class AuxiliaryLayers, class Counts>
    void add_layers(Image& image, const LayerFilm& layers, AuxiliaryLayers&& auxiliary, Counts&& counts);

    /// Common part of sample_region, layer_sums_of_region and sample_splats: checks the arguments, and calls
    /// work(range, stop) on a thread of its own, with progress reports. `done`: counter of samples, which `work`
    /// increments; `pixels`: number of pixels whose samples it counts.
    template <class Work>
    void sample_part(std::int64_t first, int count, const Progress& progress, const std::atomic<std::int64_t>& done,
                     std::size_t pixels, Work&& work);

    /// Measures the seconds that kSampledLayers take for one sample of each pixel; 0 if no such layer is requested.
    double measure_layer_seconds(OwnStop& stop);

    /// Takes samples until the goal is reached or the work is stopped. `share`: set to the approximate fraction that is
    /// done.
    ReachedNoise sample_until(const NoiseGoal& goal, std::atomic<double>& share, OwnStop& stop);

    /// Calls f(SampleRange) for `spp` more samples of each pixel, in several ranges if a random sequence ends, and
    /// counts them in samples_.
    template <class F>
    void for_next_samples(std::int64_t spp, F&& f) {
        try {
            if (is_blank_) clear();
            is_blank_ = false;
            for (const std::int64_t end = samples_ + spp; samples_ < end;) {
                const SampleRange range = next_samples(settings_.seed, samples_, end);
                samples_ += range.count;
                f(range);
            }
        } catch (...) {
            is_ready_ = false;
            throw;
        }
    }

    std::timed_mutex mutex_;
    SceneChecks checks_;
    bool is_ready_ = false;  ///< true if the device is prepared for the following three members
    Assembly scene_;
    Camera camera_;
    RenderSettings settings_;
    Shapes shapes_;  ///< shapes of the deforming objects of the last scene, at shapes_time_s_
    double shapes_time_s_ = 0;
    std::int64_t samples_ = 0;  ///< samples of the pixel that has most: position in the random sequence
    std::int64_t mean_samples_ = 0;  ///< samples per pixel, as a mean over all pixels, rounded up
    bool is_blank_ = true;  ///< true until the first sample of a picture begins; the film must then be cleared
    LayerFilm layer_film_;
    ReachedNoise noise_so_far_;
    std::int64_t layer_samples_ = 0;  ///< samples per pixel that layer_film_.sums holds
    double setup_seconds_ = 0, exposing_seconds_ = 0;  ///< time of the current picture: preparation and sampling
    std::deque<std::shared_ptr<const LiveFrame>> frames_;  ///< frames in progress
};

}  // namespace REALCAM_NAMESPACE
