#pragma once
// PLY, ASCII and binary.

#include <string>

#include "../checkpoint.hpp"
#include "../scene/scene.hpp"

namespace realcam::io {

/// Adds the triangles of `path` to an empty scene, `scale` metres per unit; polygons are cut into fans. Read are x, y,
/// z, nx, ny, nz and s, t (also u, v and texture_u, texture_v) of the vertices, and the vertex indices of the faces.
/// Returns the name of the texture that a comment gives ("comment TextureFile name"), or nothing. Throws FileError, and
/// SceneFileError that names the line of the header, the vertex or the face, counted from 0.
std::string read_ply(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
