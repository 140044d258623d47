#pragma once
#include "shot_request.hpp"
#include "shot_table.hpp"

namespace realcam::shot {

/// The tables [[key]] and [shake] of a shot file, and what follows the meter. Throws InputError naming file and line.
void read_camera_keys(const ShotTable& shot, ShotRequest& request);

}  // namespace realcam::shot
