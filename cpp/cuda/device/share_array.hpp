#pragma once
#include "current_device.hpp"
#include "device_array.hpp"
#include "shared_device_array.hpp"

namespace realcam {

/// Returns the NumberType of the argument's type.
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

/// Transfers an array of GPU `ordinal` to shared ownership. It must have as many elements as the shape, and all writes
/// to it must be complete. Throws DeviceError.
template <class T>
SharedDeviceArray share(DeviceArray<T> array, int ordinal, std::vector<std::int64_t> shape) {
    void* const data = array.data();
    // The array may be freed by another library, on a thread with a different current device.
    const std::shared_ptr<void> owner = make_on_device<DeviceArray<T>>(ordinal, std::move(array));
    return {std::shared_ptr<void>(owner, data), ordinal, number_type_of(T()), std::move(shape)};
}

}  // namespace realcam
