#pragma once
#include <cstdint>
#include <memory>

#include "../../checkpoint.hpp"
#include "../../scene/scene.hpp"
#include "file_scene.hpp"

namespace realcam::io {

/// Reads the meshes of a node, whose shape changes over time, as an object: in the frame of the scene if a skin moves
/// them, otherwise in that of the node. `scale`: metres per unit of the file. Throws SceneFileError.
std::shared_ptr<Scene> read_deforming_object(const FileScene& file, std::uint32_t node, double scale,
                                             Checkpoint& checkpoint);

}  // namespace realcam::io
