#pragma once
#include <string>
#include <vector>

#include "../camera/film/shake.hpp"

namespace realcam::shot {

/// Reads a camera shake curve from a table of numbers (.csv), whose first line names its columns: time_s, x_deg, y_deg,
/// z_deg, x_m, y_m and z_m, in any order. All columns except time_s may be missing: 0. Throws InputError naming file
/// and line.
std::vector<ShakeKey> read_shake_curve(const std::string& path);

}  // namespace realcam::shot
