#pragma once
#include <string>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"
#include "scene_normals.hpp"

namespace realcam::io {

/// Last step of every reader: drops triangles without area, with a warning, smooths the others, and merges equal
/// vertices. Indices must be in range. Throws SceneFileError, with `path`, if no triangle is left.
void clean_geometry(Scene& scene, Smoothing smoothing, const std::string& path, Checkpoint& checkpoint);

/// Adds the warning "path: n what" unless n is 0.
void warn_count(Scene& scene, const std::string& path, std::size_t n, const std::string& what);

}  // namespace realcam::io
