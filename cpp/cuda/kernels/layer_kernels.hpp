#pragma once
#include "../../render/layers/layer_sum.hpp"
#include "render_kernel.hpp"

namespace realcam {

/// Parameters of a launch of a layer kernel over some samples of some rows of pixels. All pointers are device pointers.
struct LayerJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    const volatile int* stop;  ///< if the value is not 0, no thread starts another sample
    std::uint32_t seed, first_sample, sample_count;
    int first_row, row_count;  ///< rows of the picture
};

/// Traces the samples to their first surfaces, and adds the results to the sums of the rows' pixels. Asynchronous.
/// Throws DeviceError.
void launch_trace_layers(const LayerJob& job, LayerSum* sums, cudaStream_t stream);

/// Finds the surfaces on the pixel-centre rays of the rows. Asynchronous. Throws DeviceError.
void launch_trace_pixel_centres(const LayerJob& job, PixelCentreSurface* surfaces, cudaStream_t stream);

}  // namespace realcam
