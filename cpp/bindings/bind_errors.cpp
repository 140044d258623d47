// Python's exception classes, and the translation of C++ exceptions into them.

#include <new>
#include <optional>
#include <stdexcept>
#include <string>

#include "../error.hpp"
#include "../image_io/unfinished_file.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/lens/lens_error.hpp"
#include "../io/text/printable.hpp"
#include "../plan/plan.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns the Python class for a C++ exception or tag. Never destroyed, because Python may translate an error while
/// the module is torn down.
template <class Tag>
py::object& type_of() {
    static auto* type = new py::object;
    return *type;
}

/// Tag of an exception that only Python code raises.
struct ArgumentError;

/// Creates the exception class realcam.`name` and adds it to the module. `base`: its base class, or a tuple of them.
template <class E>
void define(py::module_& m, const char* name, const py::object& base, const char* doc) {
    const std::string full = std::string("realcam.") + name;
    type_of<E>() = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(full.c_str(), doc, base.ptr(), nullptr));
    m.attr(name) = type_of<E>();
}

template <class E>
void raise(const E& error) {
    PyErr_SetObject(type_of<E>().ptr(), text_from(io::one_line(error.what())).ptr());
}

void raise(const LensFileError& error) {
    py::object instance = type_of<LensFileError>()(text_from(io::one_line(error.what())));
    instance.attr("file") = text_from(error.file);
    instance.attr("line") = error.line;
    instance.attr("surface") = error.surface;
    const auto* read_error = dynamic_cast<const io::LensReadError*>(&error);
    const io::LensReadError no_remedy("");
    const io::LensReadError& remedy = read_error ? *read_error : no_remedy;
    instance.attr("glass") = text_from(remedy.glass);
    instance.attr("candidate") = text_from(remedy.candidate);
    instance.attr("can_be_forced") = remedy.can_be_forced;
    // Python prints notes below a traceback. They are not part of the message, which the browser shows as well.
    py::list notes;
    if (remedy.can_be_forced) notes.append("Lens.load(..., force=True) reads the file without that feature");
    if (!remedy.glass.empty())
        notes.append(text_from("Lens.load(..., glass={\"" + remedy.glass +
                               "\": " + (remedy.candidate.empty() ? "(n_d, V_d)" : '"' + remedy.candidate + '"') +
                               "}) defines that glass"));
    if (!notes.empty()) instance.attr("__notes__") = notes;
    PyErr_SetObject(type_of<LensFileError>().ptr(), instance.ptr());
}

/// Starts or ends recording which files a command written in Python reads, for _check_no_input.
void record_inputs(bool is_on) {
    static std::optional<io::InputRecording> recording;
    if (!is_on)
        recording.reset();
    else if (!recording)
        recording.emplace();
}

}  // namespace

void bind_errors(py::module_& m) {
    m.def("_record_inputs", &record_inputs, "is_on"_a,
          "Internal. Starts (True) or ends (False) recording which files are read.");
    m.def(
        "_record_input", [](const py::bytes& path) { (void)io::why_unreadable(path); }, "path"_a,
        "Internal. Adds a file to the recorded input files.");
    m.def(
        "_check_no_input", [](const py::bytes& output) { image_io::check_is_not_an_input(output); }, "output"_a,
        "Internal. Raises an error if the output file is one of the recorded input files.");
    m.def(
        "one_line", [](const std::string& message) { return text_from(io::one_line(message)); }, "message"_a,
        "Returns a message as one line: control characters are removed, and the middle of a message that is too long "
        "is left out.");
    define<Error>(m, "RealcamError", py::reinterpret_borrow<py::object>(PyExc_Exception),
                  "Base class of all errors of realcam. The message is one line: what is wrong, where, and what is "
                  "expected.");
    const py::object base = type_of<Error>();
    const py::object value_error = py::make_tuple(base, py::reinterpret_borrow<py::object>(PyExc_ValueError));
    define<InputError>(m, "InputError", value_error, "Raised for an invalid value. Also a ValueError.");
    const py::object type_error =
        py::make_tuple(type_of<InputError>(), py::reinterpret_borrow<py::object>(PyExc_TypeError));
    define<ArgumentError>(
        m, "ArgumentError", type_error,
        "Raised for an argument that has the wrong type, is missing or is unknown. Also a TypeError.");
    define<NothingToPlan>(
        m, "NothingToPlan", type_of<InputError>(),
        "Raised by the planner for a shot that it cannot plan, because the camera sees neither an object nor light.");
    define<LensFileError>(
        m, "LensFileError", base,
        "Raised for a lens that cannot be read or built. Attributes: file (str, empty if there is none), line and "
        "surface (int, from 1; 0 if they do not apply); glass (str), the name of an unknown or ambiguous glass, "
        "else empty; candidate (str), one catalogue glass of that name, or empty; can_be_forced (bool), True if "
        "force=True reads the file.");
    define<SceneFileError>(m, "SceneFileError", base,
                           "Raised for a scene that cannot be read, or that contains no geometry.");
    define<ImageFileError>(m, "ImageFileError", base, "Raised for an image file that cannot be read or written.");
    define<DeviceError>(m, "DeviceError", base, "Raised if a device, or its library, fails or is missing.");
    define<Cancelled>(m, "Cancelled", base, "Raised if a progress callback stopped the work.");
    py::register_exception_translator([](std::exception_ptr pointer) {
        try {
            if (pointer) std::rethrow_exception(pointer);
        } catch (const LensFileError& e) {
            raise(e);
        } catch (const NothingToPlan& e) {
            raise<NothingToPlan>(e);
        } catch (const InputError& e) {
            raise<InputError>(e);
        } catch (const SceneFileError& e) {
            raise<SceneFileError>(e);
        } catch (const ImageFileError& e) {
            raise<ImageFileError>(e);
        } catch (const DeviceError& e) {
            raise<DeviceError>(e);
        } catch (const Cancelled& e) {
            raise<Cancelled>(e);
        } catch (const Error& e) {
            raise<Error>(e);
        } catch (const std::bad_alloc&) {
            PyErr_SetString(PyExc_MemoryError, "out of memory");
        } catch (const py::builtin_exception&) {
            throw;  // an exception of pybind11
        } catch (const std::runtime_error& e) {
            // TBB's message if it cannot start a thread.
            if (!std::string(e.what()).starts_with("pthread_create has failed")) throw;
            raise<DeviceError>(NoThread());
        }
    });
}

}  // namespace realcam::bindings
