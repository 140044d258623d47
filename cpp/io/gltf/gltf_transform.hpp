#pragma once
#include "../../math/affine.hpp"
#include "../scene/file_motion.hpp"
#include "../text/json.hpp"

namespace realcam::io {

/// The frame of a glTF node in that of its parent: by its matrix, or by translation, rotation and scale.
Affine<double> transform_of(const Json& node);

/// The latter, of which nothing moves.
FileMotion standing(const Json& node);

}  // namespace realcam::io
