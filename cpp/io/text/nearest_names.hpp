#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace realcam::io {

/// Returns " (did you mean \"a\" or \"b\"?)" with the candidates closest to a misspelt name; empty if none is close,
/// for names of more than 64 bytes, and for more than 10,000 candidates.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace realcam::io
