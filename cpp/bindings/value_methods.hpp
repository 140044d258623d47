#pragma once
#include <pybind11/pybind11.h>

#include <concepts>

#include "value_state.hpp"

namespace realcam::bindings {

/// Gives a class pickles. `state`: of an object; `restored`: makes one of its state, which it checks.
template <class T, class... Options, class State, class Restored>
void def_pickle(pybind11::class_<T, Options...>& type, const State& state, const Restored& restored) {
    namespace py = pybind11;
    using namespace py::literals;
    const std::string name = type.attr("__name__").template cast<std::string>();
    type.def("__reduce__", [name, state](const py::object& self) -> py::tuple {
        return py::make_tuple(
            py::module_::import("realcam.pickling").attr("restored"),
            py::make_tuple(name, kStateFormat, py::module_::import("realcam").attr("__version__"), state(self)));
    });
    type.def_static("_restored", restored, "state"_a);
}

/// Gives a class ==, copy, deepcopy and pickle. What is unpickled is checked (restored.hpp). Copies go the way of
/// pickles: for results whose arrays the user may write to.
template <class T, class... Options>
void def_result(pybind11::class_<T, Options...>& type) {
    namespace py = pybind11;
    using namespace py::literals;
    type.def(
        "__eq__",
        [](const T& self, const py::object& other) -> py::object {
            if (!py::isinstance<T>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
            return py::bool_(equal(self, other.cast<const T&>()));
        },
        "other"_a);
    def_pickle(
        type, [](const py::object& self) { return StateWriter(self).write(self.cast<const T&>()); },
        [](const py::object& state) { return StateReader().made<T>(state); });
}

/// Copies of what nothing changes are the same object.
template <class T, class... Options>
void def_copy(pybind11::class_<T, Options...>& type) {
    type.def("__copy__", [](const pybind11::object& self) { return self; });
    type.def(
        "__deepcopy__", [](const pybind11::object& self, const pybind11::object&) { return self; },
        pybind11::arg("memo"));
}

/// The same as def_result for a value, which nothing changes.
template <class T, class... Options>
void def_value(pybind11::class_<T, Options...>& type) {
    def_result(type);
    def_copy(type);
}

/// The same, and hash(): for values small enough to be keys.
template <class T, class... Options>
void def_hashable_value(pybind11::class_<T, Options...>& type) {
    def_value(type);
    type.def("__hash__", [](const T& self) { return hash_of(self); });
}

}  // namespace realcam::bindings
