#pragma once
#include <cuda_runtime.h>

#include <string>

#include "cuda_devices.hpp"

namespace realcam {

/// An allocation exceeded the GPU's free memory; a smaller one may succeed.
class OutOfDeviceMemory : public DeviceError {
    using DeviceError::DeviceError;
};

/// Throws DeviceError if a call of the CUDA runtime failed. `doing`: the operation, such as "copying the scene to it",
/// where "it" is the GPU; part of the message.
inline void check_cuda(cudaError_t code, const std::string& doing) {
    if (code == cudaSuccess) return;
    cudaGetLastError();  // clears the error, so that it is not reported again if the device is still usable
    const std::string cause = std::string(cudaGetErrorString(code)) + " (" + cudaGetErrorName(code) + ")";
    switch (code) {
        case cudaErrorNoKernelImageForDevice:
            throw UnsupportedGpu("this build of realcam has no code for the GPU's architecture: " + cause +
                                 "; build it with CMAKE_CUDA_ARCHITECTURES=native, or use device=\"cpu\"");
        case cudaErrorInsufficientDriver:
            throw DeviceError("there is no NVIDIA driver, or it is older than the CUDA runtime " +
                              std::to_string(CUDART_VERSION / 1000) + "." + std::to_string(CUDART_VERSION % 1000 / 10) +
                              " of this build; use a newer one, or device=\"cpu\"");
        case cudaErrorMemoryAllocation: throw OutOfDeviceMemory("the GPU is out of memory while " + doing);
        case cudaErrorNoDevice: throw DeviceError("there is no NVIDIA GPU, or the driver is not running: " + cause);
        default: throw DeviceError("the GPU failed while " + doing + ": " + cause);
    }
}

}  // namespace realcam
