#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../math/vec3.hpp"

namespace realcam::io {

/// Indices of a triangle's corners among those of the polygon.
using PolygonTriangle = std::array<std::uint32_t, 3>;

/// Appends the triangles of a polygon, with its orientation: a fan if it is convex, otherwise by ear clipping. Corners
/// need not be exactly coplanar. The work is about n log n. Returns false if the polygon crosses itself so often that
/// the work would be much more; then the part that is not clipped becomes a fan. Throws Cancelled if `checkpoint` does.
bool triangulate_polygon(std::span<const Vec3d> corners, std::vector<PolygonTriangle>& triangles,
                         Checkpoint& checkpoint);

}  // namespace realcam::io
