// Entry point of the extension module realcam._core.

#include "bindings.hpp"
#include "values/value_state.hpp"

namespace realcam::bindings {
namespace {

/// Makes Class.__new__ raise TypeError, because it would create an object without a C++ value. Only the dict entry is
/// replaced: calling the class uses the type's slot, which is unchanged.
void refuse_new(const py::object& type) {
    const std::string name = type.attr("__name__").cast<std::string>();
    const py::cpp_function refuse(
        [name](const py::args&, const py::kwargs&) {
            throw py::type_error(name + ".__new__ makes no " + name +
                                 "; call the class, or a function named in its help");
        },
        py::name("__new__"), py::scope(type));
    PyObject* entries = reinterpret_cast<PyTypeObject*>(type.ptr())->tp_dict;
    const py::object entry = py::reinterpret_steal<py::object>(PyStaticMethod_New(refuse.ptr()));
    if (PyDict_SetItemString(entries, "__new__", entry.ptr()) != 0) throw py::error_already_set();
    PyType_Modified(reinterpret_cast<PyTypeObject*>(type.ptr()));
}

}  // namespace
}  // namespace realcam::bindings

PYBIND11_MODULE(_core, m) {
    using namespace realcam::bindings;
    m.doc() = "The C++ core of realcam.";
    m.attr("__version__") = REALCAM_VERSION;
    m.attr("_STATE_FORMAT") = kStateFormat;
    bind_errors(m);
    bind_coating(m);
    bind_glass(m);
    bind_surface(m);
    bind_first_order(m);
    bind_lens(m);
    bind_lens_file(m);
    bind_lens_edits(m);
    bind_device_array(m);
    bind_trace(m);
    bind_derivatives(m);
    bind_seidel(m);
    bind_ghosts(m);
    bind_analysis(m);
    bind_psf(m);
    bind_bundle(m);
    bind_transmission(m);
    bind_tolerance(m);
    bind_camera(m);
    bind_camera_rays(m);
    bind_pupil_table(m);
    bind_projection(m);
    bind_material(m);
    bind_scene(m);
    bind_settings(m);
    bind_render(m);
    bind_picture_gradient(m);
    bind_plan(m);
    bind_view(m);
    bind_shot(m);
    bind_live(m);
    bind_film_parts(m);
    bind_session(m);
    bind_sensor(m);
    bind_toml(m);
    bind_denoiser(m);
    bind_bench(m);
    bind_help(m);
#if REALCAM_HAS_PICTURES
    bind_pictures(m);
    bind_command(m);
#endif
    for (const py::handle type : py::module_::import("realcam.arguments").attr("explain_wrong_arguments")(m))
        refuse_new(py::reinterpret_borrow<py::object>(type));
    watch_exit_and_fork();
}
