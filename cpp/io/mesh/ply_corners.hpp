#pragma once
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

/// What the faces of a PLY say of their own corners, in the order of the triangles.
struct PlyCorners {
    std::vector<Vec2f> uvs;            ///< three for each triangle; empty: none
    std::vector<VertexColor> colours;  ///< one for each triangle; empty: none
};

/// Gives each triangle three vertices of its own, with what its face says of them. Equal ones are welded later.
void apply_corners(Scene& scene, const PlyCorners& corners, Checkpoint& checkpoint);

}  // namespace realcam::io
