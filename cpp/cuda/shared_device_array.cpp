#include "shared_device_array.hpp"

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

}  // namespace realcam
