#pragma once
#include <pybind11/pybind11.h>

#include <numbers>
#include <optional>
#include <string>

#include "../camera/camera.hpp"
#include "../camera/develop.hpp"
#include "../io/lens/lens_file.hpp"
#include "../optics/analysis/object_point.hpp"
#include "../optics/prescription/lens_system.hpp"
#include "../render/progress.hpp"
#include "../render/render_settings.hpp"
#include "../scene/assembly.hpp"
#include "unlocked.hpp"

namespace realcam::bindings {

namespace py = pybind11;

// One function for each file of this folder.
void bind_errors(py::module_& m);
void bind_coating(py::module_& m);
void bind_glass(py::module_& m);
void bind_surface(py::module_& m);
void bind_first_order(py::module_& m);
void bind_lens(py::module_& m);
void bind_lens_file(py::module_& m);
void bind_lens_edits(py::module_& m);
void bind_tolerance(py::module_& m);
void bind_device_array(py::module_& m);
void bind_trace(py::module_& m);
void bind_derivatives(py::module_& m);
void bind_seidel(py::module_& m);
void bind_ghosts(py::module_& m);
void bind_analysis(py::module_& m);
void bind_psf(py::module_& m);
void bind_bundle(py::module_& m);
void bind_transmission(py::module_& m);
void bind_camera(py::module_& m);
void bind_camera_rays(py::module_& m);
void bind_pupil_table(py::module_& m);
void bind_projection(py::module_& m);
void bind_material(py::module_& m);
void bind_scene(py::module_& m);
void bind_scene_materials(py::class_<Assembly>& scene);
void bind_instances(py::class_<Assembly>& scene);
void bind_settings(py::module_& m);
void bind_render(py::module_& m);
void bind_plan(py::module_& m);
void bind_view(py::module_& m);
void bind_shot(py::module_& m);
void bind_live(py::module_& m);
void bind_session(py::module_& m);
void bind_film_parts(py::module_& m);
void bind_sensor(py::module_& m);
void bind_toml(py::module_& m);
void bind_denoiser(py::module_& m);
void bind_bench(py::module_& m);
void bind_help(py::module_& m);
void bind_pictures(py::module_& m);
void bind_command(py::module_& m);

/// What all functions and classes of the module have in common; the last of all.
void finish_module(py::module_& m);

/// A DeviceNotice: a UserWarning on the line of the user's call. Called with or without the interpreter's lock.
void warn_of_device(const std::string& text);

/// "film" or "linear". Throws InputError.
ToneCurve tone_curve_from(const std::string& name);

/// Throws InputError for what does not fit 32 bits.
std::uint32_t seed_from(std::int64_t seed, const char* what = "seed");

/// A number of bounces; none for "auto".
inline std::optional<int> bounces_from(py::handle word) {
    const bool is_automatic = py::isinstance<py::str>(word) && word.cast<std::string>() == "auto";
    return is_automatic ? std::nullopt : std::optional(word.cast<int>());
}

/// Python's share of the progress: signals (Ctrl-C), then the caller's function (None: nothing more). Called without
/// the interpreter's lock. The callback must outlive the result.
Progress progress_of(const py::object& callback);

/// A KeepGoing: true, or raises what a signal has raised in Python, above all KeyboardInterrupt. Called with or without
/// the interpreter's lock, on the thread that Python called.
bool heed_signals();

/// A path as users give it, a text or anything with __fspath__, in the bytes that the system knows it by. Throws
/// InputError for a null character, at which the system would cut the name.
inline std::string path_from(const py::object& path) {
    std::string bytes = py::module_::import("os").attr("fsencode")(path).cast<std::string>();
    if (bytes.find('\0') != std::string::npos) throw InputError("a file name cannot hold a null character");
    return bytes;
}

/// A text of the core, in which names of files may be no UTF-8, as Python has such names (os.fsdecode).
inline py::str text_from(const std::string& text) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size())));
}

/// A medium as users write it: an index, (n_d, V_d), the name of a glass of the catalogue, a Glass; None is air.
Glass glass_from(const py::object& material);
/// A medium in words, for __repr__.
std::string glass_text(const Glass& glass);

/// The design wavelength where none is given. Throws InputError outside the limits of Lens.trace.
double wavelength_or_design(const LensSystem& lens, std::optional<double> nm);

/// A film point as users write it: (x, y), mm from the film's middle; none: the field is named by its angle.
using FilmPlace = std::optional<std::pair<double, double>>;

/// A place in the field as users write it; no distance: the plane in focus. Throws InputError where both an angle and a
/// film point are given.
FieldPoint field_from(double field_deg, std::optional<double> object_distance_m, const FilmPlace& film_mm = {});

}  // namespace realcam::bindings
