#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace realcam::io {

/// " (did you mean \"a\" or \"b\"?)" with the candidates that are nearest to a misspelt name; empty where none is near,
/// for names of more than 64 bytes, and where there are more than 10,000 candidates.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace realcam::io
