#pragma once
// The words of the command line that are more than a number.

#include <array>
#include <string>

#include "../camera/camera_view.hpp"
#include "../camera/develop.hpp"
#include "../math/vec3.hpp"

namespace realcam::app {

// All throw InputError, naming the option and what it wants.

/// "1.5", "inf" where infinite values make sense.
double parse_number(const std::string& option, const std::string& text, bool may_be_infinite = false);
/// "0.008", "1/125".
double parse_fraction(const std::string& option, const std::string& text);
/// "x,y,z".
Vec3d parse_point(const std::string& option, const std::string& text);
/// "36x24".
std::array<double, 2> parse_size(const std::string& option, const std::string& text);
/// "960x640".
std::array<int, 2> parse_resolution(const std::string& option, const std::string& text);
CameraModel parse_model(const std::string& text);
ToneCurve parse_tone(const std::string& text);

/// A number with a few digits, as short as it can be: "50.36", "infinity".
std::string short_number(double value, int digits = 4);
/// "2.5 m", "infinity".
std::string distance_text(double metres);
/// "1/125 s", "2 s".
std::string exposure_text(double seconds);

}  // namespace realcam::app
