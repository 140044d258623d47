#include "cuda_devices.hpp"

#include "cuda_error.hpp"

namespace realcam {
namespace {

/// Returns the number of GPUs. Throws DeviceError if there is no driver or it is too old.
int device_count() {
    // If the driver is older than the runtime, `count` is not written; only the error code shows it.
    int count = 0;
    check_cuda(cudaGetDeviceCount(&count), "looking for GPUs");
    return count;
}

}  // namespace

std::vector<CudaDevice> cuda_devices() {
    std::vector<CudaDevice> devices;
    try {
        const int count = device_count();
        for (int i = 0; i < count; ++i) {
            cudaDeviceProp p{};
            check_cuda(cudaGetDeviceProperties(&p, i), "querying its properties");
            devices.push_back({i, p.name, p.major, p.minor, p.multiProcessorCount, p.totalGlobalMem});
        }
    } catch (const DeviceError&) {
        // why_no_cuda_device reports the cause to callers that need a GPU.
    }
    return devices;
}

std::string why_no_cuda_device() {
    try {
        return device_count() > 0 ? "" : "there is no NVIDIA GPU on this machine";
    } catch (const DeviceError& error) {
        return error.what();
    }
}

CudaDevice cuda_device(int ordinal) {
    const std::vector<CudaDevice> devices = cuda_devices();
    if (devices.empty()) throw DeviceError(why_no_cuda_device());
    if (ordinal < 0 || ordinal >= static_cast<int>(devices.size()))
        throw DeviceError("there is no GPU " + std::to_string(ordinal) + "; this machine has " +
                          std::to_string(devices.size()) + ", counted from 0");
    return devices[static_cast<std::size_t>(ordinal)];
}

}  // namespace realcam
