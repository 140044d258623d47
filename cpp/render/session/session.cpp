#include "session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "../layers/motion.hpp"
#include "adaptive_sampling.hpp"
#include "progress.hpp"

namespace realcam {

void Session::check(const Assembly& scene, const KeepGoing& keep_going) {
    const SessionLock lock(mutex_, keep_going);
    checks_.check(scene, {}, keep_going);
}

void Session::set(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                  const KeepGoing& keep_going) {
    const SessionLock lock(mutex_, keep_going);
    check_all(scene, camera, settings, keep_going);
    wait_for_free_frame(keep_going);
    prepare_changes(scene, camera, settings, PupilStart::from_scratch, keep_going);
}

void Session::restart(const KeepGoing& keep_going) {
    const SessionLock lock(mutex_, keep_going);
    wait_for_free_frame(keep_going);
    discard_samples();
}

void Session::add(int spp, const Progress& progress) {
    validate_spp(spp);
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    const SessionLock lock(mutex_, keep_going);
    if (!is_ready_) throw InputError("there is no scene to photograph yet; set() sets scene, camera and settings");
    wait_for_free_frame(keep_going);
    OwnStop stop(*this);
    std::atomic<std::int64_t> done{0};
    const double total = static_cast<double>(spp) * camera_.film.width * camera_.film.height *
                         (settings_.layers.has_any(kSampledLayers) ? 2 : 1);
    const auto work = [&] {
        for_next_samples(spp, [&](const SampleRange& range) { take_samples(range, {}, true, done, stop); });
        mean_samples_ = stop ? mean_of(count_samples()) : mean_samples_ + spp;
        complete_layers(done, stop);
    };
    const auto begin = std::chrono::steady_clock::now();
    // Layers may have to catch up with more samples than these.
    run_with_progress(work, [&] { return std::min(1.0, static_cast<double>(done) / total); }, progress, stop);
    exposing_seconds_ += seconds_since(begin);
    if (stop) throw Cancelled();
}

ReachedNoise Session::add_until(const NoiseGoal& goal, const Progress& progress) {
    validate(goal);
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    const SessionLock lock(mutex_, keep_going);
    if (!is_ready_) throw InputError("there is no scene to photograph yet; set() sets scene, camera and settings");
    wait_for_frames(keep_going);
    OwnStop stop(*this);
    std::atomic<double> share{0};
    ReachedNoise reached;
    const auto work = [&] {
        reached = sample_until(goal, share, stop);
        std::atomic<std::int64_t> done{0};
        complete_layers(done, stop);
    };
    const auto begin = std::chrono::steady_clock::now();
    run_with_progress(work, [&] { return share.load(); }, progress, stop);
    exposing_seconds_ += seconds_since(begin);
    if (stop) throw Cancelled();
    return reached;
}

std::shared_ptr<const LiveFrame> Session::shoot(const Assembly& scene, const Camera& camera,
                                                const RenderSettings& settings, ToneCurve curve,
                                                const KeepGoing& keep_going, std::shared_ptr<void> in_progress) {
    const SessionLock lock(mutex_, keep_going);
    check_all(scene, camera, settings, keep_going);
    wait_for_free_frame(keep_going);
    prepare_changes(scene, camera, settings, PupilStart::near_last, keep_going);
    std::vector<SampleRange> ranges;
    for_next_samples(settings.spp, [&](const SampleRange& range) { ranges.push_back(range); });
    mean_samples_ += settings.spp;
    try {
        frames_.push_back(start_frame(ranges, curve, std::move(in_progress)));
    } catch (...) {
        is_ready_ = false;
        throw;
    }
    return frames_.back();
}

Image Session::picture(const KeepGoing& keep_going, std::int64_t max_layer_samples) {
    return with_all_samples(keep_going, [&] {
        if (is_missing_layers(max_layer_samples)) {
            OwnStop stop(*this);
            std::atomic<std::int64_t> done{0};
            run_interruptibly([&] { complete_layers(done, stop, max_layer_samples); }, keep_going, stop);
            if (stop) throw Cancelled();
        }
        Image image = develop();
        add_layers(image, layer_film_, [&] { return develop_auxiliary_layers(); }, [&] { return count_samples(); });
        image.spp = mean_samples_ == samples_ ? samples_ : mean_of(count_samples());
        image.stats.setup_seconds = setup_seconds_;
        image.stats.seconds = setup_seconds_ + exposing_seconds_;
        return image;
    });
}

template <class Work>
void Session::sample_part(std::int64_t first, int count, const Progress& progress,
                          const std::atomic<std::int64_t>& done, std::size_t pixels, Work&& work) {
    if (count < 0 || count > static_cast<int>(kSamplesPerSum))
        throw InputError("a part of a picture must have 0 to " + std::to_string(kSamplesPerSum) +
                         " samples of each pixel");
    if (first < 0 || first > std::numeric_limits<std::uint32_t>::max() - kSamplesPerSum)
        throw InputError("the number of a part's first sample must lie between 0 and 4294967039");
    const KeepGoing keep_going = progress ? KeepGoing([&] { return progress(0.0); }) : KeepGoing();
    const SessionLock lock(mutex_, keep_going);
    if (!is_ready_) throw InputError("there is no scene to photograph yet; set() sets scene, camera and settings");
    wait_for_frames(keep_going);
    OwnStop stop(*this);
    const double total = static_cast<double>(count) * static_cast<double>(pixels);
    run_with_progress([&] { work(next_samples(settings_.seed, first, first + count), stop); },
                      [&] { return std::min(1.0, static_cast<double>(done) / total); }, progress, stop);
    if (stop) throw Cancelled();
}

RegionSums Session::sample_region(const FilmRegion& region, std::int64_t first, int count,
                                  const std::vector<std::uint32_t>& counts, const Progress& progress) {
    if (!counts.empty() && counts.size() != region.pixels())
        throw InputError("expected a sample count for each pixel of the region");
    RegionSums sums;
    std::atomic<std::int64_t> done{0};
    sample_part(first, count, progress, done, region.pixels(), [&](const SampleRange& range, OwnStop& stop) {
        check_region(region);
        if (settings_.pupil_sampling == PupilSampling::pixel)
            throw InputError("pupil_sampling: pixel excludes pictures in parts");
        sums = take_region(region, range, {counts.empty() ? nullptr : counts.data(), 0}, done, stop);
    });
    return sums;
}

std::vector<LayerSum> Session::layer_sums_of_region(const FilmRegion& region, std::int64_t first, int count,
                                                    const Progress& progress) {
    std::vector<LayerSum> sums;
    std::atomic<std::int64_t> done{0};
    sample_part(first, count, progress, done, region.pixels(), [&](const SampleRange& range, OwnStop& stop) {
        check_region(region);
        sums.resize(region.pixels());
        trace_layers(region, range, sums, done, stop);
    });
    return sums;
}

std::vector<SplatFilm> Session::sample_splats(std::int64_t first, int count, const Progress& progress) {
    std::vector<SplatFilm> films;
    const std::atomic<std::int64_t> done{0};
    sample_part(first, count, progress, done, 1,
                [&](const SampleRange& range, OwnStop& stop) { films = take_splats(range, stop); });
    return films;
}

Image Session::picture_of(const AccumulatedFilm& film, const KeepGoing& keep_going) {
    const SessionLock lock(mutex_, keep_going);
    if (!is_ready_) throw InputError("there is no scene to photograph yet; set() sets scene, camera and settings");
    wait_for_frames(keep_going);
    const LayerSet requested = settings_.layers;
    const auto is_of_film = [&](const auto& sums) { return sums.size() == pixel_count(); };
    if (!is_of_film(film.pixels) || (requested.has_any(kSampledLayers) && !is_of_film(film.layers)))
        throw InputError("the film must have the pixels and the layers of the picture");
    for (const SplatFilm& splats : film.splats)
        if (splats.blocks.empty() || splats.sums.size() != splats.blocks.size() * pixel_count())
            throw InputError("the film must have the pixels of the picture");
    const FilmView view = view_of(film.pixels, camera_.film.width, camera_.film.height, settings_, film.splats);
    LayerFilm layers{film.layers, {}};
    if (requested.has_any(kPixelCentreLayers)) {
        layers.pixel_centres.resize(pixel_count());
        OwnStop stop(*this);
        run_interruptibly([&] { trace_pixel_centres(layers.pixel_centres, stop); }, keep_going, stop);
        if (stop) throw Cancelled();
    }
    Image image = developed(view, camera_.exposure_time_s);
    add_layers(
        image, layers, [&] { return developed_auxiliary_layers(view, requested, camera_.exposure_time_s); },
        [&] { return samples_of(film.pixels); });
    image.spp = mean_of(samples_of(film.pixels));
    image.stats = film.stats;
    return image;
}

SampleCounts Session::sample_counts(const KeepGoing& keep_going) {
    const SessionLock lock(mutex_, keep_going);
    wait_for_frames(keep_going);
    const auto [width, height] = std::pair(camera_.film.width, camera_.film.height);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, is_ready_ && !is_blank_ ? count_samples() : std::vector<std::int64_t>(pixels)};
}

void Session::cancel(OnCancel collected) {
    raise_stop();
    const std::unique_lock lock(mutex_);
    const LowerStop lower{*this};
    wait_for_frames({});
    if (collected == OnCancel::drop) discard_samples();
}

Session::SessionLock::SessionLock(std::timed_mutex& mutex, const KeepGoing& keep_going)
    : lock_(mutex, std::defer_lock) {
    while (!lock_.try_lock_for(std::chrono::milliseconds(50)))
        if (keep_going && !keep_going()) throw Cancelled();
}

void Session::check_all(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                        const KeepGoing& keep_going) {
    validate(settings);
    validate(camera);
    validate_effects(settings, camera);
    checks_.check(scene, {}, keep_going);
}

void Session::check_region(const FilmRegion& region) const {
    const auto is_inside = [](int first, int count, int end) {
        return first >= 0 && count >= 1 && first < end && count <= end - first;
    };
    if (!is_inside(region.column, region.width, camera_.film.width) ||
        !is_inside(region.row, region.height, camera_.film.height))
        throw InputError("a region must lie on the film, which has " + std::to_string(camera_.film.width) + " x " +
                         std::to_string(camera_.film.height) + " pixels");
}

void Session::wait_for_oldest(const KeepGoing& keep_going) {
    wait(*frames_.front(), keep_going);
    frames_.pop_front();
}

bool Session::is_same_exposure(const Assembly& scene, const Camera& camera) const {
    return camera.motion == camera_.motion &&
           ((!scene.moves() && !camera.moves()) ||
            (camera.shutter == camera_.shutter && camera.exposure_time_s == camera_.exposure_time_s));
}

bool Session::has_sums_for(LayerSet requested) const {
    const LayerSet current = settings_.layers;
    if (current.has_any(kHalfLayers) != requested.has_any(kHalfLayers))
        return false;  // these also disable light tracing
    if (current.has(Layer::variance) == requested.has(Layer::variance)) return true;
    // Squares that are no longer requested do no harm, unless the excess of wavelengths needs their memory.
    return current.has(Layer::variance) && !settings_.effects.have_wavelengths();
}

bool Session::is_same_picture(const Assembly& scene, const Camera& camera, const RenderSettings& settings) const {
    return same_parts(scene, scene_) && same_transforms(scene, scene_) && camera.lens == camera_.lens &&
           camera.geometry == camera_.geometry && camera.ray_pairs == camera_.ray_pairs &&
           camera.film == camera_.film && camera.pose == camera_.pose && camera.model == camera_.model &&
           is_same_exposure(scene, camera) && settings.seed == settings_.seed && settings.path() == settings_.path() &&
           settings.effects == settings_.effects && settings.illuminant == settings_.illuminant &&
           settings.lens_filter == settings_.lens_filter && settings.filter == settings_.filter &&
           settings.pupil_sampling == settings_.pupil_sampling && settings.light_tracing == settings_.light_tracing &&
           has_sums_for(settings.layers);
}

Assembly Session::with_shapes_in_exposure(const Assembly& scene, const Camera& camera, const EffectChoice& effects) {
    const double readout_s = effects.rolling_shutter ? camera.shutter.readout_time_s : 0;
    const double middle_s = camera.shutter.opens_s + 0.5 * (camera.exposure_time_s + readout_s);
    if (middle_s != std::exchange(shapes_time_s_, middle_s)) shapes_.clear();
    return with_shapes_at(scene, middle_s, shapes_);
}

void Session::prepare_changes(const Assembly& requested_scene, const Camera& requested_camera,
                              const RenderSettings& settings, PupilStart start, const KeepGoing& keep_going) {
    std::optional<Assembly> shaped;
    if (requested_scene.deforms())
        shaped = with_shapes_in_exposure(requested_scene, requested_camera, settings.effects);
    const Assembly& shaped_scene = shaped ? *shaped : requested_scene;
    const auto changed = without_disabled_motion(shaped_scene, requested_camera, settings.effects);
    const Assembly& scene = changed ? changed->scene : shaped_scene;
    const Camera& camera = changed ? changed->camera : requested_camera;
    const bool is_same = is_ready_ && is_same_picture(scene, camera, settings);
    // Frames of a camera at rest add up to a picture, which must have the pupil that a search from scratch finds.
    const bool is_at_rest = is_same && start == PupilStart::near_last && !has_new_pupil();
    if (!is_same || is_at_rest) {
        is_ready_ = false;  // if anything fails from here on, the next call prepares everything
        discard_samples();
        scene_ = {};  // frees its memory before the next scene takes as much
        OwnStop stop(*this);
        const auto begin = std::chrono::steady_clock::now();
        prepare(scene, camera, settings, start, keep_going, stop);
        setup_seconds_ = seconds_since(begin);
        scene_ = scene;
        is_ready_ = true;
    }
    camera_ = camera;
    settings_ = settings;
}

void Session::discard_samples() {
    samples_ = mean_samples_ = 0;
    exposing_seconds_ = 0;
    is_blank_ = true;
    discard_layers();
}

std::int64_t Session::mean_of(const std::vector<std::int64_t>& counts) {
    double sum = 0;
    for (const std::int64_t count : counts) sum += static_cast<double>(count);
    return std::llround(sum / static_cast<double>(counts.size()));
}

void Session::discard_layers() {
    layer_film_ = {};
    layer_samples_ = 0;
}

bool Session::is_missing_layers(std::int64_t max_samples) const {
    return (settings_.layers.has_any(kSampledLayers) && layer_samples_ < std::min(mean_samples_, max_samples)) ||
           (settings_.layers.has_any(kPixelCentreLayers) && layer_film_.pixel_centres.empty());
}

void Session::complete_layers(std::atomic<std::int64_t>& done, OwnStop& stop, std::int64_t max_samples) {
    if (!is_missing_layers(max_samples) || stop) return;
    try {
        if (settings_.layers.has_any(kPixelCentreLayers) && layer_film_.pixel_centres.empty()) {
            layer_film_.pixel_centres.resize(pixel_count());
            trace_pixel_centres(layer_film_.pixel_centres, stop);
        }
        if (settings_.layers.has_any(kSampledLayers)) {
            layer_film_.sums.resize(pixel_count());
            const std::int64_t end = std::min(mean_samples_, max_samples);
            while (layer_samples_ < end && !stop) {
                const SampleRange range = next_samples(settings_.seed, layer_samples_, end);
                layer_samples_ += range.count;
                trace_layers(whole_film(), range, layer_film_.sums, done, stop);
            }
        }
    } catch (...) {
        discard_layers();
        is_ready_ = false;
        throw;
    }
    if (stop) discard_layers();
}

template <class AuxiliaryLayers, class Counts>
void Session::add_layers(Image& image, const LayerFilm& layers, AuxiliaryLayers&& auxiliary, Counts&& counts) {
    const LayerSet requested = settings_.layers;
    if (requested.has_any(kSampledLayers) || requested.has_any(kPixelCentreLayers)) {
        const SurfaceIds ids(scene_);
        const bool needs_camera = requested.has_any({Layer::motion, Layer::position_middle});
        const PlacedCamera placed = needs_camera ? placed_camera() : PlacedCamera{};
        image.layers = developed_layers(layers, requested, ids, placed.origin_m);
        if (requested.has(Layer::motion))
            image.layers.push_back(motion_vectors(layers.pixel_centres, scene_, camera_, placed.view, placed.origin_m));
        if (requested.has(Layer::object_id)) image.object_names = ids.object_names();
        if (requested.has(Layer::material_id)) image.material_names = ids.material_names_by_id();
    }
    if (requested.has_any({Layer::variance, Layer::traced_light}) || requested.has_any(kHalfLayers))
        for (LayerImage& layer : auxiliary()) image.layers.push_back(std::move(layer));
    if (requested.has(Layer::sample_count)) {
        constexpr std::int64_t kMaxCount = std::numeric_limits<std::uint32_t>::max();
        LayerImage image_of_counts{Layer::sample_count, {}, {}};
        for (const std::int64_t count : counts())
            image_of_counts.numbers.push_back(static_cast<std::uint32_t>(std::min(count, kMaxCount)));
        image.layers.push_back(std::move(image_of_counts));
    }
    std::sort(image.layers.begin(), image.layers.end(),
              [](const LayerImage& a, const LayerImage& b) { return a.layer < b.layer; });
}

double Session::measure_layer_seconds(OwnStop& stop) {
    if (!settings_.layers.has_any(kSampledLayers)) return 0;
    std::vector<LayerSum> unused(pixel_count());
    std::atomic<std::int64_t> done{0};
    const auto begin = std::chrono::steady_clock::now();
    trace_layers(whole_film(), {settings_.seed, 0, 1}, unused, done, stop);
    return seconds_since(begin);
}

ReachedNoise Session::sample_until(const NoiseGoal& goal, std::atomic<double>& share, OwnStop& stop) {
    const auto begin = std::chrono::steady_clock::now();
    std::atomic<std::int64_t> done{0};
    // Takes `count` samples of each pixel, or as many as `counts` says for it.
    const auto take_round = [&](std::int64_t count, const std::uint32_t* counts, bool traces_lights) {
        std::uint32_t taken_before = 0;
        for_next_samples(count, [&](const SampleRange& range) {
            take_samples(range, {counts, taken_before}, traces_lights, done, stop);
            taken_before += range.count;
        });
    };
    const bool is_new = is_blank_;
    noise_so_far_ = {};
    if (is_new) {
        mean_samples_ = AdaptiveSampling::first_samples(goal);
        // Counts are given for each pixel, although they are equal, because pixels then do not share samples: the two
        // halves of a tile must be independent.
        const std::vector<std::uint32_t> first(pixel_count(), static_cast<std::uint32_t>(mean_samples_));
        take_round(mean_samples_, first.data(), true);
    }
    AdaptiveSampling tiles(camera_.film.width, camera_.film.height, goal, camera_.iso, develop().exposure,
                           count_samples(), develop_traced());
    const auto pixels = static_cast<double>(pixel_count());
    // Layers are computed afterwards, and their time counts towards the limit of the goal.
    const double layer_seconds = std::isfinite(goal.seconds) ? measure_layer_seconds(stop) : 0;
    double taken = is_new ? static_cast<double>(mean_samples_) * pixels : 0;
    while (!stop) {
        double affordable = kInfinity;  // number of samples, over all pixels, for which there is time
        if (std::isfinite(goal.seconds)) {
            const double spent = seconds_since(begin);
            const double left =
                goal.seconds - spent - layer_seconds * static_cast<double>(mean_samples_ - layer_samples_);
            affordable = taken > 0 ? left / (spent / taken + layer_seconds / pixels)
                                   : static_cast<double>(AdaptiveSampling::first_samples(goal)) * pixels;
        }
        const std::vector<std::uint32_t> counts = tiles.next(affordable);
        const std::uint32_t max_count = *std::max_element(counts.begin(), counts.end());
        if (max_count == 0) break;
        take_round(max_count, counts.data(), tiles.traces_lights());
        if (stop) {
            mean_samples_ = mean_of(count_samples());
            return noise_so_far_;  // the noise cannot be measured by the change in an incomplete round
        }
        double round = 0;
        for (const std::uint32_t count : counts) round += count;
        mean_samples_ += static_cast<std::int64_t>(std::ceil(round / pixels));
        taken += round;
        tiles.add(develop().exposure, counts, tiles.traces_lights() ? develop_traced() : std::vector<float>());
        noise_so_far_ = tiles.reached();
        share = std::max(share.load(), std::min(1.0, taken / (taken + tiles.left())));
    }
    noise_so_far_ = tiles.reached();
    check_for_missed_lamps(noise_so_far_, least_lamp_share(), std::ranges::min(count_samples()));
    return noise_so_far_;
}

}  // namespace realcam
