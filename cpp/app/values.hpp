#pragma once
#include <string>

#include "../number_text.hpp"

namespace realcam::app {

/// Parses the value `text` of an option as a finite number such as "1.5". Throws InputError that names the option.
double parse_number(const std::string& option, const std::string& text);
/// Parses the value `text` of an option as metres such as "2.5", or "inf". Throws InputError that names the option.
double parse_distance(const std::string& option, const std::string& text);

/// Formats a distance: "2.5 m", "infinity".
std::string distance_text(double metres);
/// Formats an exposure time: "1/125 s", "2 s".
std::string exposure_text(double seconds);

}  // namespace realcam::app
