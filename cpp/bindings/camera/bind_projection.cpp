#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <mutex>

#include "../../camera/camera_setup.hpp"
#include "../../camera/models/pinhole_camera.hpp"
#include "../../camera/projection/projection.hpp"
#include "../../camera/projection/projection_grid.hpp"
#include "../../camera/projection/radial_projection.hpp"
#include "../../embree/lens_rays.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using Doubles = InputArray<double>;

ProjectionRay projection_ray_from(const std::string& name) {
    if (name == "light") return ProjectionRay::light;
    if (name == "chief") return ProjectionRay::chief;
    throw InputError("unknown ray \"" + name + "\"; light or chief is wanted");
}

/// Returns the projection rays of a camera; caches the last result, because most programs use the same lens and film
/// repeatedly. Must be called without the GIL.
std::shared_ptr<const ProjectionRays> lines_of(const Camera& camera, ProjectionRay ray) {
    struct Last {
        LensSystem lens;
        double film_radius_mm;  ///< sufficient for a rotationally symmetric lens
        Vec2<double> film_mm, film_shift_mm;
        CameraModel model;
        ProjectionRay ray;
        bool operator==(const Last&) const = default;
    };
    static std::mutex mutex;
    static std::optional<Last> last;
    static std::shared_ptr<const ProjectionRays> lines;
    static LastSetup setups;
    validate(camera);
    Last wanted = {camera.lens, camera.film.radius_mm(), {}, {}, camera.model, ray};
    const bool is_round = has_radial_pupil(camera.lens) || !has_real_pupil(camera.model);
    if (!is_round) {
        wanted.film_mm = {camera.film.width_mm, camera.film.height_mm};
        wanted.film_shift_mm = camera.film.shift_mm;
    }
    {
        const std::lock_guard lock(mutex);
        if (last == wanted) return lines;
    }
    // Without motion: the result depends only on lens and film, and a fast motion must not be refused.
    Camera still = camera;
    still.motion.clear();
    // Points slightly outside the film are needed to interpolate at its corners.
    constexpr double kMargin = 1.05;
    if (has_real_pupil(camera.model)) {
        still.film.width_mm *= kMargin;
        still.film.height_mm *= kMargin;
    }
    const auto setup = setups.make(still, fast_pupil_tracer());
    const RayLoop loop = parallel_ray_loop(heed_signals);
    std::shared_ptr<const ProjectionRays> made;
    if (is_round)
        made = std::make_shared<const RadialProjection>(*setup, ray, loop);
    else
        made = std::make_shared<const ProjectionGrid>(*setup, ray, loop);
    const std::lock_guard lock(mutex);
    last = std::move(wanted);
    return lines = std::move(made);
}

std::int64_t row_count(const Doubles& array, int columns, const char* what) {
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw InputError(std::string(what) + " must be an array of shape (N, " + std::to_string(columns) + ")");
    return array.shape(0);
}

Typed<"NDArray[float64] | tuple[NDArray[float64], NDArray[int32]]"> project(const Camera& camera, const Doubles& points,
                                                                            const std::string& through,
                                                                            bool return_status) {
    const ProjectionRay ray = projection_ray_from(through);
    const std::int64_t count = row_count(points, 3, "points_m");
    py::array_t<double> pixels({count, std::int64_t{2}});
    py::array_t<int> status(count);
    const double* from = points.data();
    double* to = pixels.mutable_data();
    int* states = status.mutable_data();
    {
        const Unlocked unlocked;
        const Projection projection(camera, lines_of(camera, ray));
        parallel_ray_loop(heed_signals).for_all(static_cast<std::size_t>(count), [&](std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const ProjectedPoint at = projection.pixel_of({from[3 * i], from[3 * i + 1], from[3 * i + 2]});
                to[2 * i] = at.pixel.x;
                to[2 * i + 1] = at.pixel.y;
                states[i] = static_cast<int>(at.status);
            }
        });
    }
    if (!return_status) return pixels;
    return py::make_tuple(pixels, status);
}

Typed<"tuple[NDArray[float64], ...]", py::tuple> rays_through(const Camera& camera, const Doubles& pixels,
                                                              const std::string& through, bool return_light) {
    const ProjectionRay which = projection_ray_from(through);
    const std::int64_t count = row_count(pixels, 2, "pixels");
    py::array_t<double> origins({count, std::int64_t{3}}), directions({count, std::int64_t{3}}), light(count);
    const double* from = pixels.data();
    double *at = origins.mutable_data(), *along = directions.mutable_data(), *shares = light.mutable_data();
    {
        const Unlocked unlocked;
        const Projection projection(camera, lines_of(camera, which));
        parallel_ray_loop(heed_signals).for_all(static_cast<std::size_t>(count), [&](std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const PixelRay ray = projection.ray_of({from[2 * i], from[2 * i + 1]});
                const double numbers[] = {ray.origin_m.x,  ray.origin_m.y,  ray.origin_m.z,
                                          ray.direction.x, ray.direction.y, ray.direction.z};
                std::copy(numbers, numbers + 3, at + 3 * i);
                std::copy(numbers + 3, numbers + 6, along + 3 * i);
                shares[i] = ray.light;
            }
        });
    }
    if (return_light) return py::make_tuple(origins, directions, light);
    return py::make_tuple(origins, directions);
}

PinholeCamera pinhole_of(const Camera& camera) {
    const std::optional<PinholeCamera> pinhole = pinhole_camera(camera, middle_pose(camera));
    if (!pinhole)
        throw InputError(
            "lens \"" + camera.lens.name + "\" has no centre of projection: its entrance pupil lies at infinity" +
            (camera.lens.is_rotational() ? "" : ", or no ray goes from its film through its stop's middle"));
    return *pinhole;
}

py::array_t<double> camera_matrix(const Camera& camera) {
    const PinholeCamera pinhole = pinhole_of(camera);
    return array_from(std::vector<double>{pinhole.focal_x, pinhole.column_by_y, pinhole.centre_x, pinhole.row_by_x,
                                          pinhole.focal_y, pinhole.centre_y, 0, 0, 1},
                      {3, 3});
}

Typed<"tuple[NDArray[float64], NDArray[float64]]", py::tuple> world_to_camera(const Camera& camera) {
    const PinholeCamera p = pinhole_of(camera);
    const Vec3d t = p.translation_m;
    return py::make_tuple(array_from(std::vector<double>{p.right.x, p.right.y, p.right.z, p.down.x, p.down.y, p.down.z,
                                                         p.forward.x, p.forward.y, p.forward.z},
                                     {3, 3}),
                          array_from(std::vector<double>{t.x, t.y, t.z}, {3}));
}

}  // namespace

void bind_projection(py::module_& m) {
    py::dict values;
    const std::pair<const char*, ProjectionStatus> statuses[] = {
        {"OK", ProjectionStatus::ok},
        {"OUTSIDE_PICTURE", ProjectionStatus::outside_picture},
        {"BLOCKED", ProjectionStatus::blocked},
        {"BEHIND", ProjectionStatus::behind},
        {"BAD_INPUT", ProjectionStatus::bad_input},
    };
    for (const auto& [name, status] : statuses) values[name] = static_cast<int>(status);
    m.attr("ProjectionStatus") =
        py::module_::import("enum").attr("IntEnum")("ProjectionStatus", values, "module"_a = "realcam");
    py::reinterpret_borrow<py::class_<Camera>>(m.attr("Camera"))
        .def("project", &project, "points_m"_a, py::kw_only(), "through"_a = "light", "return_status"_a = false,
             R"(Where points of the scene, (N, 3) in metres, are in the picture: (N, 2) float64, column and row in
pixels, counted right and down from the picture's upper left corner, so that the middle of the first
pixel is (0.5, 0.5). By real rays at the lens's design wavelength, through lens, focus and stop as they
are, or by the camera's model. Whether something in the scene hides a point is not asked.
through: "light": the middle of the light of a point, as pictures show it, by the mean ray of each
film point; "chief": where the ray through the middle of the stop lands.
NaN where the lens images no such point. return_status: return (pixels, status), with a
ProjectionStatus for each point. Raises InputError.)")
        .def("ray", &rays_through, "pixels"_a, py::kw_only(), "through"_a = "light", "return_light"_a = false,
             R"(The lines along which points of the picture, (N, 2) column and row as from project, look into the
scene: (origins_m, directions), (N, 3) float64, the first where the line leaves the lens, the second
unit. project takes each of their points back to the pixel.
through: "light": the mean of the rays that a film point gets; "chief": that through the middle of
the stop, even where a rim blocks it. NaN for a pixel without light, and at the edge of the image where
the lines turn back inwards. return_light: return (origins_m, directions, light), with the irradiance
of each pixel in an even field, over that in the middle of the film. Raises InputError.)")
        .def_property_readonly(
            "camera_matrix", &camera_matrix,
            R"((3, 3): K of the pinhole that the lens is to first order, in pixels as project counts them. OpenCV, whose
first pixel has its middle at (0, 0), wants 0.5 less in the last column. Raises InputError where the
entrance pupil lies at infinity.)")
        .def_property_readonly(
            "world_to_camera", &world_to_camera,
            R"((R, t), (3, 3) and (3,) in metres: R @ point + t is the point from the middle of the entrance pupil, with
x right, y down and z forward, as OpenCV and COLMAP have it. Of a camera that moves: in the middle of
the exposure. Raises InputError where the entrance pupil lies at infinity.)");
}

}  // namespace realcam::bindings
