#include "foreign_memory.hpp"

#include "cuda_devices.hpp"
#include "current_device.hpp"

namespace realcam {

std::optional<int> gpu_of_address(const void* address) {
    if (const std::string why = why_no_cuda_device(); !why.empty()) throw DeviceError(why);
    cudaPointerAttributes attributes{};
    check_cuda(cudaPointerGetAttributes(&attributes, address), "asking whose memory an array is");
    const bool there = attributes.type == cudaMemoryTypeDevice || attributes.type == cudaMemoryTypeManaged;
    return there ? std::optional(attributes.device) : std::nullopt;
}

void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream) {
    const CurrentDevice current(ordinal);
    const std::string doing = "waiting for the program that made an array";
    if (stream)
        check_cuda(cudaStreamSynchronize(reinterpret_cast<cudaStream_t>(*stream)), doing);
    else
        check_cuda(cudaDeviceSynchronize(), doing);
}

}  // namespace realcam
