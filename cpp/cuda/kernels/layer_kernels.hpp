#pragma once
#include "../../render/layers/layer_sum.hpp"
#include "render_kernel.hpp"

namespace realcam {

/// Parameters of a launch over some rows of pixels. All pointers are device pointers.
struct LayerJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    const volatile int* stop;  ///< if not 0, no thread starts another sample
    std::uint32_t seed, first_sample, sample_count;
    int first_row, row_count;  ///< rows of the picture
};

/// Adds the samples' first hits to the sums of the rows. Throws DeviceError.
void launch_see_layers(const LayerJob& job, LayerSum* sums, cudaStream_t stream);

/// Traces the first hits of the pixel-centre rays of the rows. Throws DeviceError.
void launch_see_pixel_centre_surfaces(const LayerJob& job, PixelCentreSurface* surfaces, cudaStream_t stream);

}  // namespace realcam
