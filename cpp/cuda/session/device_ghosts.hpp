#pragma once
#include <algorithm>
#include <vector>

#include "../../render/film/film_sums.hpp"
#include "../../render/path/sample_range.hpp"
#include "../device/cuda_stream.hpp"
#include "../device/device_array.hpp"
#include "../device/stop_flag.hpp"
#include "../kernels/ghost_kernels.hpp"
#include "device_scene.hpp"

namespace realcam {

/// Source of splatted light (GhostLight). The arrays of the view are in host memory.
struct SplatSource {
    GhostView view;
    double units_per_lux;  ///< unit of GhostSum (ghost_units_per_lux)
};

/// Device copy of one SplatSource with its film, on one GPU. All functions throw DeviceError.
class DeviceGhosts {
public:
    /// Copies a source to the device; the host's copy may be freed afterwards. Null: the picture has no such source.
    void set(const SplatSource* source, CudaStream& stream) {
        arrays_.restart();
        view_ = {};
        if (!source) return;
        units_per_lux_ = source->units_per_lux;
        view_ = with_copied_arrays(
            source->view, [&](const auto* from, std::size_t count) { return arrays_.copy(from, count, stream); });
    }

    /// Allocates and clears `films` films (GhostFilmView) of width x height pixels.
    void clear(int width, int height, int films, CudaStream& stream) {
        width_ = width;
        height_ = height;
        films_ = films;
        const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        sums_.resize(view_.path_count > 0 ? static_cast<std::size_t>(films) * pixels : 0);
        blocks_done_.resize(static_cast<std::size_t>(films));
        sums_.clear(stream);
        blocks_done_.clear(stream);
    }

    /// Launches the samples that correspond to a range of the pixels' samples. Stops launching when the stop flag is
    /// raised: a great number of even empty launches would take minutes.
    void add(const DeviceScene& scene, const CameraView& camera, const StopFlag& stop, const SampleRange& range,
             const PathSettings& settings, CudaStream& stream) {
        if (sums_.size() == 0) return;
        constexpr std::uint64_t kBlocksPerLaunch = 1 << 14;
        const GhostBlocks blocks = ghost_blocks(camera, range, view_);
        const auto launch = view_.light == GhostLight::of_objects ? launch_gather_ghosts
                            : view_.light == GhostLight::direct   ? launch_trace_lights
                                                                  : launch_splat_ghosts;
        for (std::uint64_t block = blocks.first; block < blocks.end && !stop.is_raised(); block += kBlocksPerLaunch)
            launch({scene.view(), scene.bvh(), camera, view_, stop.data(), sums_.data(), films_, blocks_done_.data(),
                    block, static_cast<std::uint32_t>(std::min(kBlocksPerLaunch, blocks.end - block)), range.seed,
                    settings, units_per_lux_},
                   stream);
    }

    /// Returns a view of the films, in the GPU's memory.
    GhostFilmView view() const {
        if (sums_.size() == 0) return {};
        return {view_.light, sums_.data(), films_, units_per_lux_, blocks_done_.data(), width_, height_};
    }

    /// Copies all films to the host. Synchronous.
    SplatFilm download(const CudaStream& stream) const {
        SplatFilm film{view_.light,
                       std::vector<GhostSum>(sums_.size()),
                       std::vector<unsigned long long>(blocks_done_.size()),
                       units_per_lux_,
                       width_,
                       height_};
        sums_.download(film.sums.data(), stream);
        blocks_done_.download(film.blocks.data(), stream);
        stream.wait("copying ghosts from it");
        return film;
    }

private:
    DeviceArrays arrays_;
    GhostView view_{};
    double units_per_lux_ = 1;
    int width_ = 0, height_ = 0, films_ = 1;
    DeviceArray<GhostSum> sums_;
    DeviceArray<unsigned long long> blocks_done_;
};

}  // namespace realcam
