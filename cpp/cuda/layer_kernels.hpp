#pragma once
#include "../render/layer_sum.hpp"
#include "render_kernel.hpp"

namespace realcam {

/// One launch over some rows of pixels. All pointers are the device's.
struct LayerJob {
    SceneView scene;
    SceneBvhView bvh;
    CameraView camera;
    const volatile int* stop;  ///< not 0: no thread begins another sample
    std::uint32_t seed, first_sample, sample_count;
    int first_row, row_count;  ///< of the picture
};

/// Adds what samples see first to the sums of the rows, row by row. Throws DeviceError.
void launch_see_layers(const LayerJob& job, LayerSum* sums, cudaStream_t stream);

/// The surfaces in the middle rays of the rows' pixels. Throws DeviceError.
void launch_see_middle_surfaces(const LayerJob& job, MiddleSurface* surfaces, cudaStream_t stream);

}  // namespace realcam
