#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>

#include "../cuda/ray_arrays.hpp"
#include "../cuda/shared_device_array.hpp"

namespace realcam::bindings {

/// Returns a DLPack capsule of the array: `__dlpack__` of the Python array API standard, except for its `stream`
/// argument.
pybind11::capsule dlpack_capsule(const SharedDeviceArray& array, const pybind11::object& max_version,
                                 const pybind11::object& dl_device, const pybind11::object& copy);

/// Array of shape (N, 3) in a GPU's memory, passed as a Python object.
struct DeviceInput {
    ForeignNumbers numbers;  ///< ordinal -1: the array is empty and belongs to no GPU
    std::int64_t count;
    pybind11::object owner;  ///< keeps the memory alive
};

/// Reads a GPU array through `__cuda_array_interface__` or `__dlpack__` and waits until its contents are complete;
/// std::nullopt if it is in host memory. `name`: name of the argument, for errors. Throws InputError and DeviceError.
std::optional<DeviceInput> device_input(const pybind11::object& array, const char* name);

}  // namespace realcam::bindings
