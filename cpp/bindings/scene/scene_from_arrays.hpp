#pragma once
#include <optional>
#include <vector>

#include "../../scene/assembly.hpp"
#include "../values/arrays.hpp"
#include "../values/material.hpp"

namespace realcam::bindings {

/// See Scene.from_arrays.
Assembly scene_from_arrays(const InputArray<double>& vertices, const pybind11::object& triangle_corners,
                           const std::optional<InputArray<float>>& normals, const std::optional<InputArray<float>>& uvs,
                           const pybind11::object& material_of_triangle, const std::vector<PythonMaterial>& materials,
                           const std::optional<InputArray<float>>& colors);

}  // namespace realcam::bindings
