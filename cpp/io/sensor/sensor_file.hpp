#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../../camera/sensor/sensor.hpp"
#include "../../checkpoint.hpp"
#include "../files/bundled_file.hpp"

namespace realcam::io {

/// Returns the bundled sensor files (sensors/*.toml), sorted by file name. The definition is generated.
std::span<const BundledFile> bundled_sensor_files();

/// Returns the names of the bundled sensors, sorted.
std::vector<std::string> sensor_names();

/// Reads a sensor: a bundled one by name, or a .toml file by its path (anything with a '/' or a '.'). Throws
/// InputError, naming file and line, and Cancelled if `keep_going` returns false.
Sensor read_sensor(const std::string& name_or_path, const KeepGoing& keep_going = {});

/// Reads a sensor from the text of a sensor file (format 1, described in sensors/README.md). `file`: its name in
/// messages.
Sensor parse_sensor(std::string_view text, const std::string& file, const KeepGoing& keep_going = {});

}  // namespace realcam::io
