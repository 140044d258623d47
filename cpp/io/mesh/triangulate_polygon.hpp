#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"

namespace realcam::io {

using PolygonTriangle = std::array<std::uint32_t, 3>;

/// Adds the triangles of a polygon, as indices of its corners and with its orientation: a fan if it is convex,
/// otherwise by ear clipping. Corners need not be exactly coplanar. The work is about n log n; a polygon that crosses
/// itself so often that it would take much more is completed as a fan, and false is returned.
bool triangulate_polygon(std::span<const Vec3d> corners, std::vector<PolygonTriangle>& triangles,
                         Checkpoint& checkpoint);

}  // namespace realcam::io
