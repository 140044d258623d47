#include <pybind11/stl.h>

#include "../../cuda/device/shared_device_array.hpp"
#include "../../error.hpp"
#include "../unlocked.hpp"
#include "device_array.hpp"

namespace realcam::bindings {

namespace py = pybind11;

namespace {

dlpack::DataType type_of(NumberType type) {
    switch (type) {
        case NumberType::float32: return {dlpack::kFloat, 32, 1};
        case NumberType::float64: return {dlpack::kFloat, 64, 1};
        case NumberType::int32: return {dlpack::kInt, 32, 1};
        case NumberType::uint8: return {dlpack::kUInt, 8, 1};
    }
    return {};
}

/// Content of a capsule with its owner. The consumer frees it through the deleter, which must not touch Python objects:
/// it may run without the GIL, or after the interpreter has ended.
template <class Managed>
struct Exported {
    Managed managed{};
    std::shared_ptr<void> memory;
    std::vector<std::int64_t> shape, strides;

    Exported(std::shared_ptr<void> owned, dlpack::Device device, NumberType type, std::vector<std::int64_t> extents)
        : memory(std::move(owned)), shape(std::move(extents)), strides(shape.size()) {
        std::int64_t stride = 1;
        for (std::size_t i = shape.size(); i-- > 0; stride *= shape[i]) strides[i] = stride;
        managed.manager_context = this;
        managed.deleter = [](Managed* self) { delete static_cast<Exported*>(self->manager_context); };
        managed.tensor = {memory.get(),   device, static_cast<std::int32_t>(shape.size()), type_of(type), shape.data(),
                          strides.data(), 0};
    }
};

/// Capsule destructor: frees a tensor that was not consumed. A consumer renames the capsule.
void free_capsule(PyObject* capsule, const char* name, void (*free)(void*)) {
    if (PyCapsule_IsValid(capsule, name)) free(PyCapsule_GetPointer(capsule, name));
}

void free_plain(PyObject* capsule) {
    free_capsule(capsule, dlpack::kName, [](void* p) {
        auto* managed = static_cast<dlpack::ManagedTensor*>(p);
        managed->deleter(managed);
    });
}

void free_versioned(PyObject* capsule) {
    free_capsule(capsule, dlpack::kVersionedName, [](void* p) {
        auto* managed = static_cast<dlpack::ManagedTensorVersioned*>(p);
        managed->deleter(managed);
    });
}

template <class Managed>
py::capsule capsule_of(std::unique_ptr<Exported<Managed>> exported, const char* name, PyCapsule_Destructor destructor) {
    PyObject* capsule = PyCapsule_New(&exported->managed, name, destructor);
    if (!capsule) throw py::error_already_set();
    (void)exported.release();
    return py::reinterpret_steal<py::capsule>(capsule);
}

std::shared_ptr<void> host_copy(const SharedDeviceArray& array) {
    const std::shared_ptr<void> memory(::operator new(array.bytes()), [](void* p) { ::operator delete(p); });
    const Unlocked unlocked;
    array.download(memory.get());
    return memory;
}

}  // namespace

py::capsule dlpack_capsule(const SharedDeviceArray& array, const py::object& max_version, const py::object& dl_device,
                           const py::object& copy) {
    const std::pair<int, int> own_device(dlpack::kCuda, array.ordinal());
    const auto requested = dl_device.is_none() ? own_device : dl_device.cast<std::pair<int, int>>();
    const bool to_host = requested.first == dlpack::kCpu;
    if (!to_host && requested != own_device)
        throw py::buffer_error("a DeviceArray can be exported only to its own GPU or to the host");
    const bool must_copy = !copy.is_none() && copy.cast<bool>(), must_not_copy = !copy.is_none() && !must_copy;
    if (to_host && must_not_copy)
        throw py::buffer_error("a DeviceArray can be exported to the host only as a copy; copy must not be False");

    std::shared_ptr<void> memory = array.memory();
    if (to_host)
        memory = host_copy(array);
    else if (must_copy)
        memory = array.duplicate().memory();
    const dlpack::Device device{requested.first, to_host ? 0 : array.ordinal()};
    if (max_version.is_none() || max_version.cast<py::tuple>()[0].cast<int>() < 1)
        return capsule_of(
            std::make_unique<Exported<dlpack::ManagedTensor>>(std::move(memory), device, array.type(), array.shape()),
            dlpack::kName, free_plain);
    auto exported = std::make_unique<Exported<dlpack::ManagedTensorVersioned>>(std::move(memory), device, array.type(),
                                                                               array.shape());
    exported->managed.version = {1, 0};
    exported->managed.flags = to_host || must_copy ? dlpack::kIsCopied : 0;
    return capsule_of(std::move(exported), dlpack::kVersionedName, free_versioned);
}

namespace py = pybind11;

namespace {

/// Description of a foreign GPU array.
struct Layout {
    std::vector<std::int64_t> shape;
    std::optional<std::vector<std::int64_t>> strides;  ///< in bytes; std::nullopt: C order
    NumberType type;
    std::uintptr_t address;
};

[[noreturn]] void refuse_type(const std::string& name, const std::string& type) {
    throw InputError(name + " lies on a GPU and holds numbers of type " + type + "; expected float64 or float32");
}

/// Returns the number of rows N of an array of shape (N, 3) in C order. Strides of extents of 0 or 1 are ignored.
std::int64_t count_of(const Layout& layout, const std::string& name) {
    if (layout.shape.size() != 2 || layout.shape[1] != 3 || layout.shape[0] < 0)
        throw InputError(name + " lies on a GPU, and must be of shape (N, 3)");
    const std::int64_t count = layout.shape[0], size = static_cast<std::int64_t>(size_of(layout.type));
    if (layout.strides && count > 0) {
        const std::vector<std::int64_t>& strides = *layout.strides;
        if (strides.size() != 2 || strides[1] != size || (count > 1 && strides[0] != 3 * size))
            throw InputError(name +
                             " lies on a GPU and is not contiguous in C order; pass a contiguous copy "
                             "(.contiguous() of torch, cupy.ascontiguousarray)");
    }
    if (layout.address % size_of(layout.type) != 0)
        throw InputError(name + " lies on a GPU at an address that is not a multiple of the size of its numbers");
    return count;
}

DeviceInput input_of(const Layout& layout, int ordinal, const std::string& name, const py::object& owner) {
    const std::int64_t count = count_of(layout, name);
    return {{reinterpret_cast<const void*>(layout.address), ordinal, layout.type}, count, owner};
}

NumberType type_of_text(const std::string& type, const std::string& name) {
    if (type == "<f8") return NumberType::float64;
    if (type == "<f4") return NumberType::float32;
    refuse_type(name, "\"" + type + "\"");
}

bool is_set(const py::dict& interface, const char* key) {
    return interface.contains(key) && !interface[key].is_none();
}

/// Work that must complete before an array may be read.
struct Readiness {
    bool wait;  ///< false: no work is pending
    std::optional<std::uintptr_t> stream;  ///< the stream to wait for; std::nullopt: all work of the GPU
};

/// Without a stream, version 3 and later of the interface guarantee that no work is pending; earlier versions guarantee
/// nothing.
Readiness readiness_of(const py::dict& interface) {
    if (!is_set(interface, "version") || interface["version"].cast<int>() < 3) return {true, std::nullopt};
    if (!is_set(interface, "stream")) return {false, std::nullopt};
    return {true, interface["stream"].cast<std::uintptr_t>()};
}

std::pair<Layout, Readiness> read_interface(const py::dict& interface, const std::string& name) {
    try {
        const Layout layout{interface["shape"].cast<std::vector<std::int64_t>>(),
                            is_set(interface, "strides")
                                ? std::optional(interface["strides"].cast<std::vector<std::int64_t>>())
                                : std::nullopt,
                            type_of_text(interface["typestr"].cast<std::string>(), name),
                            interface["data"].cast<py::tuple>()[0].cast<std::uintptr_t>()};
        return {layout, readiness_of(interface)};
    } catch (const py::error_already_set& error) {
        throw InputError(name + " has a __cuda_array_interface__ that cannot be read: " + error.what());
    } catch (const py::cast_error&) {
        throw InputError(name + " has a __cuda_array_interface__ with an entry of the wrong type");
    }
}

/// Reads a CUDA array interface (https://numba.readthedocs.io/en/stable/cuda/cuda_array_interface.html).
DeviceInput from_interface(const py::object& array, const py::dict& interface, const std::string& name) {
    if (is_set(interface, "mask")) throw InputError(name + " has a mask; expected an array without one");
    const auto [layout, ready] = read_interface(interface, name);
    DeviceInput input = input_of(layout, -1, name, array);
    if (input.count == 0) return input;
    const std::optional<int> ordinal = gpu_of_address(input.numbers.data);
    if (!ordinal) throw InputError(name + " claims to lie on a GPU, but its address is in no GPU's memory");
    input.numbers.ordinal = *ordinal;
    const Unlocked unlocked;
    if (ready.wait) wait_for_gpu(*ordinal, ready.stream);
    return input;
}

std::string text_of(const dlpack::DataType& type) {
    const char* kinds[] = {"int", "uint", "float"};
    return (type.code < 3 ? kinds[type.code] : "code " + std::to_string(type.code) + " of DLPack, bits ") +
           std::to_string(type.bits) + (type.lanes == 1 ? "" : " x " + std::to_string(type.lanes));
}

Layout layout_of(const dlpack::Tensor& tensor, const std::string& name) {
    const bool is_float = tensor.dtype.code == dlpack::kFloat && tensor.dtype.lanes == 1;
    if (!is_float || (tensor.dtype.bits != 32 && tensor.dtype.bits != 64)) refuse_type(name, text_of(tensor.dtype));
    Layout layout{{tensor.shape, tensor.shape + tensor.ndim},
                  std::nullopt,
                  tensor.dtype.bits == 64 ? NumberType::float64 : NumberType::float32,
                  reinterpret_cast<std::uintptr_t>(tensor.data) + tensor.byte_offset};
    if (tensor.strides) {
        layout.strides.emplace(tensor.strides, tensor.strides + tensor.ndim);
        for (std::int64_t& stride : *layout.strides) stride *= static_cast<std::int64_t>(size_of(layout.type));
    }
    return layout;
}

/// Reads a DLPack capsule without consuming it, so that the capsule frees the memory.
DeviceInput from_dlpack(const py::object& array, int ordinal, const std::string& name) {
    using namespace py::literals;
    py::object capsule;
    try {
        try {
            capsule = array.attr("__dlpack__")("stream"_a = 1, "max_version"_a = py::make_tuple(1, 0));
        } catch (py::error_already_set& error) {
            if (!error.matches(PyExc_TypeError)) throw;
            capsule = array.attr("__dlpack__")("stream"_a = 1);  // for a producer older than DLPack 1.0
        }
    } catch (py::error_already_set& error) {
        throw InputError(name + " lies on a GPU and cannot be read: " + py::str(error.value()).cast<std::string>());
    }
    const dlpack::Tensor* tensor = nullptr;
    if (PyCapsule_IsValid(capsule.ptr(), dlpack::kVersionedName)) {
        const auto* managed = static_cast<const dlpack::ManagedTensorVersioned*>(
            PyCapsule_GetPointer(capsule.ptr(), dlpack::kVersionedName));
        if (managed->version.major == 1) tensor = &managed->tensor;
    } else if (PyCapsule_IsValid(capsule.ptr(), dlpack::kName)) {
        tensor = &static_cast<const dlpack::ManagedTensor*>(PyCapsule_GetPointer(capsule.ptr(), dlpack::kName))->tensor;
    }
    if (!tensor) throw InputError(name + " lies on a GPU, and its __dlpack__ returned no capsule of version 0 or 1");
    DeviceInput input = input_of(layout_of(*tensor, name), ordinal, name, capsule);
    const Unlocked unlocked;
    wait_for_gpu(ordinal, std::nullopt);
    return input;
}

}  // namespace

std::optional<DeviceInput> device_input(const py::object& array, const char* name) {
    if (py::isinstance<SharedDeviceArray>(array)) {
        const auto& own = array.cast<const SharedDeviceArray&>();
        if (own.type() != NumberType::float32 && own.type() != NumberType::float64)
            refuse_type(name, own.type() == NumberType::int32 ? "int32" : "uint8");
        DeviceInput input =
            input_of({own.shape(), std::nullopt, own.type(), reinterpret_cast<std::uintptr_t>(own.data())},
                     own.ordinal(), name, array);
        // Other owners may still be writing to the array.
        const Unlocked unlocked;
        wait_for_gpu(own.ordinal(), std::nullopt);
        return input;
    }
    // Host tensors have the attribute, too, and raise when it is read.
    if (py::hasattr(array, "__cuda_array_interface__"))
        return from_interface(array, array.attr("__cuda_array_interface__").cast<py::dict>(), name);
    if (py::hasattr(array, "__dlpack__") && py::hasattr(array, "__dlpack_device__")) {
        const auto [type, ordinal] = array.attr("__dlpack_device__")().cast<std::pair<int, int>>();
        if (type == dlpack::kCuda || type == dlpack::kCudaManaged) return from_dlpack(array, ordinal, name);
    }
    return std::nullopt;
}

}  // namespace realcam::bindings
