#pragma once
#include <pybind11/pybind11.h>

#include <numbers>
#include <optional>
#include <string>

#include "../camera/film/camera.hpp"
#include "../camera/film/develop.hpp"
#include "../io/lens/lens_file.hpp"
#include "../optics/analysis/object_point.hpp"
#include "../optics/prescription/coating.hpp"
#include "../optics/prescription/lens_system.hpp"
#include "../render/session/progress.hpp"
#include "../render/settings/render_settings.hpp"
#include "../scene/assembly.hpp"
#include "typed_object.hpp"
#include "unlocked.hpp"

namespace realcam::bindings {

namespace py = pybind11;

// Conversions that all bindings share, and the functions that add the bindings to the module, by subject.

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
void bind_stages(py::module_& m);
void bind_scene_arrays(py::class_<Assembly>& scene);
void bind_scene_materials(py::class_<Assembly>& scene);
void bind_instances(py::class_<Assembly>& scene);
void bind_settings(py::module_& m);
void bind_render(py::module_& m);
void bind_picture_gradient(py::module_& m);
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

/// Issues a UserWarning on the line of the user's call. May be called with or without the GIL.
void warn(const std::string& text);

/// Returns the tone curve named "film" or "linear". Throws InputError for any other name.
ToneCurve tone_curve_from(const std::string& name);

/// Returns the seed as 32 bits. Throws InputError if it does not fit; `what`: name of the argument, for the message.
std::uint32_t seed_from(std::int64_t seed, const char* what = "seed");

/// Converts the maximum number of bounces of a path, an int; returns std::nullopt for "auto".
inline std::optional<int> bounces_from(py::handle bounces) {
    const bool is_automatic = py::isinstance<py::str>(bounces) && bounces.cast<std::string>() == "auto";
    return is_automatic ? std::nullopt : std::optional(bounces.cast<int>());
}

/// Returns a progress function that handles signals (Ctrl-C), then calls `callback` with the finished fraction, 0 to 1
/// (None: no call). It must be called without the GIL. The callback must outlive the result.
Progress progress_of(const py::object& callback);

/// KeepGoing function: returns true, or throws the exception of a signal handler, typically KeyboardInterrupt. It may
/// be called with or without the GIL, on the thread that Python called.
bool heed_signals();

/// Converts a path, a str or any object with __fspath__, to the bytes of the file system. Throws InputError for a null
/// character, at which the system would truncate the name.
inline std::string path_from(const py::object& path) {
    std::string bytes = py::module_::import("os").attr("fsencode")(path).cast<std::string>();
    if (bytes.find('\0') != std::string::npos) throw InputError("a file name cannot hold a null character");
    return bytes;
}

/// Converts a text of the core to a str, as os.fsdecode does: it may contain file names that are not valid UTF-8.
inline py::str text_from(const std::string& text) {
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size())));
}

/// Converts a medium: an index, (n_d, V_d), the name of a catalogue glass, or a Glass; None is air. Throws InputError.
Glass glass_from(const py::object& material);
/// Converts the name of a known coating (Coating.named) or a Coating. Throws InputError for anything else.
Coating coating_from(const py::object& coating);
/// Describes a medium, for __repr__.
std::string glass_text(const Glass& glass);

/// Returns the wavelength in nm, or the lens's design wavelength for std::nullopt. Throws InputError below 100 or above
/// 20000 nm.
double wavelength_or_design(const LensSystem& lens, std::optional<double> nm);

/// Film point: (x, y), mm from the film's centre; std::nullopt: the field is specified by its angle.
using FilmPoint = std::optional<std::pair<double, double>>;

/// Converts a field point; without an object distance it lies in the plane in focus. Throws InputError if both an angle
/// other than 0 and a film point are specified.
FieldPoint field_from(double field_deg, std::optional<double> object_distance_m, const FilmPoint& film_mm = {});

}  // namespace realcam::bindings
