#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "../../error.hpp"

namespace realcam {

/// A GPU of an architecture that this build has no code for.
class UnsupportedGpu : public DeviceError {
    using DeviceError::DeviceError;
};

/// A GPU of this machine.
struct CudaDevice {
    int ordinal;            ///< CUDA's index
    std::string name;  ///< for example "NVIDIA H100 80GB HBM3"
    int major, minor;       ///< compute capability
    int multiprocessors;
    std::size_t memory;     ///< bytes
};

/// Returns the usable GPUs; empty if there is no driver or it is too old.
std::vector<CudaDevice> cuda_devices();

/// Returns the reason why cuda_devices() is empty, as the message of a DeviceError; empty if there is a usable GPU.
std::string why_no_cuda_device();

/// Returns the GPU with this CUDA ordinal. Throws DeviceError if it does not exist.
CudaDevice cuda_device(int ordinal);

}  // namespace realcam
