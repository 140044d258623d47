#pragma once
#include "scene_request.hpp"
#include "shot_table.hpp"

namespace realcam::shot {

/// Reads the tables [[object]], [material.NAME] and [[light]] of a shot file. Throws InputError naming file and line.
SceneRequest read_scene_request(const ShotTable& shot);

}  // namespace realcam::shot
