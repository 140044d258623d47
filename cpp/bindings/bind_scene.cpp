#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <tuple>
#include <variant>

#include "../io/scene_checks.hpp"
#include "../io/scene_file.hpp"
#include "../render/default_view.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
using Colour = std::array<float, 3>;
using Triple = std::array<double, 3>;

Vec3f rgb(const Colour& c) {
    return {c[0], c[1], c[2]};
}
Vec3d vector_of(const Triple& v) {
    return {v[0], v[1], v[2]};
}

/// Textures are decoded in Python, by realcam.image_file: the extension links no image library.
std::optional<io::DecodedImage> read_texture(const std::string& path, std::span<const std::uint8_t> bytes) {
    const py::bytes encoded(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const py::object result = py::module_::import("realcam.image_file").attr("read_texture")(path, encoded);
    if (result.is_none()) return std::nullopt;
    const auto pixels = result.cast<Array<std::uint8_t>>();
    return io::DecodedImage{static_cast<int>(pixels.shape(1)),
                            static_cast<int>(pixels.shape(0)),
                            {pixels.data(), pixels.data() + pixels.size()}};
}

Assembly load(const py::object& path, double scale) {
    return io::read_scene(path_from(path), {scale}, read_texture);
}

/// The scene with a ground that `change` has changed.
template <class Change>
Assembly with_ground(Assembly scene, Change&& change) {
    Scene ground = *scene.ground;
    change(ground);
    io::validate(ground);
    scene.ground = std::make_shared<const Scene>(std::move(ground));
    return scene;
}

void check_shape(const py::array& array, py::ssize_t columns, const char* what) {
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw InputError(std::string(what) + " must be an array of shape (N, " + std::to_string(columns) + ")");
}

/// Whole numbers of any type. A cast from floats would cut their fractions off.
Array<std::int64_t> indices_from(const py::object& sequence, const char* what) {
    const py::array values = py::array::ensure(sequence);
    if (!values) {
        PyErr_Clear();
        throw InputError(std::string(what) + " must be an array of integers");
    }
    if (values.size() > 0 && values.dtype().kind() != 'i' && values.dtype().kind() != 'u')
        throw InputError(std::string(what) + " must hold integers");
    return Array<std::int64_t>(values);
}

Assembly from_arrays(const Array<double>& vertices, const py::object& triangle_corners,
                     const std::optional<Array<float>>& normals, const std::optional<Array<float>>& uvs,
                     const py::object& material_of_triangle, std::vector<Material> materials) {
    const Array<std::int64_t> triangles = indices_from(triangle_corners, "triangles");
    std::optional<Array<std::int64_t>> triangle_materials;
    if (!material_of_triangle.is_none()) triangle_materials = indices_from(material_of_triangle, "triangle_materials");
    check_shape(vertices, 3, "vertices_m");
    check_shape(triangles, 3, "triangles");
    Scene scene;
    const auto points = vertices.unchecked<2>();
    for (py::ssize_t i = 0; i < points.shape(0); ++i)
        scene.positions_m.push_back({points(i, 0), points(i, 1), points(i, 2)});
    if (normals) {
        check_shape(*normals, 3, "normals");
        const auto n = normals->unchecked<2>();
        for (py::ssize_t i = 0; i < n.shape(0); ++i) scene.normals.push_back({n(i, 0), n(i, 1), n(i, 2)});
    }
    if (uvs) {
        check_shape(*uvs, 2, "uvs");
        const auto t = uvs->unchecked<2>();
        for (py::ssize_t i = 0; i < t.shape(0); ++i) scene.uvs.push_back({t(i, 0), t(i, 1)});
    }
    if (triangle_materials && (triangle_materials->ndim() != 1 || triangle_materials->shape(0) != triangles.shape(0)))
        throw InputError("triangle_materials must hold one index for each triangle");
    const auto corners = triangles.unchecked<2>();
    // Checked here, before a negative or huge index is cut down to 32 bits.
    const auto index = [](std::int64_t value, std::int64_t count, const char* what, py::ssize_t triangle) {
        if (value < 0 || value >= count)
            throw InputError("triangle " + std::to_string(triangle) + " names " + what + ' ' + std::to_string(value) +
                             ", but there are " + std::to_string(count) + " (counted from 0)");
        return static_cast<std::uint32_t>(value);
    };
    scene.materials = materials.empty() ? std::vector<Material>(1) : std::move(materials);
    for (py::ssize_t i = 0; i < corners.shape(0); ++i) {
        Triangle triangle{};
        for (int k = 0; k < 3; ++k) triangle.vertices[k] = index(corners(i, k), points.shape(0), "vertex", i);
        if (triangle_materials)
            triangle.material =
                index(triangle_materials->at(i), static_cast<std::int64_t>(scene.materials.size()), "material", i);
        scene.triangles.push_back(triangle);
    }
    io::validate(scene);
    const std::size_t dropped = io::drop_degenerate_triangles(scene);
    if (scene.triangles.empty()) throw InputError("all of the scene's triangles are without area");
    if (dropped > 0) scene.warnings.push_back(std::to_string(dropped) + " triangle(s) without area dropped");
    return scene;
}

Environment environment_from(const py::object& radiance) {
    Environment environment;
    if (py::isinstance<py::array>(radiance) && radiance.cast<py::array>().ndim() == 3) {
        const auto pixels = radiance.cast<Array<float>>();
        if (pixels.shape(2) != 3 || pixels.size() == 0)
            throw InputError("an environment image must be an array of shape (H, W, 3)");
        environment.height = static_cast<std::int32_t>(pixels.shape(0));
        environment.width = static_cast<std::int32_t>(pixels.shape(1));
        const float* data = pixels.data();
        for (py::ssize_t i = 0; i < pixels.size(); i += 3)
            environment.pixels.push_back({data[i], data[i + 1], data[i + 2]});
    } else {
        try {
            const bool several = py::isinstance<py::sequence>(radiance) || py::isinstance<py::array>(radiance);
            const float value = several ? 0.0f : radiance.cast<float>();
            environment.constant = several ? rgb(radiance.cast<Colour>()) : Vec3f{value, value, value};
        } catch (const py::cast_error&) {
            throw InputError("an environment must be a number, (r, g, b), or an image of shape (H, W, 3)");
        }
    }
    return environment;
}

using Corner = std::tuple<double, double, double>;

std::pair<Corner, Corner> bounds(const Assembly& scene) {
    const BoundingBox box = bounding_box(scene);
    return {Corner{box.low.x, box.low.y, box.low.z}, Corner{box.high.x, box.high.y, box.high.z}};
}

/// Of a (4, 4) or (3, 4) matrix.
Affine<double> affine_from(const py::object& matrix) {
    if (matrix.is_none()) return {};
    const auto m = Array<double>::ensure(matrix);
    if (!m) PyErr_Clear();
    if (!m || m.ndim() != 2 || m.shape(1) != 4 || (m.shape(0) != 3 && m.shape(0) != 4))
        throw InputError("scene_from_object must be an array of numbers of shape (4, 4) or (3, 4)");
    if (m.shape(0) == 4 && !(m.at(3, 0) == 0 && m.at(3, 1) == 0 && m.at(3, 2) == 0 && m.at(3, 3) == 1))
        throw InputError("the last row of scene_from_object must be 0, 0, 0, 1");
    const auto column = [&](py::ssize_t c) { return Vec3d{m.at(0, c), m.at(1, c), m.at(2, c)}; };
    return {column(0), column(1), column(2), column(3)};
}

Array<double> matrix_of(const Affine<double>& map) {
    Array<double> matrix({4, 4});
    const Vec3d columns[] = {map.x, map.y, map.z, map.origin};
    for (py::ssize_t c = 0; c < 4; ++c) {
        matrix.mutable_at(0, c) = columns[c].x;
        matrix.mutable_at(1, c) = columns[c].y;
        matrix.mutable_at(2, c) = columns[c].z;
        matrix.mutable_at(3, c) = c == 3;
    }
    return matrix;
}

Assembly with_instance(Assembly scene, const Assembly& object, const py::object& matrix, const std::string& name) {
    add(scene, object, affine_from(matrix), name);
    validate(scene);
    return scene;
}

std::size_t find_instance(const Assembly& scene, const std::variant<std::size_t, std::string>& which) {
    const std::size_t count = scene.instances.size();
    if (const auto* number = std::get_if<std::size_t>(&which)) {
        if (*number < count) return *number;
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

Assembly moved(Assembly scene, const std::variant<std::size_t, std::string>& instance, const py::object& matrix) {
    scene.instances[find_instance(scene, instance)].scene_from_object = affine_from(matrix);
    validate(scene);
    return scene;
}

Material make_material(const Colour& diffuse, const Colour& specular, float shininess, const Colour& emission) {
    Material material;
    material.diffuse = rgb(diffuse);
    material.specular = rgb(specular);
    material.shininess = shininess;
    material.emission = rgb(emission);
    return material;
}

}  // namespace

void bind_scene(py::module_& m) {
    py::class_<Material>(m, "Material", "How a surface reflects and shines. Colours are linear Rec. 709.")
        .def(py::init(&make_material), py::kw_only(), "diffuse"_a = Colour{0.5f, 0.5f, 0.5f},
             "specular"_a = Colour{0, 0, 0}, "shininess"_a = 0.0f, "emission"_a = Colour{0, 0, 0},
             "diffuse, specular: reflectance of Lambert's and of Phong's lobe; shininess: Phong exponent;\n"
             "emission: radiance in cd/m^2, on the side from which the corners run counter-clockwise.");
    py::class_<Assembly>(
        m, "Scene",
        "Triangles, materials and lights, and objects that stand among them, as often as one likes;\n"
        "metres, right-handed, y up. A value: what changes it returns a new one, which shares the rest.")
        .def_static("load", &load, "path"_a, py::kw_only(), "scale"_a = 1.0,
                    "Reads .obj (with its .mtl), .gltf, .glb or .ply. scale: metres per unit of the file.\n"
                    "Raises SceneFileError. What could be put up with is in warnings.")
        .def_static(
            "from_arrays", &from_arrays, "vertices_m"_a, "triangles"_a, py::kw_only(), "normals"_a = py::none(),
            "uvs"_a = py::none(), "triangle_materials"_a = py::none(), "materials"_a = std::vector<Material>{},
            "vertices_m: (V, 3) float; triangles: (T, 3) int; normals: (V, 3) unit, zero for flat; uvs: (V, 2);\n"
            "triangle_materials: (T,) indices into materials. Raises InputError or SceneFileError.")
        .def(
            "with_environment",
            [](const Assembly& scene, const py::object& radiance) {
                return with_ground(scene, [&](Scene& ground) { ground.environment = environment_from(radiance); });
            },
            "radiance"_a,
            "The scene in light from all around: a number or (r, g, b) in cd/m^2, or an (H, W, 3) latitude-longitude "
            "image\n"
            "(row 0 up, its middle column towards -z).")
        .def(
            "with_sun",
            [](const Assembly& scene, const Triple& direction, const Colour& illuminance) {
                const Vec3d d = vector_of(direction);
                const double size = length(d);
                if (!(size > 0) || !std::isfinite(size))
                    throw InputError("the sun's direction must be a finite vector, not zero");
                return with_ground(scene, [&](Scene& ground) {
                    ground.suns.push_back({static_cast<Vec3f>((1 / size) * d), rgb(illuminance)});
                });
            },
            "direction"_a, "illuminance"_a,
            "With parallel light that travels along direction; illuminance (r, g, b) in lux.")
        .def(
            "with_point_light",
            [](const Assembly& scene, const Triple& position, const Colour& intensity) {
                return with_ground(
                    scene, [&](Scene& ground) { ground.points.push_back({vector_of(position), rgb(intensity)}); });
            },
            "position_m"_a, "intensity"_a, "With a point light; intensity (r, g, b) in cd.")
        .def(
            "with_texture",
            [](const Assembly& scene, std::size_t material, const Array<std::uint8_t>& pixels) {
                if (material >= scene.ground->materials.size())
                    throw InputError("there is no material " + std::to_string(material));
                if (pixels.ndim() != 3 || pixels.shape(2) != 4)
                    throw InputError("a texture must be an (H, W, 4) array of uint8, sRGB");
                return with_ground(scene, [&](Scene& ground) {
                    ground.materials[material].diffuse_texture = static_cast<std::int32_t>(ground.textures.size());
                    ground.textures.push_back({"",
                                               static_cast<std::int32_t>(pixels.shape(1)),
                                               static_cast<std::int32_t>(pixels.shape(0)),
                                               {pixels.data(), pixels.data() + pixels.size()}});
                });
            },
            "material"_a, "pixels"_a, "With a diffuse texture on a material: (H, W, 4) uint8, sRGB, row 0 at v = 1.")
        .def(
            "with_instance", &with_instance, "object"_a, "scene_from_object"_a = py::none(), py::kw_only(),
            "name"_a = "",
            "With another scene in it as an object: its triangles and point lights, but not its suns and environment.\n"
            "scene_from_object: (4, 4) or (3, 4) matrix for columns (x, y, z, 1), metres; none: as it is. The "
            "object's\n"
            "triangles are shared, however often it stands there. Raises InputError for a matrix that is flat.")
        .def("moved", &moved, "instance"_a, "scene_from_object"_a,
             "With one of the instances, by its name or number, in another place. Made for every frame: the next\n"
             "picture takes over all that was built for the last. Raises InputError where there is none, or several.")
        .def_property_readonly(
            "instances",
            [](const Assembly& scene) {
                py::list list;
                for (const Instance& i : scene.instances)
                    list.append(py::make_tuple(i.name, matrix_of(i.scene_from_object)));
                return py::tuple(list);
            },
            "For each its name and (4, 4) scene_from_object.")
        .def_property_readonly("triangle_count", &Assembly::triangle_count,
                               "Of all instances, each as often as it stands there.")
        .def_property_readonly("material_count", [](const Assembly& s) { return s.ground->materials.size(); })
        .def_property_readonly("has_light", &Assembly::has_light)
        .def_property_readonly("bounds_m", &bounds, "Lowest and highest corner of the bounding box.")
        .def_property_readonly(
            "warnings", [](const Assembly& s) { return s.ground->warnings; },
            "What the reader put up with, such as a missing texture.")
        .def("__repr__",
             [](const Assembly& s) { return "<realcam.Scene, " + std::to_string(s.triangle_count()) + " triangles>"; });
}

}  // namespace realcam::bindings
