#include "device_renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "../../render/film/film_control_variates.hpp"

namespace realcam {
namespace {

/// Target duration of a launch: short enough for frequent progress reports, long enough that its overhead is
/// negligible.
constexpr double kLaunchTime_ms = 10;
/// Number of samples in the first launches of a picture, before its speed is known. That of the last picture may have
/// been measured with another scene, lens or number of bounces.
constexpr double kFirstSamples = 1 << 20;

/// Splits a film part into launches: all samples of some rows, or a few samples of all rows.
class LaunchPlan {
public:
    /// `columns`: width of the film.
    LaunchPlan(const FilmPart& part, int columns) : part_(part), columns_(columns), row_(0), sample_(0) {}

    /// True if all samples have been returned by next().
    bool is_complete() const { return sample_ == part_.sample_count; }

    /// Returns the next launch. `samples`: approximate number of its samples over all pixels.
    FilmPart next(double samples) {
        const double row = columns_;
        const int rows_left = part_.row_count - row_;
        FilmPart piece = part_;
        piece.first_row = part_.first_row + row_;
        piece.first_sample = part_.first_sample + sample_;
        piece.row_count = rows_left;
        piece.sample_count = 1;
        if (row_ == 0 && samples >= row * part_.row_count) {
            const double all = part_.sample_count - sample_;
            piece.sample_count = static_cast<std::uint32_t>(std::min(all, samples / (row * part_.row_count)));
            sample_ += piece.sample_count;
            return piece;
        }
        // Whole rows of tiles, because the pixels of a tile may share samples.
        const double tiles = std::max(1.0, std::floor(samples / (row * SampleSharing::kTileSide)));
        piece.row_count = static_cast<int>(std::min(tiles * SampleSharing::kTileSide, static_cast<double>(rows_left)));
        row_ += piece.row_count;
        if (row_ == part_.row_count) {
            row_ = 0;
            ++sample_;
        }
        return piece;
    }

private:
    FilmPart part_;
    int columns_, row_;
    std::uint32_t sample_;
};

}  // namespace

DeviceRenderer::DeviceRenderer(int ordinal) : ordinal_(ordinal), stop_(ordinal), counts_(1) {
    check_render_code();
    counts_.clear(stream_);
}

void DeviceRenderer::set_scene(const RenderSpaceScene& scene, const SceneBvh& bvh) {
    const CurrentDevice current(ordinal_);
    scene_.set(scene, bvh, stream_);
}

void DeviceRenderer::set_instances(const RenderSpaceScene& scene, const SceneBvh& bvh) {
    const CurrentDevice current(ordinal_);
    scene_.set_instances(scene, bvh, stream_);
}

void DeviceRenderer::set_camera(const CameraView& camera) {
    const CurrentDevice current(ordinal_);
    camera_arrays_.restart();
    camera_ = with_copied_arrays(
        camera, [&](const auto* from, std::size_t count) { return camera_arrays_.copy(from, count, stream_); });
}

void DeviceRenderer::forget_pupils(bool learns) {
    const CurrentDevice current(ordinal_);
    const std::size_t pixels = static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
    for (auto* cells : {&known_, &found_}) {
        cells->resize(learns ? pixels : 0);
        cells->clear(stream_);
    }
    camera_.pixel_pupils = {learns ? known_.data() : nullptr, found_.data()};
}

void DeviceRenderer::learn_pupils() {
    const CurrentDevice current(ordinal_);
    check_cuda(cudaMemcpyAsync(known_.data(), found_.data(), known_.size() * sizeof(PixelPupil),
                               cudaMemcpyDeviceToDevice, stream_),
               "copying on it");
}

void DeviceRenderer::set_splats(const std::vector<SplatSource>& sources) {
    const CurrentDevice current(ordinal_);
    for (std::size_t i = 0; i < splats_.size(); ++i)
        splats_[i].set(i < sources.size() ? &sources[i] : nullptr, stream_);
}

void DeviceRenderer::clear_splats(int width, int height, int films) {
    const CurrentDevice current(ordinal_);
    for (DeviceGhosts& light : splats_) light.clear(width, height, films, stream_);
}

void DeviceRenderer::splat(const SampleRange& range, const PathSettings& settings) {
    const CurrentDevice current(ordinal_);
    for (DeviceGhosts& light : splats_) light.add(scene_, camera_, stop_, range, settings, stream_);
}

std::vector<SplatFilm> DeviceRenderer::download_splats() {
    const CurrentDevice current(ordinal_);
    std::vector<SplatFilm> films_on_host;
    for (const DeviceGhosts& light : splats_) films_on_host.push_back(light.download(stream_));
    return films_on_host;
}

std::vector<SplatFilm> DeviceRenderer::trace_splats(const std::vector<SplatSource>& sources, int films,
                                                    const SampleRange& range, const PathSettings& settings) {
    const CurrentDevice current(ordinal_);
    std::vector<SplatFilm> films_on_host;
    for (const SplatSource& source : sources) {
        DeviceGhosts light;
        light.set(&source, stream_);
        light.clear(camera_.width, camera_.height, films, stream_);
        light.add(scene_, camera_, stop_, range, settings, stream_);
        films_on_host.push_back(light.download(stream_));
    }
    return films_on_host;
}

FilmSums DeviceRenderer::sample_region(const FilmRegion& region, const SampleRange& range,
                                       const RenderSettings& settings, const PixelCounts& counts) {
    const CurrentDevice current(ordinal_);
    const FilmPart part{region.row, region.height, range.first, range.count};
    const auto columns = static_cast<std::size_t>(camera_.width), pixels = static_cast<std::size_t>(pixels_of(part));
    // Launches cover whole rows; pixels outside the region get no samples.
    std::vector<std::uint32_t> pixel_counts(pixels);
    for (int row = region.row; row < region.row + region.height; ++row)
        for (int column = region.column; column < region.column + region.width; ++column)
            pixel_counts[static_cast<std::size_t>(row - region.row) * columns + static_cast<std::size_t>(column)] =
                counts.of(region.index(column, row), range);
    sample_counts_.upload(pixel_counts.data(), pixels, stream_);
    region_sums_.resize(pixels);
    region_sums_.clear(stream_);
    launch(part, settings, region_sums_.data(), {sample_counts_.data(), 0}, film_pixels(),
           sharing_in(region, settings, counts), stop_.data());
    FilmSums rows(pixels), sums;
    region_sums_.download(rows.data(), stream_);
    stream_.wait("rendering");
    sums.reserve(region.pixels());
    for (int row = 0; row < region.height; ++row) {
        const auto first = rows.begin() + static_cast<std::ptrdiff_t>(row) * camera_.width + region.column;
        sums.insert(sums.end(), first, first + region.width);
    }
    return sums;
}

SplattedLight DeviceRenderer::splatted() const {
    SplattedLight light;
    for (std::size_t i = 0; i < splats_.size(); ++i) light.films[i] = splats_[i].view();
    return light;
}

void DeviceRenderer::reserve_film(std::int64_t pixels, bool merges) {
    const CurrentDevice current(ordinal_);
    const auto count = static_cast<std::size_t>(pixels);
    sums_.resize(count);
    exposure_.resize(3 * count);
    depth_.resize(count);
    if (merges) others_.resize(count);
    warm_up();
}

void DeviceRenderer::warm_up() {
    launch({0, 0, 0, 0}, {}, sums_.data(), {}, 0, {}, stop_.data());
    launch_develop({sums_.data(), 0, 0}, 1, exposure_.data(), depth_.data(), stream_);
    launch_merge(sums_.data(), others_.data(), 0, stream_);
}

FilmRegion DeviceRenderer::sharing_in(const FilmRegion& region, const RenderSettings& settings,
                                      const PixelCounts& counts) const {
    return shares_samples(camera_, settings, counts) ? region : FilmRegion{};
}

void DeviceRenderer::launch(const FilmPart& part, const RenderSettings& settings, PixelSum* sums,
                            const PixelCounts& counts, std::int64_t pixels, const FilmRegion& sharing,
                            const volatile int* stop) {
    CameraView camera = camera_;
    camera.dispersion.sharing = {sharing, camera.width};
    launch_render(
        {scene_.view(), scene_.bvh(), camera, sums, counts_.data(), stop, settings.path(), settings.seed,
         part.first_sample, part.sample_count, counts.counts, counts.taken, part.first_row, part.row_count,
         settings.layers.has(Layer::variance), settings.layers.has_any(kHalfLayers), balances_wavelengths(settings)},
        pixels, stream_);
}

void DeviceRenderer::clear_film(std::int64_t pixels) {
    const CurrentDevice current(ordinal_);
    sums_.resize(static_cast<std::size_t>(pixels));
    sums_.clear(stream_);
}

void DeviceRenderer::expose(const FilmPart& part, const RenderSettings& settings, const PixelCounts& counts,
                            std::atomic<std::int64_t>& done) {
    const CurrentDevice current(ordinal_);
    if (counts.counts) {
        const std::size_t pixels = static_cast<std::size_t>(part.row_count) * static_cast<std::size_t>(camera_.width);
        sample_counts_.upload(counts.counts, pixels, stream_);
    }
    // If pixels share samples, a running launch is always completed: neighbouring pixels must have equal numbers of
    // samples.
    const volatile int* const stop = shares_samples(camera_, settings, counts) ? stop_.never() : stop_.data();
    // Two launches are queued at any time, so that the GPU never waits for the host.
    std::array<CudaEvent, 3> ends;
    std::array<std::int64_t, 3> sizes{};
    LaunchPlan plan(part, camera_.width);
    ends[2].record(stream_);
    std::size_t started = 0, finished = 0;
    double launch_samples = kFirstSamples;
    const auto finish_one = [&] {
        const std::size_t i = finished++ % 3;
        ends[i].wait();
        done += sizes[i];
        const double ms = ends[i].ms_since(ends[(i + 2) % 3]);
        if (ms > 0) launch_samples = kLaunchTime_ms / ms * static_cast<double>(sizes[i]);
    };
    while (!plan.is_complete() && !stop_.is_raised()) {
        if (started - finished == 2) finish_one();
        const FilmPart piece = plan.next(launch_samples);
        const std::int64_t first = static_cast<std::int64_t>(piece.first_row - part.first_row) * camera_.width;
        const PixelCounts remaining{counts.counts ? sample_counts_.data() + first : nullptr,
                                    counts.taken + (piece.first_sample - part.first_sample)};
        launch(piece, settings, sums_.data() + first, remaining, pixels_of(piece),
               sharing_in(rows_of(piece), settings, counts), stop);
        const std::size_t i = started++ % 3;
        ends[i].record(stream_);
        sizes[i] = static_cast<std::int64_t>(piece.sample_count) * piece.row_count * camera_.width;
    }
    while (finished < started) finish_one();
}

void DeviceRenderer::add(const FilmPart& part, const RenderSettings& settings) {
    const CurrentDevice current(ordinal_);
    launch(part, settings, sums_.data(), {}, pixels_of(part), sharing_in(rows_of(part), settings, {}), stop_.data());
}

FilmView DeviceRenderer::film(const FilmControlVariates& control_variates) const {
    const auto rows = static_cast<int>(sums_.size() / static_cast<std::size_t>(camera_.width));
    return {sums_.data(), camera_.width, rows, control_variates, splatted()};
}

void DeviceRenderer::develop_codes(const FilmControlVariates& control_variates, double exposure_time_s, double iso,
                                   ToneCurve curve, std::uint8_t* codes) {
    const CurrentDevice current(ordinal_);
    codes_.resize(3 * sums_.size());
    launch_develop_codes(film(control_variates), exposure_time_s, iso, curve, codes_.data(), stream_);
    codes_.download(codes, stream_);
}

void DeviceRenderer::merge_film(const DeviceRenderer& other) {
    const CurrentDevice current(ordinal_);
    // The other film is cleared and filled in a stream of the other GPU, with which this stream is not synchronised.
    other.stream_.wait("rendering");
    others_.resize(other.sums_.size());
    check_cuda(cudaMemcpyPeerAsync(others_.data(), ordinal_, other.sums_.data(), other.ordinal_,
                                   other.sums_.size() * sizeof(PixelSum), stream_),
               "copying from GPU " + std::to_string(other.ordinal_));
    launch_merge(sums_.data(), others_.data(), static_cast<std::int64_t>(sums_.size()), stream_);
}

void DeviceRenderer::upload_film(const PixelSum* from, std::int64_t pixels) {
    const CurrentDevice current(ordinal_);
    sums_.upload(from, static_cast<std::size_t>(pixels), stream_);
}

void DeviceRenderer::download_film(PixelSum* to) {
    const CurrentDevice current(ordinal_);
    sums_.download(to, stream_);
    stream_.wait("copying the film from it");
}

void DeviceRenderer::develop_on_gpu(const FilmControlVariates& control_variates, double exposure_time_s,
                                    float* exposure, float* depth) {
    const CurrentDevice current(ordinal_);
    launch_develop(film(control_variates), exposure_time_s, exposure, depth, stream_);
}

void DeviceRenderer::develop(const FilmControlVariates& control_variates, double exposure_time_s, float* exposure,
                             float* depth) {
    const CurrentDevice current(ordinal_);
    exposure_.resize(3 * sums_.size());
    depth_.resize(sums_.size());
    develop_on_gpu(control_variates, exposure_time_s, exposure_.data(), depth_.data());
    exposure_.download(exposure, stream_);
    depth_.download(depth, stream_);
    stream_.wait("copying the picture from it");
}

void DeviceRenderer::count_samples(std::int64_t* counts) {
    const CurrentDevice current(ordinal_);
    DeviceArray<std::int64_t> counts_on_device(sums_.size());
    launch_count(sums_.data(), static_cast<std::int64_t>(sums_.size()), counts_on_device.data(), stream_);
    counts_on_device.download(counts, stream_);
    stream_.wait("counting samples");
}

LayerJob DeviceRenderer::layer_job(const FilmPart& part, std::uint32_t seed) const {
    return {scene_.view(),     scene_.bvh(),      camera_,        stop_.data(),  seed,
            part.first_sample, part.sample_count, part.first_row, part.row_count};
}

void DeviceRenderer::trace_layers(const FilmPart& part, std::uint32_t seed, LayerSum* sums,
                                  std::atomic<std::int64_t>& done) {
    const CurrentDevice current(ordinal_);
    const std::int64_t pixels = static_cast<std::int64_t>(part.row_count) * camera_.width;
    // About ten milliseconds per launch.
    constexpr std::int64_t kLaunchSamples = 1 << 24;
    const auto max_samples = static_cast<std::uint32_t>(std::max<std::int64_t>(1, kLaunchSamples / pixels));
    layer_sums_.resize(static_cast<std::size_t>(pixels));
    layer_sums_.clear(stream_);
    LayerJob job = layer_job(part, seed);
    for (std::uint32_t taken = 0; taken < part.sample_count && !stop_.is_raised(); taken += job.sample_count) {
        job.first_sample = part.first_sample + taken;
        job.sample_count = std::min(max_samples, part.sample_count - taken);
        launch_trace_layers(job, layer_sums_.data(), stream_);
        stream_.wait("tracing layers");
        done += job.sample_count * pixels;
    }
    layer_sums_.download(sums, stream_);
    stream_.wait("copying layers from it");
}

void DeviceRenderer::trace_pixel_centres(const FilmPart& part, PixelCentreSurface* surfaces) {
    const CurrentDevice current(ordinal_);
    pixel_centre_surfaces_.resize(static_cast<std::size_t>(part.row_count) * static_cast<std::size_t>(camera_.width));
    pixel_centre_surfaces_.clear(stream_);
    launch_trace_pixel_centres(layer_job(part, 0), pixel_centre_surfaces_.data(), stream_);
    pixel_centre_surfaces_.download(surfaces, stream_);
    stream_.wait("copying layers from it");
}

RenderCounts DeviceRenderer::counts() {
    const CurrentDevice current(ordinal_);
    RenderCounts counts{};
    counts_.download(&counts, stream_);
    stream_.wait("rendering");
    return counts;
}

void DeviceRenderer::clear_counts() {
    const CurrentDevice current(ordinal_);
    counts_.clear(stream_);
}

void DeviceRenderer::wait() const {
    const CurrentDevice current(ordinal_);
    stream_.wait("rendering");
}

}  // namespace realcam
