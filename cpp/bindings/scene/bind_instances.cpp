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

/// Returns the affine transform of a (4, 4) or (3, 4) matrix in row-major order.
Affine<double> affine_from(const double* m, bool has_last_row) {
    if (has_last_row && !(m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1))
        throw InputError("the last row of scene_from_object must be 0, 0, 0, 1");
    const auto column = [&](int c) { return Vec3d{m[c], m[4 + c], m[8 + c]}; };
    return {column(0), column(1), column(2), column(3)};
}

struct Transforms {
    std::vector<Affine<double>> list;
    bool several;  ///< true if given as an array of matrices
};

Transforms transforms_from(const py::object& matrices) {
    const auto m = matrices.is_none() ? InputArray<double>() : InputArray<double>::ensure(matrices);
    if (!m) PyErr_Clear();
    const py::ssize_t axes = m && !matrices.is_none() ? m.ndim() : 0;
    if (axes < 2 || axes > 3 || m.shape(axes - 1) != 4 || (m.shape(axes - 2) != 3 && m.shape(axes - 2) != 4))
        throw InputError("scene_from_object must be an array of numbers of shape (4, 4) or (3, 4), or several of them");
    const py::ssize_t count = axes == 3 ? m.shape(0) : 1, rows = m.shape(axes - 2);
    std::vector<Affine<double>> transforms;
    if (count == 0) throw InputError("scene_from_object holds no matrix; one for each instance is wanted");
    for (py::ssize_t i = 0; i < count; ++i) transforms.push_back(affine_from(m.data() + 4 * rows * i, rows == 4));
    return {transforms, axes == 3};
}

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
        const bool numbered = transforms.several && !name.empty();
        for (std::size_t i = 0; i < transforms.list.size(); ++i)
            add(scene, object, transforms.list[i], numbered ? name + ' ' + std::to_string(i) : name, names);
    }
    validate(scene);
    return scene;
}

std::size_t find_instance(const Assembly& scene, const std::variant<py::ssize_t, std::string>& which) {
    const std::size_t count = scene.instances.size();
    if (const auto* number = std::get_if<py::ssize_t>(&which)) {
        if (*number >= 0 && static_cast<std::size_t>(*number) < count) return static_cast<std::size_t>(*number);
        throw InputError("there is no instance " + std::to_string(*number) + "; the scene has " +
                         std::to_string(count) + " (counted from 0)");
    }
    const std::string& name = std::get<std::string>(which);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < count; ++i)
        if (scene.instances[i].name == name) found.push_back(i);
    if (found.size() == 1) return found.front();
    throw InputError(found.empty() ? "there is no instance \"" + name + '"'
                                   : "there are " + std::to_string(found.size()) + " instances \"" + name +
                                         "\"; the number of one of them is wanted");
}

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
        if (transforms.several)
            throw InputError(
                "an instance that stays where it is has one transform; for one that moves, times_s is "
                "wanted: the time of each");
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
             R"(With another scene in it as an object: its triangles and point lights, but not its suns and environment.
scene_from_object: matrix of shape (4, 4) or (3, 4) for columns (x, y, z, 1), metres; none: as it is.
(K, 4, 4) or (K, 3, 4): K of them, with names "name 0", "name 1", ... The object's triangles are
shared by all of them; its own instances become its parts, which move with it, by the name
"name/part". A name that the scene has already gets a number: "car", "car.2", "car.3".
Raises InputError for a matrix that is flat.)")
        .def("moved", &moved, "instance"_a, "scene_from_object"_a, "times_s"_a = py::none(),
             R"(With another transform of one of the instances, by its name or number, and of its parts.
times_s: of K keys, in rising order, seconds of the scene; scene_from_object then has shape (K, 4, 4) or
(K, 3, 4). Between two keys it moves evenly and turns by the shorter way (Shoemake and Duff 1992), before
the first and after the last it stands; what the shutter sees of it is blurred (Camera.shutter_opens_s).
Made for every frame: the next picture takes over all that was built for the last.
Raises InputError where there is no such instance, or several, and for what is no transform or motion.)")
        .def("at_time", &standing_at, "time_s"_a,
             "The scene as it stands at a time: with the transforms of then, and "
             "without motion.")
        .def_property_readonly("instances", &instances_of,
                               "For each its name and (4, 4) scene_from_object; of one that moves, at time 0.")
        .def_property_readonly(
            "cameras", &cameras_of,
            R"(Cameras of a glTF, for each (name, (4, 4) scene_from_camera at time 0, vertical field of view in
degrees): they look along -z, y upwards. Of an orthographic one the field is 0. See Camera.framing.)")
        .def_property_readonly("motions", &motions_of,
                               "For each instance None, or (times_s, (K, 4, 4) scene_from_object) of one that moves.");
}

}  // namespace realcam::bindings
