#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <string>
#include <vector>

#include "../camera/film_region.hpp"
#include "../render/collected_film.hpp"
#include "../render/render_settings.hpp"
#include "../render/sample_range.hpp"
#include "device_ghosts.hpp"
#include "device_scene.hpp"
#include "layer_kernels.hpp"
#include "render_kernel.hpp"
#include "stop_flag.hpp"

namespace realcam {

/// A range of rows of the picture, and of the samples of each of its pixels.
struct FilmPart {
    int first_row, row_count;
    std::uint32_t first_sample, sample_count;
};

/// One GPU with its copy of scene, camera and film. Made by make_on_device; used by one thread at a time, on which
/// every member function works with that GPU current; all of them throw DeviceError.
class DeviceRenderer {
public:
    explicit DeviceRenderer(int ordinal);

    int ordinal() const { return ordinal_; }
    /// The stop flag, which any thread may raise. Exposing kernels then end within the time of a sample, and the pixels
    /// may differ in their number of samples.
    StopFlag& stop_flag() { return stop_; }

    /// Copies a scene, what changes in it as objects move, or a camera. The host's copies may go afterwards.
    void set_scene(const RenderSpaceScene& scene, const SceneBvh& bvh);
    void set_instances(const RenderSpaceScene& scene, const SceneBvh& bvh);
    void set_camera(const CameraView& camera);
    /// Begins a new picture, whose pixels learn where light passes, or not.
    void forget_pupils(bool learns);
    /// Later samples know what those until now have found.
    void learn_pupils();

    /// Of the pictures that follow, at most kMostSplats, and empty films for them, so many for each (GhostFilmView).
    void set_splats(const std::vector<SplatSource>& sources);
    void clear_splats(int width, int height, int films);
    /// Starts to add the samples that belong to those of pixels.
    void splat(const SampleRange& range, const PathSettings& settings);
    std::vector<SplatFilm> download_splats();
    /// The samples that belong to those of pixels, in so many films each that no picture has.
    std::vector<SplatFilm> splats_apart(const std::vector<SplatSource>& sources, int films, const SampleRange& range,
                                        const PathSettings& settings);

    /// Makes room for all that exposing, merging and developing so many pixels takes. Throws OutOfDeviceMemory.
    void reserve_film(std::int64_t pixels, bool merges);

    /// Makes room for the sums of so many pixels, and sets them to 0.
    void clear_film(std::int64_t pixels);

    /// Adds samples to the film, which holds the part's rows. Returns when they are done or it was stopped. `done`
    /// counts samples. `counts`: of the part's pixels; those of `counts.taken` were taken before its samples.
    void expose(const FilmPart& part, const RenderSettings& settings, const PixelCounts& counts,
                std::atomic<std::int64_t>& done);

    /// Samples of a region into the host's memory, apart from the film. They are summed in the order of the whole film,
    /// whatever the region. `counts`: of the region's pixels.
    FilmSums expose_region(const FilmRegion& region, const SampleRange& range, const RenderSettings& settings,
                           const PixelCounts& counts);

    /// Starts to add samples, and returns at once.
    void add(const FilmPart& part, const RenderSettings& settings);

    /// Starts to develop the film as 8-bit sRGB, 3 per pixel, into memory of the host that it can write to.
    void develop_codes(const FilmBalance& balance, double exposure_time_s, double iso, ToneCurve curve,
                       std::uint8_t* codes);

    /// The stream in which all of this runs.
    cudaStream_t stream() const { return stream_; }

    /// Adds what another GPU has collected of the same pixels.
    void merge_film(const DeviceRenderer& other);

    /// Copies the sums of so many pixels to the film, or those of the whole film to the host.
    void upload_film(const PixelSum* from, std::int64_t pixels);
    void download_film(PixelSum* to);

    /// Starts to develop the film as exposure and depth into memory of this GPU, 3 and 1 numbers per pixel.
    void develop_here(const FilmBalance& balance, double exposure_time_s, float* exposure, float* depth);

    /// Exposure and depth of the film's pixels, into the host's memory.
    void develop(const FilmBalance& balance, double exposure_time_s, float* exposure, float* depth);

    /// The number of samples of each pixel, into the host's memory.
    void count_samples(std::int64_t* counts);

    /// What the samples of the part's rows see first, summed, and the surfaces in the middle rays of its pixels, into
    /// the host's memory. They end early where it was stopped, and then leave what is of no use. `done` counts samples.
    void see_layers(const FilmPart& part, std::uint32_t seed, LayerSum* sums, std::atomic<std::int64_t>& done);
    void see_middle_surfaces(const FilmPart& part, MiddleSurface* surfaces);

    /// What was counted since clear_counts, which does not wait for it.
    RenderCounts counts();
    void clear_counts();

    /// For all that was started.
    void wait() const;

private:
    /// Starts everything on no pixels: the GPU loads the code and makes room for what threads keep in memory.
    void rehearse();
    /// Starts to add samples to `sums`, those of the part's first row. `counts`: in this GPU's memory.
    /// `pixels`: by which the threads of a pixel are chosen. `sharing`: the part of the film whose pixels share
    /// samples.
    void launch(const FilmPart& part, const RenderSettings& settings, PixelSum* sums, const PixelCounts& counts,
                std::int64_t pixels, const FilmRegion& sharing, const volatile int* stop);

    /// The film that this GPU holds.
    FilmView film(const FilmBalance& balance) const;

    /// The region, if its pixels share samples; else an empty one.
    FilmRegion sharing_in(const FilmRegion& region, const RenderSettings& settings, const PixelCounts& counts) const;
    FilmRegion rows_of(const FilmPart& part) const { return {0, part.first_row, camera_.width, part.row_count}; }
    std::int64_t film_pixels() const { return static_cast<std::int64_t>(camera_.width) * camera_.height; }
    std::int64_t pixels_of(const FilmPart& part) const {
        return static_cast<std::int64_t>(part.row_count) * camera_.width;
    }

    SplattedLight splatted() const;

    LayerJob layer_job(const FilmPart& part, std::uint32_t seed) const;

    int ordinal_;
    StopFlag stop_;
    CudaStream stream_;
    DeviceScene scene_;
    DeviceArrays camera_arrays_;
    CameraView camera_{};
    std::array<DeviceGhosts, kMostSplats> splats_;
    DeviceArray<PixelSum> sums_, others_, region_sums_;
    DeviceArray<std::uint32_t> sample_counts_;
    DeviceArray<PixelPupil> known_, found_;  ///< of each pixel: PixelPupils
    DeviceArray<LayerSum> layer_sums_;
    DeviceArray<MiddleSurface> middle_surfaces_;
    DeviceArray<float> exposure_, depth_;
    DeviceArray<std::uint8_t> codes_;
    DeviceArray<RenderCounts> counts_;
};

}  // namespace realcam
