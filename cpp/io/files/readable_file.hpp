#pragma once
#include <string>

namespace realcam::io {

/// Why a path is no file that can be read, as a message continues: "no such file", "is a folder", ...; empty where it
/// is one. Pipes and devices are none: opening them may wait for ever, and reading them may never end.
std::string why_unreadable(const std::string& path);

}  // namespace realcam::io
