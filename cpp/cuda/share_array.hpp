#pragma once
#include "current_device.hpp"
#include "device_array.hpp"
#include "shared_device_array.hpp"

namespace realcam {

constexpr NumberType number_type_of(float) {
    return NumberType::float32;
}
constexpr NumberType number_type_of(double) {
    return NumberType::float64;
}
constexpr NumberType number_type_of(int) {
    return NumberType::int32;
}
constexpr NumberType number_type_of(unsigned char) {
    return NumberType::uint8;
}

/// Hands an array of GPU `ordinal` over to whoever will use it last. It holds as many numbers as the shape says, and
/// what fills it is done.
template <class T>
SharedDeviceArray share(DeviceArray<T> array, int ordinal, std::vector<std::int64_t> shape) {
    void* const data = array.data();
    auto* const owner = new DeviceArray<T>(std::move(array));
    // Other libraries call this from threads that have a device of their own, and while the process ends, when no call
    // succeeds any more.
    const auto free = [owner, ordinal](void*) {
        int before = ordinal;
        cudaGetDevice(&before);
        cudaSetDevice(ordinal);
        delete owner;
        if (before != ordinal) cudaSetDevice(before);
    };
    return {std::shared_ptr<void>(data, free), ordinal, number_type_of(T()), std::move(shape)};
}

}  // namespace realcam
