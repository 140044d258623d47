#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>

#include "../camera/default_film.hpp"
#include "../render/daylight.hpp"
#include "../render/default_view.hpp"
#include "../render/metering.hpp"
#include "bindings.hpp"
#include "render_turn.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Triple = std::array<double, 3>;

std::optional<Vec3d> vector_of(const std::optional<Triple>& v) {
    if (!v) return std::nullopt;
    return Vec3d{(*v)[0], (*v)[1], (*v)[2]};
}

Camera framed(Camera camera, const Assembly& scene, const std::optional<Triple>& position,
              const std::optional<Triple>& look_at, const Triple& up, std::optional<double> focus_m) {
    set_view(camera, scene, {vector_of(position), vector_of(look_at), Vec3d{up[0], up[1], up[2]}, focus_m});
    return camera;
}

Camera exposed(Camera camera, const Assembly& scene, const std::string& device, const py::object& progress) {
    Backend& backend = backend_for(device);
    const Progress report = progress_of(progress);
    const py::gil_scoped_release release;
    const RenderTurn turn;
    camera.exposure_time_s = metered_exposure_time(backend, scene, camera, {}, report);
    return camera;
}

}  // namespace

// What the command line decides for a user who does not say; the C++ program decides in the same way.
void bind_view(py::module_& m) {
    m.def("default_film", &default_film, "lens"_a, "size_mm"_a = py::none(), "resolution"_a = py::none(),
          "Completes (width, height) in mm and (columns, rows): the lens's film, 960 pixels along the longer side, "
          "square pixels.");
    m.def("framed", &framed, "camera"_a, "scene"_a, py::kw_only(), "position"_a = py::none(), "look_at"_a = py::none(),
          "up"_a = Triple{0, 1, 0}, "focus_distance_m"_a = py::none(),
          "The camera, placed and focused as asked for, and otherwise such that the scene fills the picture from +z, "
          "in focus\n"
          "where its axis meets it. Raises InputError.");
    m.def(
        "with_daylight",
        [](const Assembly& scene, const Camera& camera) {
            return with_static_geometry(scene, [&](Scene& changed) { add_daylight(changed, camera.pose); });
        },
        "scene"_a, "camera"_a,
        "The scene under a sun of 80 klux from the camera's upper left and a sky of 5000 cd/m^2.");
    m.def("exposed", &exposed, "camera"_a, "scene"_a, "device"_a = "auto", "progress"_a = py::none(),
          "The camera with the exposure time that brings the average of its picture to middle grey. Raises InputError "
          "where\n"
          "no light reaches the film.");
}

}  // namespace realcam::bindings
