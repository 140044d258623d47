#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "../error.hpp"

namespace realcam {

/// A GPU of an architecture that this build has no code for.
class UnsupportedGpu : public DeviceError {
    using DeviceError::DeviceError;
};

struct CudaDevice {
    int ordinal;
    std::string name;       ///< as "NVIDIA H100 80GB HBM3"
    int major, minor;       ///< compute capability
    int multiprocessors;
    std::size_t memory;     ///< bytes
};

/// The GPUs that can be used: none where there is no driver, or where it is too old.
std::vector<CudaDevice> cuda_devices();

/// Why that list is empty, as a DeviceError's message; empty where there are some.
std::string why_no_cuda_device();

/// The one of that ordinal. Throws DeviceError where there is none.
CudaDevice cuda_device(int ordinal);

}  // namespace realcam
