#pragma once
#include <cstdint>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

inline constexpr std::uint32_t kFlat = 0, kSmoothByAngle = 0xffffffffu;

/// Which triangles are smooth together.
struct Smoothing {
    /// One for each triangle: kFlat, kSmoothByAngle, or the number of its smoothing group.
    std::vector<std::uint32_t> groups;
    /// The number of each vertex's place. Faces of one group meet at a place if they name the same vertex in the file.
    /// Where this is empty, they meet where positions are equal.
    std::vector<std::uint32_t> places;
};

/// Gives triangles that are not flat normals: at a corner the mean of the faces that meet there, weighted by their
/// angle there (Thuermer and Wuethrich 1998). Of a group these are all of the same group; by angle, those that lie
/// within 45 degrees of the triangle's own plane, so that sharper edges, such as a cube's, stay edges. Vertices are
/// added where a position needs several normals. None of the triangles may be degenerate.
void smooth_normals(Scene& scene, const Smoothing& smoothing, Checkpoint& checkpoint);

}  // namespace realcam::io
