#include <cstdlib>
#include <cstring>
#include <string>
#include <unordered_map>

#include "bindings.hpp"

// Post-processing of all functions and classes of the module, once they exist: signatures are written with Python's
// type names, arguments of the wrong type raise a one-sentence error, and no class creates an object without a value.
// pybind11 has no hook for this, so the definitions of its functions are found through Python.
namespace realcam::bindings {
namespace {

using Arguments = PyObject* const*;
using FastCall = PyObject* (*)(PyObject*, Arguments, Py_ssize_t, PyObject*);

/// The C function by which pybind11 calls every bound function.
PyCFunction pybind_call = nullptr;

/// Definitions by the object that Python passes to that C function. Never destroyed: functions are called while Python
/// exits.
std::unordered_map<PyObject*, const PyMethodDef*>& definitions() {
    static auto* map = new std::unordered_map<PyObject*, const PyMethodDef*>;
    return *map;
}

/// True if the current error says that no overload accepts the arguments.
bool no_overload_fits() {
    if (!PyErr_ExceptionMatches(PyExc_TypeError)) return false;
    py::error_scope error;
    PyErr_NormalizeException(&error.type, &error.value, &error.trace);
    const std::string text = py::str(py::handle(error.value)).cast<std::string>();
    return text.find("(): incompatible ") != std::string::npos && text.find("Invoked with:") != std::string::npos;
}

/// Replaces pybind11's list of signatures by a one-sentence error.
void explain(PyObject* function, const py::tuple& arguments, const py::dict& named) {
    py::error_already_set theirs;
    try {
        const py::object words = py::module_::import("realcam.arguments").attr("complaint");
        const auto text = words(definitions().at(function)->ml_doc, arguments, named).cast<std::string>();
        const py::object type = py::module_::import("realcam._core").attr("ArgumentError");
        PyErr_SetString(type.ptr(), text.c_str());
    } catch (const std::exception&) {
        theirs.restore();  // keeps pybind11's message if its signature cannot be parsed
    }
}

PyObject* fast_call(PyObject* function, Arguments arguments, Py_ssize_t count, PyObject* names) {
    PyObject* result =
        reinterpret_cast<FastCall>(reinterpret_cast<void (*)()>(pybind_call))(function, arguments, count, names);
    if (result || !no_overload_fits()) return result;
    py::tuple given(static_cast<std::size_t>(count));
    for (Py_ssize_t i = 0; i < count; ++i) given[static_cast<std::size_t>(i)] = py::handle(arguments[i]);
    py::dict named;
    for (Py_ssize_t i = 0; names && i < PyTuple_GET_SIZE(names); ++i)
        named[py::handle(PyTuple_GET_ITEM(names, i))] = py::handle(arguments[count + i]);
    explain(function, given, named);
    return nullptr;
}

/// Calling convention of pybind11 before version 3.
PyObject* tuple_call(PyObject* function, PyObject* arguments, PyObject* names) {
    PyObject* result = reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(pybind_call))(
        function, arguments, names);
    if (result || !no_overload_fits()) return result;
    explain(function, py::reinterpret_borrow<py::tuple>(arguments),
            names ? py::reinterpret_borrow<py::dict>(names) : py::dict());
    return nullptr;
}

/// Returns the function behind a method, static method or property; null if it is not a pybind11 function.
PyMethodDef* definition_of(py::object thing, PyObject*& function) {
    if (Py_TYPE(thing.ptr()) == &PyProperty_Type) thing = thing.attr("fget");
    if (Py_TYPE(thing.ptr()) == &PyStaticMethod_Type) thing = thing.attr("__func__");
    PyObject* bare = PyInstanceMethod_Check(thing.ptr()) ? PyInstanceMethod_GET_FUNCTION(thing.ptr()) : thing.ptr();
    if (!PyCFunction_Check(bare)) return nullptr;
    auto* made = reinterpret_cast<PyCFunctionObject*>(bare);
    function = made->m_self;
    return made->m_ml->ml_meth == pybind_call ? made->m_ml : nullptr;
}

void finish_function(const py::object& thing, const py::object& cleaned) {
    PyObject* function = nullptr;
    PyMethodDef* definition = definition_of(thing, function);
    if (!definition) return;
    definitions()[function] = definition;
    definition->ml_meth = definition->ml_flags & METH_FASTCALL
                              ? reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&fast_call))
                              : reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&tuple_call));
    if (!definition->ml_doc) return;
    const std::string doc = cleaned(definition->ml_doc).cast<std::string>();
    std::free(const_cast<char*>(definition->ml_doc));  // allocated by pybind11 with strdup
    definition->ml_doc = strdup(doc.c_str());
}

/// Makes Class.__new__ raise an error, because it would create an object without a value. Python itself calls the
/// type's slot, which is unchanged: only the dict entry is replaced.
void refuse_new(const py::object& type) {
    const std::string name = type.attr("__name__").cast<std::string>();
    const py::cpp_function refuse(
        [name](const py::args&, const py::kwargs&) {
            throw py::type_error(name + ".__new__ makes no " + name + "; call the class, or what its help names");
        },
        py::name("__new__"), py::scope(type));
    PyObject* entries = reinterpret_cast<PyTypeObject*>(type.ptr())->tp_dict;
    const py::object entry = py::reinterpret_steal<py::object>(PyStaticMethod_New(refuse.ptr()));
    if (PyDict_SetItemString(entries, "__new__", entry.ptr()) != 0) throw py::error_already_set();
    PyType_Modified(reinterpret_cast<PyTypeObject*>(type.ptr()));
}

bool is_class_of_this_module(const py::object& thing) {
    return PyType_Check(thing.ptr()) && py::hasattr(thing, "__module__") &&
           thing.attr("__module__").cast<std::string>() == "realcam._core" &&
           py::str(py::type::of(thing).attr("__name__")).cast<std::string>() == "pybind11_type";
}

}  // namespace

void finish_module(py::module_& m) {
    const py::object cleaned = py::module_::import("realcam.arguments").attr("cleaned");
    pybind_call = reinterpret_cast<PyCFunctionObject*>(m.attr("develop").ptr())->m_ml->ml_meth;
    for (const auto& [name, thing] : py::dict(m.attr("__dict__"))) {
        const auto object = py::reinterpret_borrow<py::object>(thing);
        finish_function(object, cleaned);
        if (!is_class_of_this_module(object)) continue;
        for (const auto& [member, value] : py::dict(object.attr("__dict__")))
            finish_function(py::reinterpret_borrow<py::object>(value), cleaned);
        refuse_new(object);
    }
}

}  // namespace realcam::bindings
