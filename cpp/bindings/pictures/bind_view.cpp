// Film size, view and exposure that are chosen automatically, for Python and the command line alike.

#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>

#include "../../camera/film/camera.hpp"
#include "../../render/framing/default_view.hpp"
#include "../../render/session/metering.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "owned_session.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

std::optional<Vec3d> optional_vector_of(const std::optional<Triple>& v) {
    return v ? std::optional(vector_of(*v)) : std::nullopt;
}

Camera framed(Camera camera, const Assembly& scene, const std::optional<Triple>& position,
              const std::optional<Triple>& look_at, const Triple& up, std::optional<double> focus_m,
              const std::string& scene_camera) {
    set_view(camera, scene,
             {optional_vector_of(position), optional_vector_of(look_at), vector_of(up), focus_m, scene_camera});
    return camera;
}

Camera metered(Camera camera, const Assembly& scene, const std::string& device, const Typed<"int | str">& max_bounces,
               const ProgressFunction& progress) {
    const Progress report = progress_of(progress);
    const std::optional<int> bounces = bounces_from(max_bounces);
    camera.exposure_time_s = OwnedSession::shared(device).use([&](const auto& session) {
        return metered_exposure_time(*session, scene, camera, {.max_bounces = bounces, .effects = {}}, report);
    });
    return camera;
}

Film film_for_lens(const LensSystem& lens, std::optional<std::array<double, 2>> size_mm,
                   std::optional<std::array<int, 2>> resolution) {
    const Film film = default_film(lens, size_mm, resolution);
    validate(film);
    return film;
}

Assembly with_daylight(const Assembly& scene, const Camera& camera) {
    return with_static_geometry(scene, [&](Scene& changed) { add_daylight(changed, camera.pose); });
}

}  // namespace

void bind_view(py::module_& m) {
    py::reinterpret_borrow<py::class_<Film>>(m.attr("Film"))
        .def_static("for_lens", &film_for_lens, "lens"_a, "size_mm"_a = py::none(), "resolution"_a = py::none(),
                    R"(Returns a Film for a lens.
size_mm: (width, height); None: the size for which the lens is designed, or, if resolution is specified, the largest
  part of it with the shape of the resolution.
resolution: (columns, rows); None: 960 square pixels along the longer side.
Raises InputError.)");
    py::reinterpret_borrow<py::class_<Camera>>(m.attr("Camera"))
        .def("framing", &framed, "scene"_a, py::kw_only(), "position"_a = py::none(), "look_at"_a = py::none(),
             "up"_a = Triple{0, 1, 0}, "focus_distance_m"_a = py::none(), "scene_camera"_a = "",
             R"(Returns the camera with a view of the scene, in focus. Lens, film, model and exposure stay.
position, look_at: (x, y, z) in m, scene; None: chosen automatically. up: the upward direction.
focus_distance_m: distance from the plane in focus to the film; None: focus on the subject.
scene_camera: name of the one of scene.cameras whose position, direction and motion are used; "none": do not use one;
  "": the first of them, if neither position nor look_at is specified.
Without a scene camera the view follows the rules of docs/scenes.md: an object is seen from its front (+z, or -y if up
is z), slightly from above and the side, and fills nine tenths of the film; a room is seen from its open side, or from
a corner inside. Raises InputError.)")
        .def(
            "metered", &metered, "scene"_a, py::kw_only(), "device"_a = "auto", "max_bounces"_a = "auto",
            "progress"_a = py::none(),
            R"(Returns the camera with the exposure time at which the average of its picture of the scene becomes middle
grey at its ISO, measured on a small picture. device, max_bounces, progress: as for realcam.render.
Raises InputError if no light reaches the film; DeviceError.)");
    py::reinterpret_borrow<py::class_<Assembly>>(m.attr("Scene"))
        .def(
            "with_daylight", &with_daylight, "camera"_a,
            R"(Returns the scene with additional daylight: a sun of 80 klux from the upper left behind the camera, and a
uniform sky of 5000 cd/m^2 instead of the environment. f/16, 1/125 s and ISO 100 expose it correctly.)");
}

}  // namespace realcam::bindings
