#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <vector>

#include "../../camera/effects/dispersion/dispersion_view.hpp"
#include "../../render/film/film_sums.hpp"
#include "../../render/path/sample_range.hpp"
#include "../../render/settings/render_settings.hpp"
#include "../device/stop_flag.hpp"
#include "../kernels/layer_kernels.hpp"
#include "../kernels/render_kernel.hpp"
#include "device_ghosts.hpp"
#include "device_scene.hpp"

namespace realcam {

/// Range of rows of the picture and of samples of their pixels.
struct FilmPart {
    int first_row, row_count;
    std::uint32_t first_sample, sample_count;
};

/// One GPU with its copies of scene, camera and film. Created by make_on_device and used by one thread at a time; every
/// member function makes that GPU current and may throw DeviceError.
class DeviceRenderer {
public:
    explicit DeviceRenderer(int ordinal);

    int ordinal() const { return ordinal_; }
    /// Stop flag, which any thread may raise. Render kernels then end within the time of a sample, and pixels may
    /// differ in their numbers of samples.
    StopFlag& stop_flag() { return stop_; }

    // Copy a scene, its instance transforms, or a camera to the GPU. The host's copies may be freed afterwards.
    void set_scene(const RenderSpaceScene& scene, const SceneBvh& bvh);
    void set_instances(const RenderSpaceScene& scene, const SceneBvh& bvh);
    void set_camera(const CameraView& camera);
    /// Resets the learned pupils (PixelPupil) for a new picture. `learns`: true if its pixels learn their pupils.
    void forget_pupils(bool learns);
    /// Makes the pupil points that passed in all samples so far available to later samples (PixelPupils).
    void learn_pupils();

    /// Sets the sources of splatted light for the following pictures, at most kMaxGhostViews.
    void set_splats(const std::vector<SplatSource>& sources);
    /// Allocates `films` empty films of width x height pixels for each source (GhostFilmView).
    void clear_splats(int width, int height, int films);
    /// Launches the splatted light's samples that correspond to a range of the pixels' samples.
    void splat(const SampleRange& range, const PathSettings& settings);
    /// Returns the films of all sources in host memory.
    std::vector<SplatFilm> download_splats();
    /// Traces splatted light for a range of samples into separate films, `films` for each source, and leaves the
    /// picture's films unchanged.
    std::vector<SplatFilm> trace_splats(const std::vector<SplatSource>& sources, int films, const SampleRange& range,
                                        const PathSettings& settings);

    /// Reserves memory for exposing, merging and developing this many pixels. Throws OutOfDeviceMemory.
    void reserve_film(std::int64_t pixels, bool merges);

    /// Allocates the sums of this many pixels and sets them to 0.
    void clear_film(std::int64_t pixels);

    /// Adds samples to the film, which holds the rows of `part`. Returns when they are done or rendering was stopped.
    /// `done` counts samples. `counts`: sample counts of the part's pixels, including `counts.taken` samples before the
    /// part's first one.
    void expose(const FilmPart& part, const RenderSettings& settings, const PixelCounts& counts,
                std::atomic<std::int64_t>& done);

    /// Renders the samples of a region into host memory, separately from the film. The order of summation is that of
    /// the whole film, whatever the region. `counts`: of the region's pixels.
    FilmSums sample_region(const FilmRegion& region, const SampleRange& range, const RenderSettings& settings,
                           const PixelCounts& counts);

    /// Adds samples to the film asynchronously, in one launch: for live frames.
    void add(const FilmPart& part, const RenderSettings& settings);

    /// Develops the film asynchronously to 8-bit sRGB, 3 values per pixel, into pinned host memory.
    void develop_codes(const FilmControlVariates& control_variates, double exposure_time_s, double iso, ToneCurve curve,
                       std::uint8_t* codes);

    /// Stream in which all work of this renderer runs.
    cudaStream_t stream() const { return stream_; }

    /// Adds another GPU's film of the same pixels to this film.
    void merge_film(const DeviceRenderer& other);

    /// Copies the sums of `pixels` pixels from the host to the film.
    void upload_film(const PixelSum* from, std::int64_t pixels);
    /// Copies the whole film to the host.
    void download_film(PixelSum* to);

    /// Develops the film asynchronously to exposure and depth, 3 and 1 values per pixel, in this GPU's memory.
    void develop_on_gpu(const FilmControlVariates& control_variates, double exposure_time_s, float* exposure,
                        float* depth);

    /// Develops the film to exposure and depth in host memory. Synchronous.
    void develop(const FilmControlVariates& control_variates, double exposure_time_s, float* exposure, float* depth);

    /// Writes the number of samples of each pixel to host memory.
    void count_samples(std::int64_t* counts);

    // The next two functions write their results to host memory. If rendering is stopped, they end early, and the
    // results are unusable.

    /// Traces the part's samples to their first surfaces, and writes the sums of each pixel. `done`: incremented by the
    /// number of samples.
    void trace_layers(const FilmPart& part, std::uint32_t seed, LayerSum* sums, std::atomic<std::int64_t>& done);
    /// Finds the surfaces on the pixel-centre rays of the part's rows.
    void trace_pixel_centres(const FilmPart& part, PixelCentreSurface* surfaces);

    /// Returns the counts since clear_counts(), which is asynchronous.
    RenderCounts counts();
    /// Sets all counts to 0.
    void clear_counts();

    /// Waits for all queued work.
    void wait() const;

private:
    /// Launches every kernel on zero pixels, so that the GPU loads the code and reserves the threads' local memory.
    void warm_up();
    /// Launches samples asynchronously, which are added to `sums`; its first element is the first pixel of the part.
    /// `counts`: of the part's pixels, in this GPU's memory. `pixels`: the number of pixels by which the threads per
    /// pixel are chosen. `sharing`: the region of the film whose pixels share samples.
    void launch(const FilmPart& part, const RenderSettings& settings, PixelSum* sums, const PixelCounts& counts,
                std::int64_t pixels, const FilmRegion& sharing, const volatile int* stop);

    /// View of the film in this GPU's memory.
    FilmView film(const FilmControlVariates& control_variates) const;

    /// Returns the region if its pixels share samples; otherwise an empty one.
    FilmRegion sharing_in(const FilmRegion& region, const RenderSettings& settings, const PixelCounts& counts) const;
    FilmRegion rows_of(const FilmPart& part) const { return {0, part.first_row, camera_.width, part.row_count}; }
    std::int64_t film_pixels() const { return static_cast<std::int64_t>(camera_.width) * camera_.height; }
    std::int64_t pixels_of(const FilmPart& part) const {
        return static_cast<std::int64_t>(part.row_count) * camera_.width;
    }

    /// Films of splatted light in this GPU's memory.
    SplattedLight splatted() const;

    /// Parameters of a layer kernel for a part of the picture.
    LayerJob layer_job(const FilmPart& part, std::uint32_t seed) const;

    int ordinal_;
    StopFlag stop_;
    CudaStream stream_;
    DeviceScene scene_;
    DeviceArrays camera_arrays_;
    CameraView camera_{};
    std::array<DeviceGhosts, kMaxGhostViews> splats_;
    DeviceArray<PixelSum> sums_;  ///< the film
    DeviceArray<PixelSum> others_;  ///< copy of another GPU's film
    DeviceArray<PixelSum> region_sums_;  ///< of sample_region
    DeviceArray<std::uint32_t> sample_counts_;  ///< copy of PixelCounts::counts
    DeviceArray<PixelPupil> known_, found_;  ///< learned pupils, one for each pixel (PixelPupils)
    DeviceArray<LayerSum> layer_sums_;
    DeviceArray<PixelCentreSurface> pixel_centre_surfaces_;
    DeviceArray<float> exposure_, depth_;
    DeviceArray<std::uint8_t> codes_;
    DeviceArray<RenderCounts> counts_;
};

}  // namespace realcam
