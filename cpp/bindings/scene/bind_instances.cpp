// Methods of Scene for instances and cameras.

#include <pybind11/stl.h>

#include <optional>
#include <variant>
#include <vector>

#include "../../scene/assembly.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Returns the affine transform of a (4, 4) or (3, 4) matrix in row-major order. Throws InputError if the last row of a
/// (4, 4) matrix is not 0, 0, 0, 1.
Affine<double> affine_from(const double* m, bool has_last_row) {
    if (has_last_row && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1))
        throw InputError("the last row of scene_from_object must be 0, 0, 0, 1");
    const auto column = [&](int c) { return Vec3d{m[c], m[4 + c], m[8 + c]}; };
    return {column(0), column(1), column(2), column(3)};
}

struct Transforms {
    std::vector<Affine<double>> list;
    bool is_array;  ///< true for an array of matrices, false for a single matrix
};

/// Converts an array of shape (4, 4), (3, 4), (K, 4, 4) or (K, 3, 4). Throws InputError for others.
Transforms transforms_from(const py::object& matrices) {
    const auto m = matrices.is_none() ? InputArray<double>() : InputArray<double>::ensure(matrices);
    if (!m) PyErr_Clear();
    const py::ssize_t dimensions = m && !matrices.is_none() ? m.ndim() : 0;
    if (dimensions < 2 || dimensions > 3 || m.shape(dimensions - 1) != 4 ||
        (m.shape(dimensions - 2) != 3 && m.shape(dimensions - 2) != 4))
        throw InputError("scene_from_object must be an array of numbers of shape (4, 4) or (3, 4), or several of them");
    const py::ssize_t count = dimensions == 3 ? m.shape(0) : 1, rows = m.shape(dimensions - 2);
    std::vector<Affine<double>> transforms;
    if (count == 0) throw InputError("scene_from_object holds no matrix; expected one for each instance");
    for (py::ssize_t i = 0; i < count; ++i) transforms.push_back(affine_from(m.data() + 4 * rows * i, rows == 4));
    return {transforms, dimensions == 3};
}

/// Returns the (4, 4) matrix of an affine transform.
py::array_t<double> matrix_of(const Affine<double>& map) {
    const Vec3d columns[] = {map.x, map.y, map.z, map.origin};
    return table_of(4, 4, [&](std::size_t row, std::size_t c) {
        const double rows[] = {columns[c].x, columns[c].y, columns[c].z, c == 3 ? 1.0 : 0.0};
        return rows[row];
    });
}

Assembly with_instance(Assembly scene, const Assembly& object, const OptionalArrayLike& matrices,
                       const std::string& name) {
    DistinctNames names(scene);
    if (matrices.is_none()) {
        add(scene, object, {}, name, names);
    } else {
        const Transforms transforms = transforms_from(matrices);
        const bool numbered = transforms.is_array && !name.empty();
        for (std::size_t i = 0; i < transforms.list.size(); ++i)
            add(scene, object, transforms.list[i], numbered ? name + ' ' + std::to_string(i) : name, names);
    }
    validate(scene);
    return scene;
}

/// Returns the index of an instance, specified by its index or name. Throws InputError if there is no such instance, or
/// several have the name.
std::size_t find_instance(const Assembly& scene, const std::variant<py::ssize_t, std::string>& which) {
    const std::size_t count = scene.instances.size();
    if (const auto* index = std::get_if<py::ssize_t>(&which)) {
        if (*index >= 0 && static_cast<std::size_t>(*index) < count) return static_cast<std::size_t>(*index);
        throw InputError("there is no instance " + std::to_string(*index) + "; the scene has " + std::to_string(count) +
                         " (counted from 0)");
    }
    const std::string& name = std::get<std::string>(which);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < count; ++i)
        if (scene.instances[i].name == name) found.push_back(i);
    if (found.size() == 1) return found.front();
    throw InputError(found.empty() ? "there is no instance \"" + name + '"'
                                   : "there are " + std::to_string(found.size()) + " instances \"" + name +
                                         "\"; specify one of them by its index");
}

/// See Scene.moved.
Assembly moved(Assembly scene, const std::variant<py::ssize_t, std::string>& which, const ArrayLike& matrices,
               const std::optional<std::vector<double>>& times_s) {
    const std::size_t instance = find_instance(scene, which);
    Transforms transforms = transforms_from(matrices);
    if (times_s) {
        Motion motion{*times_s, std::move(transforms.list)};
        if (const std::string why = motion_error(motion); !why.empty())
            throw InputError(label(scene, instance) + ": " + why);
        move(scene, instance, AnimatedTransform(std::move(motion)));
    } else {
        if (transforms.is_array)
            throw InputError(
                "scene_from_object must be a single matrix, unless times_s specifies the times of a moving instance's "
                "keys");
        move(scene, instance, transforms.list.front());
    }
    validate(scene);
    return scene;
}

Typed<"tuple[tuple[str, NDArray[float64]], ...]", py::tuple> instances_of(const Assembly& scene) {
    py::list list;
    for (const Instance& i : scene.instances)
        list.append(py::make_tuple(text_from(i.name), matrix_of(i.scene_from_object)));
    return py::tuple(list);
}

/// Returns an array of (4, 4) matrices, one for each transform.
py::array_t<double> matrices_of(const std::vector<Affine<double>>& maps) {
    py::list list;
    for (const Affine<double>& map : maps) list.append(matrix_of(map));
    return py::module_::import("numpy").attr("array")(list);
}

Typed<"tuple[tuple[tuple[float, ...], NDArray[float64]] | None, ...]", py::tuple> motions_of(const Assembly& scene) {
    py::list list;
    for (const Instance& i : scene.instances) {
        if (i.motion)
            list.append(py::make_tuple(py::tuple(py::cast(i.motion->times_s)), matrices_of(i.motion->transforms)));
        else
            list.append(py::none());
    }
    return py::tuple(list);
}

Typed<"tuple[tuple[str, NDArray[float64], float], ...]", py::tuple> cameras_of(const Assembly& scene) {
    constexpr double kDegrees = 57.29577951308232;
    py::list list;
    for (const SceneCamera& camera : scene.cameras)
        list.append(py::make_tuple(text_from(camera.name), matrix_of(camera.scene_from_camera),
                                   kDegrees * camera.vertical_field_rad));
    return py::tuple(list);
}

}  // namespace

void bind_instances(py::class_<Assembly>& scene) {
    scene
        .def("with_instance", &with_instance, "object"_a, "scene_from_object"_a = py::none(), py::kw_only(),
             "name"_a = "",
             R"(Returns the scene with another scene inserted as an instanced object.
object: its triangles and point lights are inserted, but not its suns and environment. All instances share its
  triangles. Its own instances become parts of the new instance, named "name/part", and move with it.
scene_from_object: matrix of shape (4, 4) or (3, 4) for column vectors (x, y, z, 1), in metres; None: the identity. An
  array (K, 4, 4) or (K, 3, 4) inserts K instances, named "name 0", "name 1", ...
name: name of the instance. If the scene already has the name, a number is appended: "car.2", "car.3".
Raises InputError, also for a singular matrix.)")
        .def("moved", &moved, "instance"_a, "scene_from_object"_a, "times_s"_a = py::none(),
             R"(Returns the scene with the transform of an instance, and of its parts, replaced.
instance: name or index of the instance.
scene_from_object: matrix of shape (4, 4) or (3, 4), in metres; or (K, 4, 4) or (K, 3, 4) with times_s.
times_s: times of K keys in seconds of the scene, increasing. Between keys the translation is linear and the rotation
  takes the shorter arc (polar decomposition: Shoemake and Duff 1992); before the first and after the last key the
  instance stands still. Motion during the exposure is blurred (Camera.shutter_opens_s).
Cheap enough to call for every frame: acceleration structures are reused. Raises InputError if there is no such
instance, if several have the name, and for an invalid transform or motion.)")
        .def("at_time", &frozen_at, "time_s"_a,
             "Returns the scene at a time, in seconds: with the transforms of that time, and without motion.")
        .def_property_readonly(
            "instances", &instances_of,
            "(name, (4, 4) scene_from_object) of each instance; the transform at time 0 if the instance moves.")
        .def_property_readonly(
            "cameras", &cameras_of,
            R"((name, (4, 4) scene_from_camera at time 0, vertical field of view in degrees) of each camera in a glTF
file. They look along -z, with y upwards. The field of view of an orthographic camera is 0. See Camera.framing.)")
        .def_property_readonly(
            "motions", &motions_of,
            "For each instance (times_s, (K, 4, 4) scene_from_object), or None if it does not move.");
}

}  // namespace realcam::bindings
