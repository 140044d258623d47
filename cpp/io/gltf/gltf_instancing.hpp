#pragma once
#include <vector>

#include "../../math/affine.hpp"
#include "gltf_accessors.hpp"

namespace realcam::io {

/// Returns the transforms of a node's instances (EXT_mesh_gpu_instancing) in the node's frame; empty if the node does
/// not have this extension, and hence one mesh. `label`: names the node in messages. Throws SceneFileError.
std::vector<Affine<double>> instances_of(const Json& node, GltfAccessors& accessors, const GltfDocument& document,
                                         const std::string& label);

}  // namespace realcam::io
