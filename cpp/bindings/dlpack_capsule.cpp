#include "device_array.hpp"
#include "dlpack.hpp"
#include "unlocked.hpp"

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
    const auto asked = dl_device.is_none() ? std::pair<int, int>(dlpack::kCuda, array.ordinal())
                                           : dl_device.cast<std::pair<int, int>>();
    const bool to_host = asked.first == dlpack::kCpu;
    if (!to_host && asked != std::pair<int, int>(dlpack::kCuda, array.ordinal()))
        throw py::buffer_error("a DeviceArray goes to its own GPU or to the host, and to no other device");
    const bool must_copy = !copy.is_none() && copy.cast<bool>(), must_not = !copy.is_none() && !must_copy;
    if (to_host && must_not) throw py::buffer_error("a DeviceArray reaches the host only as a copy");

    std::shared_ptr<void> memory = array.memory();
    if (to_host)
        memory = host_copy(array);
    else if (must_copy)
        memory = array.duplicate().memory();
    const dlpack::Device device{asked.first, to_host ? 0 : array.ordinal()};
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

}  // namespace realcam::bindings
