#pragma once
#include "shot_request.hpp"
#include "shot_table.hpp"

namespace realcam::shot {

/// Value of the key "lens" of a table as a bundled lens's name or a lens file's path (ShotRequest::lens); empty if the
/// key is absent.
std::string lens_of(const ShotTable& table);

/// Reads the tables [[key]] (keyframes of the camera) and [shake] of a shot file into the request. Throws InputError
/// naming file and line.
void read_camera_keys(const ShotTable& shot, ShotRequest& request);

}  // namespace realcam::shot
