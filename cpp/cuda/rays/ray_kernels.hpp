#pragma once
#include <cuda_runtime.h>

#include "../../camera/ray_request.hpp"
#include "../../optics/trace/trace_request.hpp"

namespace realcam {

/// Launch requests whose arrays are in the current device's memory. Throw DeviceError if a kernel cannot be launched.
void launch_trace(const TraceRequest<double>& request, cudaStream_t stream);
void launch_trace(const TraceRequest<float>& request, cudaStream_t stream);
void launch_generate(const RayRequest& request, cudaStream_t stream);

}  // namespace realcam
