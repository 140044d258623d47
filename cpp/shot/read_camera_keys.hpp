#pragma once
#include "shot_request.hpp"
#include "shot_table.hpp"

namespace realcam::shot {

/// What the key "lens" of a table says, as ShotRequest::lens; empty: it has none.
std::string lens_of(const ShotTable& table);

/// The tables [[key]] and [shake] of a shot file, and what follows the meter. Throws InputError naming file and line.
void read_camera_keys(const ShotTable& shot, ShotRequest& request);

}  // namespace realcam::shot
