#pragma once
#include <cstdint>
#include <vector>

#include "../scene/scene.hpp"

namespace realcam::io {

/// Gives the listed triangles vertices of their own, with normals: the mean of the faces that share the position and
/// lie within 45 degrees of the triangle's own plane, weighted by their angle there (Thuermer and Wuethrich 1998).
/// Sharper edges, such as a cube's, stay edges. None of the triangles may be degenerate.
void smooth_normals(Scene& scene, const std::vector<std::uint32_t>& triangles);

}  // namespace realcam::io
