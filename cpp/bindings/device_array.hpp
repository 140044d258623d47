#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>

#include "../cuda/ray_arrays.hpp"
#include "../cuda/shared_device_array.hpp"

namespace realcam::bindings {

/// The array as a capsule of DLPack: `__dlpack__` of the Python array API standard, but for the stream.
pybind11::capsule dlpack_capsule(const SharedDeviceArray& array, const pybind11::object& max_version,
                                 const pybind11::object& dl_device, const pybind11::object& copy);

/// (N, 3) numbers in a GPU's memory that came as a Python object.
struct DeviceInput {
    ForeignNumbers numbers;  ///< ordinal -1: no numbers, so no GPU
    std::int64_t count;
    pybind11::object owner;  ///< keeps the memory
};

/// What `__cuda_array_interface__` or `__dlpack__` say of an object, complete by now; none where it lies on the host.
/// `name`: of the argument, for errors. Throws InputError and DeviceError.
std::optional<DeviceInput> device_input(const pybind11::object& array, const char* name);

}  // namespace realcam::bindings
