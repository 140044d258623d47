#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace realcam::io {

/// " (did you mean \"a\" or \"b\"?)" with the candidates that are nearest to a misspelt name; empty where none is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace realcam::io
