#include "shared_device_array.hpp"

#include "cuda_devices.hpp"
#include "current_device.hpp"
#include "share_array.hpp"

namespace realcam {

void SharedDeviceArray::download(void* to) const {
    if (bytes() == 0) return;
    const CurrentDevice current(ordinal_);
    check_cuda(cudaMemcpy(to, data(), bytes(), cudaMemcpyDeviceToHost), "copying from it");
}

SharedDeviceArray SharedDeviceArray::duplicate() const {
    const CurrentDevice current(ordinal_);
    DeviceArray<unsigned char> other(bytes());
    if (bytes() > 0) {
        check_cuda(cudaMemcpy(other.data(), data(), bytes(), cudaMemcpyDeviceToDevice), "copying an array");
        // A copy within the device may return before it is complete.
        check_cuda(cudaDeviceSynchronize(), "copying an array");
    }
    const SharedDeviceArray copy = share(std::move(other), ordinal_, {});
    return {copy.memory(), ordinal_, type_, shape_};
}

std::optional<int> gpu_of_address(const void* address) {
    if (const std::string why = why_no_cuda_device(); !why.empty()) throw DeviceError(why);
    cudaPointerAttributes attributes{};
    check_cuda(cudaPointerGetAttributes(&attributes, address), "querying the location of an array");
    const bool is_on_gpu = attributes.type == cudaMemoryTypeDevice || attributes.type == cudaMemoryTypeManaged;
    return is_on_gpu ? std::optional(attributes.device) : std::nullopt;
}

void wait_for_gpu(int ordinal, std::optional<std::uintptr_t> stream) {
    const CurrentDevice current(ordinal);
    const std::string doing = "waiting for the library that owns an array";
    if (stream)
        check_cuda(cudaStreamSynchronize(reinterpret_cast<cudaStream_t>(*stream)), doing);
    else
        check_cuda(cudaDeviceSynchronize(), doing);
}

}  // namespace realcam
