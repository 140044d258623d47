#pragma once
#include <string>

#include "../number_text.hpp"

namespace realcam::app {

/// "1.5". Throws InputError, naming the option.
double parse_number(const std::string& option, const std::string& text);
/// "2.5", "inf". The same.
double parse_distance(const std::string& option, const std::string& text);

/// "2.5 m", "infinity".
std::string distance_text(double metres);
/// "1/125 s", "2 s".
std::string exposure_text(double seconds);

}  // namespace realcam::app
