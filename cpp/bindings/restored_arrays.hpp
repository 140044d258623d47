#pragma once
#include <pybind11/numpy.h>

#include <vector>

#include "../cuda/shared_device_array.hpp"
#include "restored.hpp"

namespace realcam::bindings {

/// What a pickled result has to have in place of an array.
struct WantedArray {
    char kind;  ///< numpy's letter: f floats, c complex numbers, i integers
    std::vector<pybind11::ssize_t> shape;
};

/// Throws InputError where it is no array of that shape, of numpy or on a GPU.
inline void check_restored_array(const pybind11::object& array, const WantedArray& wanted) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::object type = array.attr("dtype");
    require_restored(py::dtype::from_args(type).kind() == wanted.kind && type.attr("isnative").cast<bool>());
    const py::tuple shape = array.attr("shape");
    require_restored(shape.size() == wanted.shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i) require_restored(shape[i].cast<py::ssize_t>() == wanted.shape[i]);
}

/// The length of the first dimension. Throws InputError where it is no array, or has none.
inline pybind11::ssize_t restored_length(const pybind11::object& array) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::tuple shape = array.attr("shape");
    require_restored(!shape.empty());
    return shape[0].cast<py::ssize_t>();
}

}  // namespace realcam::bindings
