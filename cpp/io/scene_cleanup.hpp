#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "../scene/scene.hpp"

namespace realcam::io {

/// The last step of every reader: drops triangles without area, with a warning, gives those of the list `smooth`
/// (numbers in scene.triangles) normals, and welds equal vertices. Indices have to be in range. Throws SceneFileError,
/// with `path`, if no triangle is left.
void clean_geometry(Scene& scene, const std::vector<std::uint32_t>& smooth, const std::string& path);

/// Adds the warning "path: n what" unless n is 0.
void warn_count(Scene& scene, const std::string& path, std::size_t n, const std::string& what);

}  // namespace realcam::io
