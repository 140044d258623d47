#pragma once
#include <string>

namespace realcam::io {

/// The suffix of a file's name in small letters, with its point: ".png". Empty where there is none.
std::string suffix_of(const std::string& path);

}  // namespace realcam::io
