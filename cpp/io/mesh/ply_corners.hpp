#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

/// Attributes that the faces of a PLY give to their own corners, in the order of the triangles.
struct PlyCorners {
    std::vector<Vec2f> uvs;            ///< three per triangle, or empty
    std::vector<VertexColor> colours;  ///< one per triangle, or empty
};

/// Gives each triangle three vertices of its own, with the attributes from its face. Equal ones are merged later.
void apply_corners(Scene& scene, const PlyCorners& corners, Checkpoint& checkpoint);

}  // namespace realcam::io
