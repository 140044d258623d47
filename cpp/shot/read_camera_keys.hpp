#pragma once
#include "shot_request.hpp"
#include "shot_table.hpp"

namespace realcam::shot {

/// Value of the key "lens" of a table, in the form of ShotRequest::lens; empty if the key is absent.
std::string lens_of(const ShotTable& table);

/// Reads the tables [[key]] and [shake] of a shot file. Throws InputError naming file and line.
void read_camera_keys(const ShotTable& shot, ShotRequest& request);

}  // namespace realcam::shot
