#pragma once
#include <vector>

#include "../../math/affine.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Where a node has its mesh, in its own frame, by EXT_mesh_gpu_instancing; empty where it has no such extension, and
/// the mesh once. `label`: of the node. Throws SceneFileError.
std::vector<Affine<double>> instances_of(const Json& node, GltfAccessors& accessors, const GltfDocument& document,
                                         const std::string& label);

}  // namespace realcam::io
