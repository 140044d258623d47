// Scene.from_arrays.

#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "../../scene/scene_checks.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "../values/material.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Throws InputError unless the array has the shape (N, columns). `what`: its name, for the message.
void check_shape(const py::array& array, py::ssize_t columns, const char* what) {
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw InputError(std::string(what) + " must be an array of shape (N, " + std::to_string(columns) + ")");
}

/// Converts integers of any dtype. Floats are refused, because a cast would truncate them.
InputArray<std::int64_t> indices_from(const py::object& sequence, const char* what) {
    const py::array values = py::array::ensure(sequence);
    if (!values) {
        PyErr_Clear();
        throw InputError(std::string(what) + " must be an array of integers");
    }
    if (values.size() > 0 && values.dtype().kind() != 'i' && values.dtype().kind() != 'u')
        throw InputError(std::string(what) + " must hold integers");
    return InputArray<std::int64_t>(values);
}

/// See Scene.from_arrays.
Assembly scene_from_arrays(const InputArray<double>& vertices, const ArrayLike& triangle_corners,
                           const std::optional<InputArray<float>>& normals, const std::optional<InputArray<float>>& uvs,
                           const OptionalArrayLike& material_of_triangle, const std::vector<PythonMaterial>& materials,
                           const std::optional<InputArray<float>>& colors) {
    const InputArray<std::int64_t> triangles = indices_from(triangle_corners, "triangles");
    std::optional<InputArray<std::int64_t>> triangle_materials;
    if (!material_of_triangle.is_none()) triangle_materials = indices_from(material_of_triangle, "triangle_materials");
    check_shape(vertices, 3, "vertices_m");
    check_shape(triangles, 3, "triangles");
    Checkpoint checkpoint(heed_signals);
    Scene scene;
    const auto points = vertices.unchecked<2>();
    for (py::ssize_t i = 0; i < points.shape(0); ++i) {
        checkpoint.pass();
        scene.positions_m.push_back({points(i, 0), points(i, 1), points(i, 2)});
    }
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
    if (colors) {
        const bool has_alpha = colors->ndim() == 2 && colors->shape(1) == 4;
        if (!has_alpha) check_shape(*colors, 3, "colors without alpha");
        const auto c = colors->unchecked<2>();
        for (py::ssize_t i = 0; i < c.shape(0); ++i)
            scene.colors.push_back({{c(i, 0), c(i, 1), c(i, 2)}, has_alpha ? c(i, 3) : 1.0f});
    }
    if (triangle_materials && (triangle_materials->ndim() != 1 || triangle_materials->shape(0) != triangles.shape(0)))
        throw InputError("triangle_materials must hold one index for each triangle");
    const auto corners = triangles.unchecked<2>();
    // Checked before a negative or huge index is truncated to 32 bits.
    const auto index = [](std::int64_t value, std::int64_t count, const char* what, py::ssize_t triangle) {
        if (value < 0 || value >= count)
            throw InputError("triangle " + std::to_string(triangle) + " names " + what + ' ' + std::to_string(value) +
                             ", but there are " + std::to_string(count) + " (counted from 0)");
        return static_cast<std::uint32_t>(value);
    };
    scene.materials.resize(materials.empty() ? 1 : materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) set_material(scene, i, materials[i]);
    const bool is_transparent =
        std::any_of(scene.colors.begin(), scene.colors.end(), [](const VertexColor& color) { return color.alpha < 1; });
    for (Material& material : scene.materials) material.vertex_opacity = is_transparent;
    for (py::ssize_t i = 0; i < corners.shape(0); ++i) {
        checkpoint.pass();
        Triangle triangle{};
        for (int k = 0; k < 3; ++k) triangle.vertices[k] = index(corners(i, k), points.shape(0), "vertex", i);
        if (triangle_materials)
            triangle.material =
                index(triangle_materials->at(i), static_cast<std::int64_t>(scene.materials.size()), "material", i);
        scene.triangles.push_back(triangle);
    }
    validate(scene, {}, false, checkpoint);
    const std::size_t dropped = drop_degenerate_triangles(scene);
    if (scene.triangles.empty()) throw InputError("all triangles of the scene have zero area");
    if (dropped > 0) scene.warnings.push_back(std::to_string(dropped) + " triangle(s) without area dropped");
    return scene;
}

}  // namespace

void bind_scene_arrays(py::class_<Assembly>& scene) {
    scene.def_static("from_arrays", &scene_from_arrays, "vertices_m"_a, "triangles"_a, py::kw_only(),
                     "normals"_a = py::none(), "uvs"_a = py::none(), "triangle_materials"_a = py::none(),
                     "materials"_a = std::vector<PythonMaterial>{}, "colors"_a = py::none(),
                     R"(Creates a scene from a triangle mesh.
vertices_m: (V, 3) positions, in metres. triangles: (T, 3) indices of vertices, from 0; counterclockwise as seen from
  the front.
normals: (V, 3) unit shading normals; zero vectors for flat shading. uvs: (V, 2) texture coordinates.
triangle_materials: (T,) indices into materials, from 0; None: all triangles have the first material. materials: list of
  Materials; empty: one default material.
colors: (V, 3) or (V, 4) vertex colours, linear Rec. 709: factors on the materials' diffuse or base colours, the fourth
  on their opacity.
Triangles of zero area are dropped, with a warning in Scene.warnings. Raises InputError and SceneFileError.)");
}

}  // namespace realcam::bindings
