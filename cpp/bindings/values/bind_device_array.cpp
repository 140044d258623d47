// The Python class DeviceArray, an array in a GPU's memory.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "../../error.hpp"
#include "../bindings.hpp"
#include "device_array.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

py::dtype dtype_of(const SharedDeviceArray& array) {
    switch (array.type()) {
        case NumberType::float32: return py::dtype::of<float>();
        case NumberType::float64: return py::dtype::of<double>();
        case NumberType::int32: return py::dtype::of<std::int32_t>();
        case NumberType::uint8: return py::dtype::of<std::uint8_t>();
    }
    throw InputError("an array of unknown type");
}

Typed<"tuple[int, ...]", py::tuple> shape_tuple(const SharedDeviceArray& array) {
    return py::tuple(py::cast(array.shape()));
}

std::string device_of(const SharedDeviceArray& array) {
    return "cuda:" + std::to_string(array.ordinal());
}

Typed<"NDArray[Any]", py::array> numpy_of(const SharedDeviceArray& array) {
    py::array copy(dtype_of(array), array.shape());
    void* const to = copy.mutable_data();
    const Unlocked unlocked;
    array.download(to);
    return copy;
}

Typed<"NDArray[Any]"> host_copy_of(const SharedDeviceArray& array, const Typed<"DTypeLike | None">& dtype,
                                   const Typed<"bool | None">& copy) {
    if (!copy.is_none() && !copy.cast<bool>())
        throw py::value_error("a DeviceArray can be converted to a numpy array only by a copy; copy must not be False");
    const py::array numbers = numpy_of(array);
    return dtype.is_none() ? py::object(numbers) : numbers.attr("astype")(dtype, "copy"_a = false);
}

Typed<"dict[str, Any]", py::dict> interface_of(const SharedDeviceArray& array) {
    const auto address = reinterpret_cast<std::uintptr_t>(array.data());
    return py::dict("version"_a = 3, "shape"_a = shape_tuple(array), "typestr"_a = dtype_of(array).attr("str"),
                    "data"_a = py::make_tuple(address, false), "strides"_a = py::none(), "stream"_a = py::none());
}

std::string array_repr(const SharedDeviceArray& array) {
    return "realcam.DeviceArray(shape=" + py::repr(shape_tuple(array)).cast<std::string>() +
           ", dtype=" + py::str(dtype_of(array)).cast<std::string>() + ", device=\"" + device_of(array) + "\")";
}

}  // namespace

void bind_device_array(py::module_& m) {
    py::class_<SharedDeviceArray>(
        m, "DeviceArray",
        R"(Array in a GPU's memory, in C order. torch.from_dlpack, cupy.from_dlpack, torch.as_tensor and cupy.asarray
share its memory without a copy, on any stream; numpy.asarray copies it to the host. The memory is freed when the
last array that shares it is deleted.)")
        .def_property_readonly("shape", &shape_tuple, "Length of each dimension.")
        .def_property_readonly("dtype", &dtype_of, "numpy.dtype: float64, float32, int32 or uint8.")
        .def_property_readonly("device", &device_of, "Name of the GPU, as `device` of Lens.trace: \"cuda:0\".")
        .def("numpy", &numpy_of, "Returns a copy in the host's memory. Raises DeviceError.")
        .def("__array__", &host_copy_of, "dtype"_a = py::none(), py::kw_only(), "copy"_a = py::none(),
             "Returns a copy in the host's memory, for numpy.asarray. Raises ValueError for copy=False, and "
             "DeviceError.")
        .def("__len__",
             [](const SharedDeviceArray& array) { return array.shape().empty() ? 0 : array.shape().front(); })
        .def("__repr__", &array_repr)
        .def("__reduce__",
             [](const SharedDeviceArray&) -> py::tuple {
                 throw py::type_error("a DeviceArray cannot be pickled; pickle the result of its numpy() instead");
             })
        .def_property_readonly("__cuda_array_interface__", &interface_of, "Numba's CUDA array interface, version 3.")
        .def(
            "__dlpack__",
            [](const SharedDeviceArray& array, const Typed<"int | None">&,
               const Typed<"tuple[int, int] | None">& max_version, const Typed<"tuple[int, int] | None">& dl_device,
               const Typed<"bool | None">& copy) { return dlpack_capsule(array, max_version, dl_device, copy); },
            py::kw_only(), "stream"_a = py::none(), "max_version"_a = py::none(), "dl_device"_a = py::none(),
            "copy"_a = py::none(),
            R"(Returns a DLPack capsule, as the Python array API standard defines it. All writes have completed, so that
any stream may read the array. Raises BufferError for a device other than the array's own GPU and the host, and
for the host with copy=False.)")
        .def("__dlpack_device__", [](const SharedDeviceArray& array) {
            return py::make_tuple(static_cast<int>(dlpack::kCuda), array.ordinal());
        });
}

}  // namespace realcam::bindings
