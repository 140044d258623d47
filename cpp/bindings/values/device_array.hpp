#pragma once
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>

#include "../../cuda/device/shared_device_array.hpp"
#include "../../cuda/rays/ray_arrays.hpp"

// Binary interface of DLPack 1.0 (https://dmlc.github.io/dlpack/latest/c_api.html), by which Python's array libraries
// share memory. Names and order of the fields are those of the standard.

namespace realcam::dlpack {

enum DeviceType : std::int32_t { kCpu = 1, kCuda = 2, kCudaManaged = 13 };

struct Device {
    std::int32_t device_type, device_id;
};

enum TypeCode : std::uint8_t { kInt = 0, kUInt = 1, kFloat = 2 };

struct DataType {
    std::uint8_t code, bits;
    std::uint16_t lanes;
};

struct Tensor {
    void* data;
    Device device;
    std::int32_t ndim;
    DataType dtype;
    std::int64_t* shape;
    std::int64_t* strides;  ///< in elements, not bytes; may be null for C order
    std::uint64_t byte_offset;
};

/// Content of capsules named "dltensor".
struct ManagedTensor {
    Tensor tensor;
    void* manager_context;
    void (*deleter)(ManagedTensor* self);
};
inline constexpr const char* kName = "dltensor";

struct Version {
    std::uint32_t major, minor;
};

inline constexpr std::uint64_t kReadOnly = 1, kIsCopied = 2;

/// Content of capsules named "dltensor_versioned", for consumers of version 1.
struct ManagedTensorVersioned {
    Version version;
    void* manager_context;
    void (*deleter)(ManagedTensorVersioned* self);
    std::uint64_t flags;
    Tensor tensor;
};
inline constexpr const char* kVersionedName = "dltensor_versioned";

}  // namespace realcam::dlpack

namespace realcam::bindings {

/// Returns a DLPack capsule of the array. Arguments as those of `__dlpack__` in the Python array API standard, without
/// `stream`. Throws BufferError if the array cannot be exported to that device, or not without a copy.
pybind11::capsule dlpack_capsule(const SharedDeviceArray& array, const pybind11::object& max_version,
                                 const pybind11::object& dl_device, const pybind11::object& copy);

/// Array of shape (N, 3) in a GPU's memory, passed as a Python object.
struct DeviceInput {
    ForeignNumbers numbers;  ///< ordinal -1: the array is empty and belongs to no GPU
    std::int64_t count;
    pybind11::object owner;  ///< keeps the memory alive
};

/// Reads a GPU array through `__cuda_array_interface__` or `__dlpack__` and waits until all writes to it have
/// completed. Returns std::nullopt if it is in host memory. `name`: name of the argument, for errors. Throws InputError
/// and DeviceError.
std::optional<DeviceInput> device_input(const pybind11::object& array, const char* name);

}  // namespace realcam::bindings
