#pragma once
#include <vector>

#include "../checkpoint.hpp"
#include "../scene/scene.hpp"

namespace realcam::io {

/// Gives the triangles that `is_smooth` marks, one flag for each, normals: at a corner the mean of the faces that share
/// the position and lie within 45 degrees of the triangle's own plane, weighted by their angle there (Thuermer and
/// Wuethrich 1998). Sharper edges, such as a cube's, stay edges, so that vertices are added where a position needs
/// several normals. None of the triangles may be degenerate.
void smooth_normals(Scene& scene, const std::vector<bool>& is_smooth, Checkpoint& checkpoint);

}  // namespace realcam::io
