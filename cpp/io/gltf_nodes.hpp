#pragma once
#include <cstddef>
#include <vector>

#include "../checkpoint.hpp"
#include "file_scene.hpp"
#include "gltf_document.hpp"

namespace realcam::io {

/// Fills scene.nodes with those of the file's scene, without their meshes; returns the file's number of each. Without
/// a scene in the file, with all that are no other's child. Throws SceneFileError for nodes that form no tree.
std::vector<std::size_t> lay_out_nodes(FileScene& scene, const GltfDocument& document, Checkpoint& checkpoint);

/// Of nodes in depth-first order, relative to the scene.
std::vector<Affine<double>> global_transforms(const std::vector<FileNode>& nodes);

}  // namespace realcam::io
