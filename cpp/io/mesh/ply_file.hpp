#pragma once
// Reads PLY files, ASCII and binary.

#include <string>
#include <vector>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"

namespace realcam::io {

/// Adds the triangles of `path` to an empty scene; polygons are split into fans of triangles, and strips (element
/// "tristrips") into triangles. `scale`: metres per unit. These properties are read:
/// - for vertices x, y, z, nx, ny, nz, s, t (also u, v and texture_u, texture_v) and red, green, blue, alpha (also
///   diffuse_red ... and r, g, b, a);
/// - for faces vertex_indices (also vertex_index), red, green, blue, alpha, texcoord (two for each corner, which
/// replace
///   the vertices' texture coordinates) and texnumber.
/// Returns the names of the textures in comments ("comment TextureFile name"). A triangle's material is the index of
/// its texture in this list, or the number of textures if it has none: scene.materials is not changed. Throws
/// FileError, and SceneFileError that names the line of the header, the vertex or the face, counted from 0.
std::vector<std::string> read_ply(Scene& scene, const std::string& path, double scale, Checkpoint& checkpoint);

}  // namespace realcam::io
