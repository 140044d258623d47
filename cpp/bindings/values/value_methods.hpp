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

/// Check of a class whose members are all that has to be checked.
struct MembersOnly {
    template <class T>
    void operator()(const T&) const {}
};

/// Defines ==, copy, deepcopy and pickle for a class. Unpickled values are checked (restored.hpp), and by
/// `check(value)`, which throws a realcam::Error, for results of calculations that have no public constructor. Copies
/// are made through the pickle state: for results whose arrays the user may modify.
template <class T, class... Options, class Check = MembersOnly>
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
