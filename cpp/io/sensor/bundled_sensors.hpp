#pragma once
// The files of sensors/ as they were when the library was built; the definition is generated.

#include <span>

#include "../files/bundled_file.hpp"

namespace realcam::io {

/// Every bundled sensor, in the order of the file names.
std::span<const BundledFile> bundled_sensor_files();

}  // namespace realcam::io
