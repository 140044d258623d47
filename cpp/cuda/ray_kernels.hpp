#pragma once
#include <cuda_runtime.h>

#include "../camera/ray_request.hpp"
#include "../optics/trace/trace_request.hpp"

namespace realcam {

/// Requests whose arrays lie on the current device. Throw DeviceError where they cannot be started.
void launch_trace(const TraceRequest<double>& request, cudaStream_t stream);
void launch_trace(const TraceRequest<float>& request, cudaStream_t stream);
void launch_generate(const RayRequest& request, cudaStream_t stream);

}  // namespace realcam
