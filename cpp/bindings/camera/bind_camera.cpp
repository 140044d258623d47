// The Python classes Camera and Film.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "../../camera/film/camera.hpp"
#include "../../camera/models/pinhole_camera.hpp"
#include "../../embree/lens_rays.hpp"
#include "../../math/fill_unknown.hpp"
#include "../../math/hypotenuse.hpp"
#include "../../optics/pupil/film_symmetry.hpp"
#include "../../optics/pupil/pupil.hpp"
#include "../../optics/pupil/pupil_grid.hpp"
#include "../../render/settings/setting_names.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/short_text.hpp"
#include "../values/value_methods.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

CameraModel model_from(const std::string& name) {
    if (const auto model = value_named(kCameraModels, name)) return *model;
    throw InputError("unknown camera model \"" + name + "\"; expected " + one_of(kCameraModels));
}

Film make_film(double width_mm, double height_mm, std::pair<int, int> resolution, std::pair<double, double> shift_mm) {
    const Film film{width_mm, height_mm, resolution.first, resolution.second, {shift_mm.first, shift_mm.second}};
    validate(film);
    return film;
}

Film changed_film(const Film& film, std::optional<double> width_mm, std::optional<double> height_mm,
                  std::optional<std::pair<int, int>> resolution, std::optional<std::pair<double, double>> shift_mm) {
    return make_film(width_mm.value_or(film.width_mm), height_mm.value_or(film.height_mm),
                     resolution.value_or(std::pair(film.width, film.height)),
                     shift_mm.value_or(std::pair(film.shift_mm.x, film.shift_mm.y)));
}

/// Keyframe of the pose: (time_s, position, look_at) or (time_s, position, look_at, up).
using Key = std::variant<std::tuple<double, Triple, Triple>, std::tuple<double, Triple, Triple, Triple>>;

std::vector<PoseKey> motion_from(const std::vector<Key>& keys) {
    std::vector<PoseKey> motion;
    for (const Key& key : keys) {
        if (const auto* with_up = std::get_if<1>(&key)) {
            const auto& [time, position, look_at, up] = *with_up;
            motion.push_back({time, {vector_of(position), vector_of(look_at), vector_of(up)}});
        } else {
            const auto& [time, position, look_at] = std::get<0>(key);
            motion.push_back({time, {vector_of(position), vector_of(look_at), Pose().up}});
        }
    }
    return motion;
}

Typed<"tuple[tuple[float, tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]], ...]",
      py::tuple>
keys_of(const Camera& camera) {
    py::list keys;
    for (const PoseKey& key : camera.motion)
        keys.append(
            py::make_tuple(key.time_s, triple(key.pose.position_m), triple(key.pose.look_at_m), triple(key.pose.up)));
    return py::tuple(keys);
}

/// A lens by its surfaces, or by its rays.
using AnyLens = std::variant<LensSystem, std::shared_ptr<RayPairTable>>;

Camera make_camera(const AnyLens& lens, std::optional<Film> film, const Triple& position, const Triple& look_at,
                   const Triple& up, double exposure_time_s, double iso, const std::string& model,
                   double shutter_opens_s, double readout_time_s, const std::vector<Key>& motion,
                   const std::optional<std::shared_ptr<CalibratedGeometry>>& geometry) {
    Camera camera;
    if (const auto* table = std::get_if<std::shared_ptr<RayPairTable>>(&lens)) {
        camera.ray_pairs = *table;
        camera.lens = paraxial_lens(**table);
    } else {
        camera.lens = std::get<LensSystem>(lens);
    }
    camera.film = film ? *film : default_film(camera.lens, std::nullopt, std::nullopt);
    camera.pose = {vector_of(position), vector_of(look_at), vector_of(up)};
    camera.model = model_from(model);
    camera.exposure_time_s = exposure_time_s;
    camera.iso = iso;
    camera.shutter = {shutter_opens_s, readout_time_s};
    if (geometry) camera.geometry = *geometry;
    validate(camera);
    if (!motion.empty()) set_motion(camera, motion_from(motion));
    return camera;
}

Camera changed_camera(Camera camera, const std::optional<LensSystem>& lens, const std::optional<Film>& film,
                      const std::optional<Triple>& position, const std::optional<Triple>& look_at,
                      const std::optional<Triple>& up, std::optional<double> exposure_time_s, std::optional<double> iso,
                      const std::optional<std::string>& model, std::optional<double> shutter_opens_s,
                      std::optional<double> readout_time_s, const std::optional<std::vector<Key>>& motion,
                      const std::optional<std::shared_ptr<CalibratedGeometry>>& geometry) {
    if (position || look_at || up) camera.motion.clear();
    if (lens) camera.lens = *lens;
    if (film) camera.film = *film;
    if (position) camera.pose.position_m = vector_of(*position);
    if (look_at) camera.pose.look_at_m = vector_of(*look_at);
    if (up) camera.pose.up = vector_of(*up);
    camera.exposure_time_s = exposure_time_s.value_or(camera.exposure_time_s);
    camera.iso = iso.value_or(camera.iso);
    if (model) camera.model = model_from(*model);
    camera.shutter.opens_s = shutter_opens_s.value_or(camera.shutter.opens_s);
    camera.shutter.readout_time_s = readout_time_s.value_or(camera.shutter.readout_time_s);
    if (geometry) camera.geometry = *geometry;
    if (motion && motion->empty()) camera.motion.clear();
    validate(camera);
    if (motion && !motion->empty()) set_motion(camera, motion_from(*motion));
    return camera;
}

/// Returns a Python named tuple, in degrees.
Typed<"FieldOfView"> field_of_view_deg(const Camera& camera) {
    const FieldOfView view = field_of_view(camera);
    const auto degrees = [](double radians) { return radians * 180 / std::numbers::pi; };
    return py::module_::import("realcam._core")
        .attr("FieldOfView")(degrees(view.horizontal), degrees(view.vertical), degrees(view.diagonal));
}

std::optional<std::tuple<double, double, double>> pupil_position(const Camera& camera) {
    const std::optional<Vec3d> position = entrance_pupil_position_m(camera);
    if (!position) return std::nullopt;
    return triple(*position);
}

std::string text_of(const Film& film) {
    const bool is_shifted = film.shift_mm.x != 0 || film.shift_mm.y != 0;
    return "<realcam.Film " + digits(film.width_mm) + " x " + digits(film.height_mm) + " mm, " +
           std::to_string(film.width) + " x " + std::to_string(film.height) + " pixels" +
           (is_shifted ? ", shifted by (" + digits(film.shift_mm.x) + ", " + digits(film.shift_mm.y) + ") mm>" : ">");
}

std::string text_of(const Camera& camera) {
    const std::string name = camera.lens.name.empty() ? "a lens" : shortened(camera.lens.name);
    const std::string model = camera.model == CameraModel::full_lens ? "" : std::string(", ") + name_of(camera.model);
    return "<realcam.Camera with " + name + " f/" + digits(nominal_first_order(camera.lens).f_number) + model + " at " +
           point_text(camera.pose.position_m) + ", looks at " + point_text(camera.pose.look_at_m) + ", " +
           time_text(camera.exposure_time_s) + ", ISO " + digits(camera.iso) + '>';
}

void bind_film(py::module_& m) {
    py::class_<Film> film(m, "Film", "The light-sensitive rectangle of a camera, and its pixels.");
    def_hashable_value(film);
    film.def(py::init(&make_film), "width_mm"_a = 36.0, "height_mm"_a = 24.0, "resolution"_a = std::pair(960, 640),
             "shift_mm"_a = std::pair(0.0, 0.0),
             R"(width_mm, height_mm: size. resolution: (columns, rows) of pixels.
shift_mm: (right, up), as in the developed picture: displacement of the film's centre from the lens's axis, as of a
  shift lens, or of a sensor whose principal point is not its centre. Lens and Camera.position do not move.
Raises InputError.)")
        .def_readonly("width_mm", &Film::width_mm, "Width.")
        .def_readonly("height_mm", &Film::height_mm, "Height.")
        .def_property_readonly(
            "resolution", [](const Film& f) { return std::pair(f.width, f.height); }, "(columns, rows) of pixels.")
        .def_property_readonly(
            "shift_mm", [](const Film& f) { return std::pair(f.shift_mm.x, f.shift_mm.y); },
            "(right, up), displacement of the film's centre from the lens's axis.")
        .def_property_readonly(
            "principal_point",
            [](const Film& f) {
                const Vec2<double> axis = f.pixel_of({0, 0});
                return std::pair(axis.x, axis.y);
            },
            "(column, row) at which the lens's axis intersects the film, in pixels from the picture's upper left "
            "corner.")
        .def("replace", &changed_film, py::kw_only(), "width_mm"_a = py::none(), "height_mm"_a = py::none(),
             "resolution"_a = py::none(), "shift_mm"_a = py::none(),
             "Returns the film with some properties changed. Arguments as for Film(); None: unchanged. Raises "
             "InputError.")
        .def("__repr__", [](const Film& f) { return text_of(f); });
}

/// Returns the elements of an array as values of type T. Each is made of `parts` consecutive numbers.
template <class T, int parts, class Number>
std::vector<T> elements(const InputArray<Number>& array) {
    const auto count = static_cast<std::size_t>(array.size()) / parts;
    std::vector<T> result(count);
    const Number* from = array.data();
    for (std::size_t i = 0; i < count; ++i) {
        if constexpr (parts == 3)
            result[i] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
        else if constexpr (parts == 2)
            result[i] = {from[2 * i], from[2 * i + 1]};
        else
            result[i] = static_cast<T>(from[i]);
    }
    return result;
}

/// Throws InputError unless an array has this number of dimensions and, if `parts` is not 0, of numbers in the last.
void require_shape(const py::array& array, int dimensions, int parts, const char* name) {
    if (array.ndim() != dimensions || (parts > 0 && array.shape(dimensions - 1) != parts))
        throw InputError(std::string(name) + " has the wrong shape");
}

/// Returns the directions of nodes, (rows, columns, 3), with extrapolated unit vectors in place of those that are NaN.
std::vector<Vec3d> extrapolated_directions(const InputArray<double>& directions) {
    std::vector<Vec3d> result = elements<Vec3d, 3>(directions);
    if (result.empty()) return result;
    std::vector<std::array<double, 3>> nodes = elements<std::array<double, 3>, 3>(directions);
    fill_unknown(nodes, static_cast<int>(directions.shape(1)));
    for (std::size_t i = 0; i < result.size(); ++i)
        if (!std::isfinite(result[i].x)) result[i] = normalized(Vec3d{nodes[i][0], nodes[i][1], nodes[i][2]});
    return result;
}

std::shared_ptr<RayPairTable> make_ray_pairs(const std::string& name, double wavelength_nm, double length_mm,
                                             double film_distance_mm, double focus_distance_m,
                                             std::pair<double, double> film_mm, double film_radius_mm,
                                             double last_radius_mm, double plane_mm, int degree,
                                             const InputArray<float>& coefficients,
                                             const std::optional<InputArray<float>>& heights,
                                             const InputArray<float>& discs) {
    RayPairTable table{name,
                       wavelength_nm,
                       length_mm,
                       film_distance_mm,
                       1000 * focus_distance_m,
                       film_mm.first,
                       film_mm.second,
                       film_radius_mm,
                       last_radius_mm,
                       plane_mm,
                       degree,
                       {},
                       {},
                       {}};
    require_shape(coefficients, 3, 2, "coefficients");
    table.coefficients = elements<float, 1>(coefficients);
    if (heights) {
        require_shape(*heights, 2, 2, "heights");
        table.heights = elements<float, 1>(*heights);
    }
    require_shape(discs, 3, 2, "discs");
    table.discs = elements<float, 1>(discs);
    validate(table);
    return std::make_shared<RayPairTable>(std::move(table));
}

/// See RayPairTable.trace.
Typed<"tuple[NDArray[float64], NDArray[float64], NDArray[bool]]", py::tuple> trace_ray_pairs(
    const RayPairTable& table, const InputArray<double>& film_mm, const InputArray<double>& last_mm) {
    require_shape(film_mm, 2, 2, "film_mm");
    require_shape(last_mm, 2, 2, "last_mm");
    const py::ssize_t count = film_mm.shape(0);
    if (last_mm.shape(0) != count) throw InputError("film_mm and last_mm must have the same length");
    std::vector<double> origins, directions;
    py::array_t<bool> passed(count);
    const LensPolynomialView view = table.view();
    for (py::ssize_t i = 0; i < count; ++i) {
        LensRays<double, 1> ray;
        const double *film = film_mm.data() + 2 * i, *last = last_mm.data() + 2 * i;
        ray.origin.set(0, {film[0], film[1], 0});
        ray.direction.set(0, normalized(Vec3d{last[0] - film[0], last[1] - film[1], -table.film_distance}));
        ray.status[0] = 0;
        trace_polynomial(view, table.film_distance, ray);
        const Vec3d o = ray.origin[0], d = ray.direction[0];
        origins.insert(origins.end(), {o.x, o.y, o.z});
        directions.insert(directions.end(), {d.x, d.y, d.z});
        passed.mutable_data()[i] = ray.status[0] == 0;
    }
    return py::make_tuple(array_from(origins, {count, 3}), array_from(directions, {count, 3}), passed);
}

void bind_ray_pairs(py::module_& m) {
    py::class_<RayPairTable, std::shared_ptr<RayPairTable>> table(
        m, "RayPairTable",
        "Polynomials fitted to rays before and behind a lens, at one wavelength. Immutable; made by RayPairLens.");
    def_value(table);
    table
        .def(py::init(&make_ray_pairs), py::kw_only(), "name"_a, "wavelength_nm"_a, "length_mm"_a, "film_distance_mm"_a,
             "focus_distance_m"_a, "film_mm"_a, "film_radius_mm"_a, "last_radius_mm"_a, "plane_mm"_a, "degree"_a,
             "coefficients"_a, "heights"_a = py::none(), "discs"_a,
             R"(length_mm: from the front vertex (z = 0) to the last vertex. film_distance_mm: from there to the film.
focus_distance_m: distance of the plane in focus from the film.
film_mm: (width, height) of the film that a Camera uses by default.
film_radius_mm, last_radius_mm: scales of film points x and of points p in the plane of the last vertex; no light beyond.
coefficients: (terms, 3, 2): a and b of position, direction and stop point a x + b p, for the monomials (x.x)^i (p.p)^j
  (x.p)^k with i + j + k <= degree, of which i changes slowest and k fastest.
heights: (terms, 2): z of position and direction. None: positions lie at z = plane_mm, directions are unit vectors.
discs: (discs, 4, 2): a and b of points a x + b p, for the monomials 1, x.p, p.p, x.x; a ray passes if all lie inside the
  unit circle.
Raises InputError.)")
        .def("trace", &trace_ray_pairs, "film_mm"_a, "last_mm"_a,
             R"(Returns (origins_mm, directions, passed), (N, 3), (N, 3) and (N,), of the rays in front of the lens.
film_mm, last_mm: (N, 2), points on the film and in the plane of the last vertex.)")
        .def_property_readonly("paraxial_lens", &paraxial_lens,
                               "Lens of three thin elements with the same first-order data: Camera.lens of a camera "
                               "with this table.")
        .def_readonly("wavelength_nm", &RayPairTable::wavelength_nm, "Wavelength.")
        .def("__repr__", [](const RayPairTable& t) {
            return "<realcam.RayPairTable of " + (t.name.empty() ? "a lens" : shortened(t.name)) + " at " +
                   digits(t.wavelength_nm) + " nm>";
        });
}

std::shared_ptr<CalibratedGeometry> make_geometry(const Film& film, double margin, const InputArray<double>& directions,
                                                  const std::optional<InputArray<float>>& gain,
                                                  const std::optional<InputArray<bool>>& defined, double max_angle_deg,
                                                  const InputArray<float>& positions,
                                                  const std::array<double, 5>& pinhole) {
    CalibratedGeometry geometry;
    geometry.film_width_mm = film.width_mm;
    geometry.film_height_mm = film.height_mm;
    geometry.film_shift_mm = film.shift_mm;
    geometry.margin = margin;
    require_shape(directions, 3, 3, "directions");
    geometry.columns = static_cast<int>(directions.shape(1)) - 1;
    geometry.rows = static_cast<int>(directions.shape(0)) - 1;
    geometry.directions = extrapolated_directions(directions);
    if (gain) geometry.gain = elements<float, 1>(*gain);
    if (defined) {
        require_shape(*defined, 2, 0, "defined");
        geometry.mask = {static_cast<int>(defined->shape(1)), static_cast<int>(defined->shape(0)),
                         elements<std::uint8_t, 1>(*defined)};
    }
    require_shape(positions, 3, 2, "positions");
    geometry.inverse = {static_cast<int>(positions.shape(0)), max_angle_deg * std::numbers::pi / 180,
                        elements<Vec2f, 2>(positions)};
    geometry.pinhole = {pinhole[0], pinhole[1], pinhole[2], pinhole[3], pinhole[4]};
    validate(geometry);
    return std::make_shared<CalibratedGeometry>(std::move(geometry));
}

void bind_geometry(py::module_& m) {
    py::class_<CalibratedGeometry, std::shared_ptr<CalibratedGeometry>> geometry(
        m, "CalibratedGeometry",
        "Directions of the points of a picture, as its camera's centre of projection finds them: those of a "
        "calibration, sampled. Immutable; made by Calibration.camera.");
    def_value(geometry);
    geometry
        .def(py::init(&make_geometry), py::kw_only(), "film"_a, "margin"_a, "directions"_a, "gain"_a = py::none(),
             "defined"_a = py::none(), "max_angle_deg"_a, "positions"_a, "pinhole"_a,
             R"(film: the Film, of which only size and shift count.
directions: (rows + 1, columns + 1, 3), unit vectors in the axes of the camera, x right, y up, z backward, at nodes in
  uniform steps over the picture and, on every side, `margin` times its size; from the upper left corner. NaN where the
  calibration has no ray: these directions are extrapolated.
gain: (rows + 1, columns + 1), factors of the irradiance. None: 1.
defined: (mask rows, mask columns), False where the calibration has no ray. None: True.
positions: (side, side, 2), picture coordinates, from (0, 0) at the upper left corner to (1, 1), of the direction at an
  angle a to the forward axis and the azimuth p from x to y, at a / max_angle_deg * (cos p, sin p) in [-1, 1]^2.
pinhole: (focal_x, focal_y, skew, centre_x, centre_y) of the pinhole camera near the axis, for a picture of size 1 x 1.
Raises InputError.)")
        .def("__repr__", [](const CalibratedGeometry& g) {
            return "<realcam.CalibratedGeometry for a film of " + digits(g.film_width_mm) + " x " +
                   digits(g.film_height_mm) + " mm>";
        });
}

}  // namespace

void bind_camera(py::module_& m) {
    bind_film(m);
    bind_geometry(m);
    bind_ray_pairs(m);
    m.attr("FieldOfView") = py::module_::import("collections")
                                .attr("namedtuple")("FieldOfView", py::make_tuple("horizontal", "vertical", "diagonal"),
                                                    "module"_a = "realcam");
    py::class_<Camera> camera_class(
        m, "Camera",
        R"(Camera: lens, film, pose and exposure. Immutable. position is the centre of the unshifted film (the sensor);
the lens lies in front of it, and the centre of perspective is entrance_pupil_position_m. Film(shift_mm=...) moves only
the film, whose centre is film_centre_m; position and look_at stay on the lens's axis.)");
    def_hashable_value(camera_class);
    camera_class
        .def(py::init(&make_camera), "lens"_a.none(false), py::kw_only(), "film"_a = py::none(),
             "position"_a = Triple{0, 0, 0}, "look_at"_a = Triple{0, 0, -1}, "up"_a = Triple{0, 1, 0},
             "exposure_time_s"_a = 1.0 / 125, "iso"_a = 100.0, "model"_a = "full", "shutter_opens_s"_a = 0.0,
             "readout_time_s"_a = 0.0, "motion"_a = std::vector<Key>(), "geometry"_a = py::none(),
             R"(lens: the Lens, or the RayPairTable of a RayPairLens, which needs the model "polynomial".
film: a Film; None: that of the lens.
position, look_at: (x, y, z) in metres, scene. up: the upward direction.
exposure_time_s: exposure time of each pixel. iso: sensitivity (ISO 12232).
model: camera model: "full" (ray trace through every surface), "thick" (paraxial matrix), "mapped" (an ideal lens with
  the real one's distortion and vignetting), "thin" (ideal lens), or "pinhole".
shutter_opens_s: time in the scene at which the exposure begins. readout_time_s: delay of a rolling shutter from the top
  row of pixels to the bottom row.
motion: keys (time_s, position, look_at) or (time_s, position, look_at, up) in increasing order of time, instead of
  position, look_at and up, which then become those at time 0. Between keys the camera moves uniformly.
geometry: the CalibratedGeometry of a calibration (Calibration.camera) for this film; None: that of the lens.
Raises InputError.)")
        .def("replace", &changed_camera, py::kw_only(), "lens"_a = py::none(), "film"_a = py::none(),
             "position"_a = py::none(), "look_at"_a = py::none(), "up"_a = py::none(), "exposure_time_s"_a = py::none(),
             "iso"_a = py::none(), "model"_a = py::none(), "shutter_opens_s"_a = py::none(),
             "readout_time_s"_a = py::none(), "motion"_a = py::none(), "geometry"_a = py::none(),
             R"(Returns the camera with some properties changed. Arguments as for Camera(); None: unchanged. The film
stays if the lens changes (see Film.for_lens). A new position, look_at or up removes the motion. Raises InputError.)")
        .def_property_readonly(
            "field_of_view_deg", &field_of_view_deg,
            R"(FieldOfView(horizontal, vertical, diagonal): angles in degrees between the directions, in front of the
lens, that are imaged on opposite edges and corners of the film, by real rays at the lens's focus. If the film is
larger than the image circle, between the edges of the image. Raises InputError if the camera model cannot represent
the lens.)")
        .def_property_readonly("entrance_pupil_position_m", &pupil_position,
                               R"((x, y, z), scene: centre of the paraxial entrance pupil, which is the centre of
perspective: a rotation about it causes no parallax. None if it lies at infinity.)")
        .def_property_readonly(
            "film_centre_m", [](const Camera& c) { return triple(film_centre_m(c)); },
            "(x, y, z), scene: centre of the film; differs from position by Film(shift_mm=...).")
        .def_readonly("lens", &Camera::lens, "The Lens.")
        .def_readonly("film", &Camera::film, "The Film.")
        .def_property_readonly(
            "geometry", [](const Camera& c) { return std::const_pointer_cast<CalibratedGeometry>(c.geometry); },
            "The CalibratedGeometry of a calibrated camera, which is immutable; None: the geometry is that of the "
            "lens.")
        .def_property_readonly(
            "ray_pairs", [](const Camera& c) { return std::const_pointer_cast<RayPairTable>(c.ray_pairs); },
            "The RayPairTable of a camera with a RayPairLens; None: the rays are those of the lens's surfaces.")
        .def_property_readonly(
            "position", [](const Camera& c) { return triple(c.pose.position_m); },
            "(x, y, z) of the centre of the unshifted film, in metres, scene.")
        .def_property_readonly(
            "look_at", [](const Camera& c) { return triple(c.pose.look_at_m); },
            "(x, y, z) of a point on the lens's axis in front of the camera, in metres, scene.")
        .def_property_readonly(
            "up", [](const Camera& c) { return triple(c.pose.up); }, "(x, y, z), the upward direction.")
        .def_readonly("exposure_time_s", &Camera::exposure_time_s, "Exposure time of each pixel.")
        .def_readonly("iso", &Camera::iso, "Sensitivity (ISO 12232).")
        .def_property_readonly(
            "shutter_opens_s", [](const Camera& c) { return c.shutter.opens_s; },
            "Time in the scene at which the exposure begins.")
        .def_property_readonly(
            "readout_time_s", [](const Camera& c) { return c.shutter.readout_time_s; },
            "Delay of a rolling shutter from the top row of pixels to the bottom row.")
        .def(
            "pose_at",
            [](const Camera& camera, double time_s) {
                const Pose pose = pose_at(camera, time_s);
                return py::make_tuple(triple(pose.position_m), triple(pose.look_at_m), triple(pose.up));
            },
            "time_s"_a,
            "Returns (position, look_at, up) at a time in seconds of the scene, interpolated between the motion's "
            "keys.")
        .def_property_readonly("motion", &keys_of,
                               "Keys (time_s, position, look_at, up); empty if the camera does not move.")
        .def_property_readonly(
            "model", [](const Camera& c) { return name_of(c.model); }, "Name of the camera model, see Camera().")
        .def("__repr__", [](const Camera& c) { return text_of(c); });
    m.def(
        "pupil_setup",
        [](const LensSystem& lens, bool on_one_core) {
            const Unlocked unlocked;
            PupilTracer tracer = fast_pupil_tracer();
            if (on_one_core) tracer.for_each = PupilTracer().for_each;
            const Vec2<double> corner = {0.5 * lens.film_width, 0.5 * lens.film_height};
            if (has_radial_pupil(lens))
                Pupil(lens, hypotenuse(corner.x, corner.y), std::move(tracer));
            else
                PupilGrid(lens, {{-corner.x, -corner.y}, corner}, mirror_planes(lens), std::move(tracer));
        },
        "lens"_a, "on_one_core"_a = false,
        R"(Computes the table of a lens's pupil over its own film, as rendering does after a change of focus or stop;
for benchmarks. on_one_core: True: uses one CPU core only.)");
}

}  // namespace realcam::bindings
