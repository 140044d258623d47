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

std::optional<Vec3d> vector_if(const std::optional<Triple>& v) {
    return v ? std::optional(vector_of(*v)) : std::nullopt;
}

Camera framed(Camera camera, const Assembly& scene, const std::optional<Triple>& position,
              const std::optional<Triple>& look_at, const Triple& up, std::optional<double> focus_m,
              const std::string& scene_camera) {
    set_view(camera, scene, {vector_if(position), vector_if(look_at), vector_of(up), focus_m, scene_camera});
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

// Choices of the command line for options that the user omits; the C++ program makes the same ones.
void bind_view(py::module_& m) {
    py::reinterpret_borrow<py::class_<Film>>(m.attr("Film"))
        .def_static("for_lens", &film_for_lens, "lens"_a, "size_mm"_a = py::none(), "resolution"_a = py::none(),
                    R"(A film for a lens. size_mm: (width, height); resolution: (columns, rows). None is chosen: the
size that the lens was made for, 960 square pixels along the longer side; of a resolution alone
the largest part of the lens's film that has its shape. Raises InputError.)");
    py::reinterpret_borrow<py::class_<Camera>>(m.attr("Camera"))
        .def("framing", &framed, "scene"_a, py::kw_only(), "position"_a = py::none(), "look_at"_a = py::none(),
             "up"_a = Triple{0, 1, 0}, "focus_distance_m"_a = py::none(), "scene_camera"_a = "",
             R"(The camera where it has the scene in its picture, in focus: position, look_at and focus_distance_m as
given, and what is None chosen. scene_camera: the name of one of scene.cameras, whose place, direction
and motion to take, or "none"; where nothing is said of the view it is the first of them. Without one the
view follows the rules of docs/scenes.md: an object from its front (+z, or -y where up is z), slightly above
and aside, where it fills nine tenths of the film, and a room from its open side or from a corner inside.
Of the camera itself lens, film, model and exposure stay. Raises InputError.)")
        .def("metered", &metered, "scene"_a, py::kw_only(), "device"_a = "auto", "max_bounces"_a = "auto",
             "progress"_a = py::none(),
             R"(The camera with the exposure time that brings the average of its picture of the scene to middle grey at
its ISO, from a small picture with so many reflections (see render, as for device and progress).
Raises InputError where no light reaches the film; DeviceError.)");
    py::reinterpret_borrow<py::class_<Assembly>>(m.attr("Scene"))
        .def("with_daylight", &with_daylight, "camera"_a,
             R"(The scene under a sun of 80 klux, from the upper left behind the camera, and a sky of 5000 cd/m^2 in
place of its environment: f/16, 1/125 s and ISO 100 expose it.)");
}

}  // namespace realcam::bindings
