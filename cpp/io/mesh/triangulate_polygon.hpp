#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"

namespace realcam::io {

using PolygonTriangle = std::array<std::uint32_t, 3>;

/// Adds the triangles of a polygon, as numbers of its corners and in their sense: a fan where it is convex, ears cut
/// off one by one where it is not. Corners need not lie in a plane exactly. The work is about n log n; a polygon that
/// crosses itself so often that it would take much more ends as a fan, and returns false.
bool triangulate_polygon(std::span<const Vec3d> corners, std::vector<PolygonTriangle>& triangles,
                         Checkpoint& checkpoint);

}  // namespace realcam::io
