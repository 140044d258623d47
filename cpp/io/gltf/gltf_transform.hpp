#pragma once
#include "../../math/affine.hpp"
#include "../scene/file_motion.hpp"
#include "../text/json.hpp"

namespace realcam::io {

/// Returns the transform of a glTF node to its parent: from its matrix, or from translation, rotation and scale.
Affine<double> transform_of(const Json& node);

/// Returns a node's translation, rotation and scale as a motion without keys.
FileMotion standing(const Json& node);

}  // namespace realcam::io
