#pragma once
#include <pybind11/pybind11.h>

#include <concepts>

#include "../typed_object.hpp"
#include "value_state.hpp"

namespace realcam::bindings {

/// Defines pickling of a class. `state(self)` returns the pickle state of an object; `restored(state)` checks a state
/// and makes an object from it.
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

/// The default check of unpickled values, which accepts all: the checks of the members suffice.
struct NoFurtherCheck {
    template <class T>
    void operator()(const T&) const {}
};

/// Defines == and pickling for a class. copy and deepcopy follow from pickling, so that a copy has arrays of its own.
/// Members of unpickled values are checked (restored.hpp). `check(value)`, which throws a realcam::Error, is a further
/// check, for classes without a public constructor.
template <class T, class... Options, class Check = NoFurtherCheck>
void def_result(pybind11::class_<T, Options...>& type, const Check& check = {}) {
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
        [check](const py::object& state) {
            T value = StateReader().read_value<T>(state);
            check(value);
            return value;
        });
}

/// Defines copy and deepcopy of an immutable class, which return the object itself.
template <class T, class... Options>
void def_copy(pybind11::class_<T, Options...>& type) {
    using Self = Typed<"Self">;
    type.def("__copy__", [](const Self& self) { return self; });
    type.def("__deepcopy__", [](const Self& self, const pybind11::object&) { return self; }, pybind11::arg("memo"));
}

/// Like def_result, for immutable values.
template <class T, class... Options, class... Check>
void def_value(pybind11::class_<T, Options...>& type, const Check&... check) {
    def_result(type, check...);
    def_copy(type);
}

/// Like def_value, and defines hash(): for values small enough to be dict keys.
template <class T, class... Options, class... Check>
void def_hashable_value(pybind11::class_<T, Options...>& type, const Check&... check) {
    def_value(type, check...);
    type.def("__hash__", [](const T& self) { return hash_of(self); });
}

}  // namespace realcam::bindings
