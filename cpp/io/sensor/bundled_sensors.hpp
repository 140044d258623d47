#pragma once
// Files of sensors/, compiled into the library; the definition is generated.

#include <span>

#include "../files/bundled_file.hpp"

namespace realcam::io {

/// Returns the bundled sensors, in the order of the file names.
std::span<const BundledFile> bundled_sensor_files();

}  // namespace realcam::io
