#pragma once
#include <pybind11/numpy.h>

#include <vector>

#include "../cuda/shared_device_array.hpp"
#include "restored.hpp"

namespace realcam::bindings {

/// Required type and shape of an array in a pickled result.
struct WantedArray {
    char kind;  ///< numpy's kind character: f floats, c complex numbers, i integers
    std::vector<pybind11::ssize_t> shape;
};

/// Throws InputError if the object is not a numpy array or DeviceArray of that kind and shape.
inline void check_restored_array(const pybind11::object& array, const WantedArray& wanted) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::object type = array.attr("dtype");
    require_restored(py::dtype::from_args(type).kind() == wanted.kind && type.attr("isnative").cast<bool>());
    const py::tuple shape = array.attr("shape");
    require_restored(shape.size() == wanted.shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i) require_restored(shape[i].cast<py::ssize_t>() == wanted.shape[i]);
}

/// Returns the length of the first dimension. Throws InputError if the object is not an array or has no dimension.
inline pybind11::ssize_t restored_length(const pybind11::object& array) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::tuple shape = array.attr("shape");
    require_restored(!shape.empty());
    return shape[0].cast<py::ssize_t>();
}

}  // namespace realcam::bindings
