#pragma once
#include <functional>
#include <string>

#include "scene_import.hpp"

namespace realcam::io {

/// A node of a file with all below it, and where it is to stand. The file and its path have to outlive it.
struct ScenePart {
    const ImportedScene& file;
    const std::string& path;
    double scale;  ///< metres per unit of the file
    const aiNode& node;
    Affine<double> transform = {};  ///< of the node's own frame, in units of the file
};

/// What of a node is left to others: nothing, its meshes, or it and all below it.
enum class LeftOut { nothing, meshes, all };
using LeavesOut = std::function<LeftOut(const aiNode& node, const Affine<double>& transform)>;

}  // namespace realcam::io
