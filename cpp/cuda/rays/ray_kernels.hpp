#pragma once
#include <cuda_runtime.h>

#include "../../camera/ray_request.hpp"
#include "../../optics/trace/trace_request.hpp"

namespace realcam {

// Launch kernels asynchronously for requests whose arrays are in the current device's memory. Throw DeviceError if a
// kernel cannot be launched.

/// Traces rays through a lens, in double or in float.
void launch_trace(const TraceRequest<double>& request, cudaStream_t stream);
void launch_trace(const TraceRequest<float>& request, cudaStream_t stream);
/// Generates camera rays.
void launch_generate(const RayRequest& request, cudaStream_t stream);

}  // namespace realcam
