// Projection of scene points to pixels and of pixels to rays: Camera.project, Camera.ray, and the first-order pinhole.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <mutex>

#include "../../camera/camera_setup.hpp"
#include "../../camera/models/chief_rays.hpp"
#include "../../camera/models/pinhole_camera.hpp"
#include "../../camera/projection/calibrated_projection.hpp"
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
    throw InputError("unknown ray \"" + name + "\"; expected light or chief");
}

/// Returns the projection rays of a camera; caches the last result, because most programs use the same lens and film
/// repeatedly. Must be called without the GIL.
std::shared_ptr<const ProjectionRays> projection_rays_of(const Camera& camera, ProjectionRay ray) {
    /// Properties of a camera on which its projection rays depend.
    struct Key {
        LensSystem lens;
        double film_radius_mm;  ///< sufficient for a rotationally symmetric lens
        Vec2<double> film_mm, film_shift_mm;  ///< otherwise: size and shift of the film
        CameraModel model;
        ProjectionRay ray;
        std::shared_ptr<const CalibratedGeometry> geometry;
        std::shared_ptr<const RayPairTable> ray_pairs;
        bool operator==(const Key&) const = default;
    };
    static std::mutex mutex;
    static std::optional<Key> cached_key;
    static std::shared_ptr<const ProjectionRays> cached_rays;
    static LastSetup setups;
    validate(camera);
    Key key = {camera.lens, camera.film.radius_mm(), {}, {}, camera.model, ray, camera.geometry, camera.ray_pairs};
    const bool is_radial = has_radial_pupil(camera.lens) || !has_real_pupil(camera.model);
    if (!is_radial) {
        key.film_mm = {camera.film.width_mm, camera.film.height_mm};
        key.film_shift_mm = camera.film.shift_mm;
    }
    {
        const std::lock_guard lock(mutex);
        if (cached_key == key) return cached_rays;
    }
    // Without motion: the result depends only on lens and film, and a fast motion must not be refused.
    Camera still = camera;
    still.motion.clear();
    still.geometry = nullptr;
    // Points slightly outside the film are needed to interpolate at its corners.
    constexpr double kMargin = 1.05;
    if (has_real_pupil(camera.model)) {
        still.film.width_mm *= kMargin;
        still.film.height_mm *= kMargin;
    }
    const auto setup = setups.make(still, fast_pupil_tracer());
    const RayLoop loop = parallel_ray_loop(heed_signals);
    std::shared_ptr<const ProjectionRays> rays;
    if (is_radial)
        rays = std::make_shared<const RadialProjection>(*setup, ray, loop);
    else
        rays = std::make_shared<const ProjectionGrid>(*setup, ray, loop);
    if (camera.geometry)
        rays = std::make_shared<const CalibratedProjection>(
            std::move(rays), BundleMotions(camera, setup->view(camera.pose.position_m), fast_pupil_tracer()));
    const std::lock_guard lock(mutex);
    cached_key = std::move(key);
    return cached_rays = std::move(rays);
}

/// Returns the number of rows N. Throws InputError unless the array has the shape (N, columns); `what`: its name.
std::int64_t row_count(const Doubles& array, int columns, const char* what) {
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw InputError(std::string(what) + " must be an array of shape (N, " + std::to_string(columns) + ")");
    return array.shape(0);
}

/// See Camera.project.
Typed<"NDArray[float64] | tuple[NDArray[float64], NDArray[int32]]"> project(const Camera& camera, const Doubles& points,
                                                                            const std::string& through,
                                                                            bool return_status) {
    const ProjectionRay ray = projection_ray_from(through);
    const std::int64_t count = row_count(points, 3, "points_m");
    py::array_t<double> pixels({count, std::int64_t{2}});
    py::array_t<int> status(count);
    const double* from = points.data();
    double* to = pixels.mutable_data();
    int* to_status = status.mutable_data();
    {
        const Unlocked unlocked;
        const Projection projection(camera, projection_rays_of(camera, ray));
        parallel_ray_loop(heed_signals).for_all(static_cast<std::size_t>(count), [&](std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const ProjectedPoint point = projection.pixel_of({from[3 * i], from[3 * i + 1], from[3 * i + 2]});
                to[2 * i] = point.pixel.x;
                to[2 * i + 1] = point.pixel.y;
                to_status[i] = static_cast<int>(point.status);
            }
        });
    }
    if (!return_status) return pixels;
    return py::make_tuple(pixels, status);
}

/// See Camera.ray.
Typed<"tuple[NDArray[float64], ...]", py::tuple> rays_through(const Camera& camera, const Doubles& pixels,
                                                              const std::string& through, bool return_light) {
    const ProjectionRay kind = projection_ray_from(through);
    const std::int64_t count = row_count(pixels, 2, "pixels");
    py::array_t<double> origins({count, std::int64_t{3}}), directions({count, std::int64_t{3}}), light(count);
    const double* from = pixels.data();
    double *to_origins = origins.mutable_data(), *to_directions = directions.mutable_data(),
           *to_light = light.mutable_data();
    {
        const Unlocked unlocked;
        const Projection projection(camera, projection_rays_of(camera, kind));
        parallel_ray_loop(heed_signals).for_all(static_cast<std::size_t>(count), [&](std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const PixelRay ray = projection.ray_of({from[2 * i], from[2 * i + 1]});
                const double numbers[] = {ray.origin_m.x,  ray.origin_m.y,  ray.origin_m.z,
                                          ray.direction.x, ray.direction.y, ray.direction.z};
                std::copy(numbers, numbers + 3, to_origins + 3 * i);
                std::copy(numbers + 3, numbers + 6, to_directions + 3 * i);
                to_light[i] = ray.light;
            }
        });
    }
    if (return_light) return py::make_tuple(origins, directions, light);
    return py::make_tuple(origins, directions);
}

/// See traced_chief_rays in bind_projection.
Typed<"tuple[NDArray[float64], NDArray[float64]]", py::tuple> traced_chief_rays(
    const Camera& camera, const Doubles& pixels, const std::optional<std::pair<Doubles, Doubles>>& lens_rays) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const std::int64_t count = row_count(pixels, 2, "pixels");
    if (lens_rays && (row_count(lens_rays->first, 3, "lens_rays[0]") != count ||
                      row_count(lens_rays->second, 3, "lens_rays[1]") != count))
        throw InputError("lens_rays must have a ray for each pixel");
    py::array_t<double> origins({count, std::int64_t{3}}), directions({count, std::int64_t{3}});
    const double* from = pixels.data();
    double *to_origins = origins.mutable_data(), *to_directions = directions.mutable_data();
    {
        const Unlocked unlocked;
        static LastSetup setups;
        const auto setup = setups.make(camera, fast_pupil_tracer());
        const CameraView view = setup->view(camera.pose.position_m);
        const LensChiefRays chief_rays(camera, view);
        const Affine<double> scene_from_camera = camera_detail::scene_from_camera(camera.pose);
        const InverseAffine<double> camera_from_scene = scene_from_camera.inverse();
        const auto lens_ray = [&](std::size_t i, Vec2<double> film) -> std::optional<RayLine> {
            if (!lens_rays) return chief_rays.trace(film);
            const auto row = [&](const Doubles& array) {
                const double* numbers = array.data() + 3 * i;
                return Vec3d{numbers[0], numbers[1], numbers[2]};
            };
            return RayLine{camera_from_scene.direction(row(lens_rays->second)),
                           1000.0 * camera_from_scene.point(row(lens_rays->first))};
        };
        parallel_ray_loop(heed_signals).for_all(static_cast<std::size_t>(count), [&](std::size_t i, std::size_t end) {
            for (; i < end; ++i) {
                const Vec2<double> point = camera.film.point_of({from[2 * i], from[2 * i + 1]});
                const Vec2f film = {static_cast<float>(-point.x), static_cast<float>(-point.y)};
                std::optional<RayLine> ray = lens_ray(i, {-point.x, -point.y});
                if (view.bundles.nodes && !is_defined(view.bundles, film)) ray = std::nullopt;
                if (!ray) ray = RayLine{{kNone, kNone, kNone}, {kNone, kNone, kNone}};
                Vec3d origin = 0.001 * ray->foot, direction = ray->direction;
                if (view.bundles.nodes) {
                    const BundleMotion motion = bundle_motion(view.bundles, film);
                    origin = moved_point(view.bundles, motion, origin);
                    direction = rotated(motion.rotation(), direction);
                }
                origin = scene_from_camera.point(origin);
                direction = scene_from_camera.direction(direction);
                const double numbers[] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
                std::copy(numbers, numbers + 3, to_origins + 3 * i);
                std::copy(numbers + 3, numbers + 6, to_directions + 3 * i);
            }
        });
    }
    return py::make_tuple(origins, directions);
}

/// Returns the pinhole camera that the lens is to first order. Throws InputError if there is none.
PinholeCamera pinhole_of(const Camera& camera) {
    const std::optional<PinholeCamera> pinhole = pinhole_camera(camera, pose_at_mid_exposure(camera));
    if (!pinhole)
        throw InputError(
            "lens \"" + camera.lens.name + "\" has no centre of projection: its entrance pupil lies at infinity" +
            (camera.lens.is_rotational() ? "" : ", or no ray passes from the film through the centre of the stop"));
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
    m.def("traced_chief_rays", &traced_chief_rays, "camera"_a, "pixels"_a, "lens_rays"_a = py::none(),
          R"(Returns (origins_m, directions), (N, 3) float64, scene, of the chief rays of pixels (N, 2) in front of the
camera: each is traced through the lens, or is that of the camera model, and moved as rendering moves it. Origins lie on
the ray near the centre of projection. NaN for pixels without a chief ray. For a camera that does not move.
lens_rays: the result for these pixels of the camera without its geometry; None: traced here.)");
    py::reinterpret_borrow<py::class_<Camera>>(m.attr("Camera"))
        .def("project", &project, "points_m"_a, py::kw_only(), "through"_a = "light", "return_status"_a = false,
             R"(Projects points of the scene to pixels, by real rays at the lens's design wavelength or by the camera
model.
points_m: (N, 3), in metres, scene. Occlusion by the scene is not considered.
through: projection ray of a point. "light": the centroid of its light, as pictures show it, by the centroid ray of each
  film point; "chief": the chief ray, through the centre of the stop.
return_status: True: return (pixels, status), with a ProjectionStatus for each point.
Returns (N, 2) float64: column and row in pixels, to the right and down from the picture's upper left corner; the centre
of the first pixel is (0.5, 0.5). NaN if the lens does not image the point. Raises InputError.)")
        .def(
            "ray", &rays_through, "pixels"_a, py::kw_only(), "through"_a = "light", "return_light"_a = false,
            R"(Returns the projection rays of pixels: (origins_m, directions), (N, 3) float64, scene. Origins lie on the
front of the lens, directions are unit vectors into the scene. project() maps every point of a ray to its pixel.
pixels: (N, 2), column and row, see Camera.project.
through: "light": the centroid of the rays that reach the film point; "chief": the ray through the centre of the stop,
  even if a rim blocks it.
return_light: True: return (origins_m, directions, light), with the relative illumination (N,): irradiance of the pixel
  in a uniform field over that at the film centre.
NaN for a pixel without light, and at the edge of the image where the field angle no longer increases. Raises
InputError.)")
        .def_property_readonly(
            "camera_matrix", &camera_matrix,
            R"((3, 3): intrinsic matrix K of the pinhole camera that the lens is to first order, in the pixel
coordinates of project(). For OpenCV, whose first pixel has its centre at (0, 0), subtract 0.5 from the principal point
in the last column. Raises InputError if the entrance pupil lies at infinity.)")
        .def_property_readonly(
            "world_to_camera", &world_to_camera,
            R"((R, t), arrays (3, 3) and (3,), in metres: R @ point + t is a scene point relative to the centre of the
entrance pupil, with x to the right, y down and z forward, as in OpenCV and COLMAP. For a moving camera, at the middle
of the exposure. Raises InputError if the entrance pupil lies at infinity.)");
}

}  // namespace realcam::bindings
