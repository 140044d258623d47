#pragma once
#include <atomic>
#include <cstddef>
#include <deque>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../camera/film_region.hpp"
#include "../camera/pupil_start.hpp"
#include "../scene/scene_checks.hpp"
#include "collected_film.hpp"
#include "image.hpp"
#include "layer_film.hpp"
#include "live_frame.hpp"
#include "progress.hpp"
#include "render_settings.hpp"
#include "sample_range.hpp"

namespace REALCAM_NAMESPACE {

/// The number of samples of each pixel, row by row.
struct SampleCounts {
    int width, height;
    std::vector<std::int64_t> counts;
};

/// What becomes of the samples that were taken before a stop.
enum class Collected { keep, drop };

/// One picture on a device, which collects samples for as long as scene, camera and settings stay the same. From one
/// `set` to the next, only what changed is prepared again.
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
    void check(const Assembly& scene, const KeepGoing& keep_going = {});

    /// What is photographed from now on. A new picture begins with other parts or transforms of the scene, another
    /// lens, film, model or pose of the camera, or another seed or number of bounces. Where something moves, another
    /// time of exposure begins one, too. Else exposure time and ISO only develop it anew. Throws InputError for what
    /// makes no picture, and Cancelled.
    void set(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
             const KeepGoing& keep_going = {});

    static constexpr std::int64_t kAllSamples = std::numeric_limits<std::int64_t>::max();

    /// Gives up all samples.
    void restart(const KeepGoing& keep_going = {});

    /// Takes so many samples more of each pixel, and returns when they are there. Throws InputError where nothing is
    /// set, and Cancelled: what was taken until then stays, so that pixels may differ in their number of samples.
    void add(int spp, const Progress& progress = {});

    /// Takes samples of the pixels that are noisier than wanted, until none is (see AdaptiveSampling). Throws
    /// InputError where nothing is set, and Cancelled: what was taken until then stays.
    ReachedNoise add_until(const NoiseGoal& goal, const Progress& progress = {});

    /// Returns the noise that the last `add_until` had measured when it ended or was stopped.
    ReachedNoise noise_so_far() const { return noise_so_far_; }

    /// `set`, and starts to take settings.spp samples more of each pixel and to develop them; returns while that goes
    /// on. The next frame may be shot before this one is there: where the device has as many under way as it takes,
    /// this waits for the oldest. `under_way`: kept by what works on the host until that has ended. Of a lens that
    /// changes from frame to frame, a GPU finds the pupil near the last one. The second frame of one that does not
    /// change any more begins a new picture, with the pupil of `set`.
    std::shared_ptr<const LiveFrame> shoot(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                                           ToneCurve curve, const KeepGoing& keep_going = {},
                                           std::shared_ptr<void> under_way = {});

    /// All that was collected, developed with the camera's exposure time, and the layers of the settings; waits for
    /// frames under way. Throws InputError where there is nothing, and Cancelled where another thread stops it
    /// meanwhile. `most_layer_samples`: layers that lack samples get no more than these.
    Image picture(const KeepGoing& keep_going = {}, std::int64_t most_layer_samples = kAllSamples);

    /// What some samples of a region's pixels collect, apart from this picture, which stays as it is: those with
    /// numbers from `first`, at most kSamplesPerSum of them. On a CPU, such sums of all regions and samples, added in
    /// the order of the samples, have the same bits as the picture that takes them all at once. `counts`: how many of
    /// the samples each pixel of the region takes, row by row; empty: all of them. Throws InputError, and Cancelled.
    RegionSums expose_region(const FilmRegion& region, std::int64_t first, int count,
                             const std::vector<std::uint32_t>& counts = {}, const Progress& progress = {});

    /// The same of the layers: what these samples see first. Throws as `expose_region`.
    std::vector<LayerSum> see_region(const FilmRegion& region, std::int64_t first, int count,
                                     const Progress& progress = {});

    /// What light that is traced apart from the samples of pixels brings to the whole film, for so many samples of each
    /// pixel: a film for each such light of the picture, also for 0 samples. The sums are of integers, and so the same
    /// in any order. Throws as `expose_region`.
    std::vector<SplatFilm> expose_splats(std::int64_t first, int count, const Progress& progress = {});

    /// The picture that `picture` would be if this session had collected all of `film`. Throws InputError where it is
    /// no film of this picture, and Cancelled.
    Image picture_of(const CollectedFilm& film, const KeepGoing& keep_going = {});

    /// The sample counts of the film that is set. Waits for frames under way.
    SampleCounts sample_counts(const KeepGoing& keep_going = {});

    /// Ends what is under way, from any thread: frames and other threads' calls throw Cancelled. No sample is begun any
    /// more, so that it takes the time of one.
    void cancel(Collected collected = Collected::keep);

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

    /// Makes ready what follows. Scene, camera and settings are valid, and the film is given up. `start`: how its pupil
    /// may be found. Throws Cancelled where the stop, which `keep_going` may ask for, has left something undone.
    virtual void prepare(const Assembly& scene, const Camera& camera, const RenderSettings& settings, PupilStart start,
                         const KeepGoing& keep_going, OwnStop& stop) = 0;
    /// Whether the pupil is the same as that of a new session.
    virtual bool has_pupil_anew() const { return true; }
    /// An empty film, and nothing counted.
    virtual void clear() = 0;
    /// Takes samples of the pixels, or fewer of some where it is stopped. `traces_lights`: and the light that is traced
    /// apart and belongs to the range. `done` counts the samples, at least about.
    virtual void take(const SampleRange& range, const PixelCounts& counts, bool traces_lights,
                      std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Starts to take samples, and to develop what is there then.
    virtual std::shared_ptr<LiveFrame> start(const std::vector<SampleRange>& ranges, ToneCurve curve,
                                             std::shared_ptr<void> under_way) = 0;
    virtual Image develop() = 0;
    virtual std::vector<float> develop_traced() = 0;  ///< traced_exposure
    virtual double least_lamp_share() const { return 1; }  ///< least_lamp_share of the picture
    /// developed_besides of a film whose samples were taken while the settings asked for it.
    virtual std::vector<LayerImage> develop_besides() = 0;
    /// Samples of a region apart from the film. `counts`: of the region's pixels.
    virtual RegionSums take_region(const FilmRegion& region, const SampleRange& range, const PixelCounts& counts,
                                   std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
    /// Light that is traced apart from samples of pixels, and apart from the film.
    virtual std::vector<SplatFilm> take_splats(const SampleRange& range, OwnStop& stop) = 0;
    /// Adds what the samples of a region's pixels see first to `sums`, row by row; ends early where it is stopped.
    /// `done` counts them.
    virtual void see_layers(const FilmRegion& region, const SampleRange& range, std::vector<LayerSum>& sums,
                            std::atomic<std::int64_t>& done, OwnStop& stop) = 0;
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

    /// May be called from any thread. A stop stands until it was lowered as often as it was raised.
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
    FilmRegion whole_film() const { return {0, 0, camera_.film.width, camera_.film.height}; }
    const RenderSettings& settings() const { return settings_; }
    std::int64_t samples() const { return samples_; }  ///< of the pixel that has most, since the film was empty

private:
    /// Held by one thread at a time.
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

    void make_way(const KeepGoing& keep_going) {
        while (frames_.size() >= frames_in_flight()) wait_for_oldest(keep_going);
    }
    void settle(const KeepGoing& keep_going) {
        while (!frames_.empty()) wait_for_oldest(keep_going);
    }
    void wait_for_oldest(const KeepGoing& keep_going);

    /// Where nothing moves it does not matter when the shutter is open.
    bool is_same_exposure(const Assembly& scene, const Camera& camera) const;

    /// Whether PixelSum::besides has what layers want.
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

    /// Brings the layers that are wanted up to the samples of the picture. Where it is stopped they begin anew.
    void see_what_is_missing(std::atomic<std::int64_t>& done, OwnStop& stop, std::int64_t most = kAllSamples);

    /// `besides`, `counts`: functions that make these of the same film.
    template <class Besides, class Counts>
    void add_layers(Image& image, const LayerFilm& layers, Besides&& besides, Counts&& counts);

    /// work(range, stop) on the samples of a part of the picture, with nothing else under way.
    template <class Work>
    void take_part(std::int64_t first, int count, const Progress& progress, const std::atomic<std::int64_t>& done,
                   std::size_t pixels, Work&& work);

    /// How long the layers that samples see take for a sample of each pixel; 0 where none is wanted.
    double seconds_of_layers(OwnStop& stop);

    ReachedNoise take_until(const NoiseGoal& goal, std::atomic<double>& share, OwnStop& stop);

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
    ReachedNoise noise_so_far_;
    std::int64_t layer_samples_ = 0;  ///< of mean_samples_, those that layer_film_.sums holds
    double setup_seconds_ = 0, exposing_seconds_ = 0;  ///< of the picture
    std::deque<std::shared_ptr<const LiveFrame>> frames_;  ///< under way
};

}  // namespace REALCAM_NAMESPACE
