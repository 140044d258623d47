#pragma once
// The words of the command line. CLI11's own conversions would not do: it reads numbers as long double and then rounds
// once more, so that an option could differ from the same number in a shot file, and it takes 010 for 8.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "../camera/camera_view.hpp"
#include "../camera/develop.hpp"
#include "../math/vec3.hpp"
#include "../number_text.hpp"

namespace realcam::app {

// All throw InputError, naming the option and what it wants.

/// The text as a number; nothing where it is none, and for NaN.
std::optional<double> number_in(const std::string& text);
/// "1.5".
double parse_number(const std::string& option, const std::string& text);
/// "2.5", "inf".
double parse_distance(const std::string& option, const std::string& text);
/// The same; nothing for "auto".
std::optional<double> parse_focus(const std::string& option, const std::string& text);
/// A whole number from 0 to `most`.
std::uint64_t parse_whole(const std::string& option, const std::string& text, std::uint64_t most);
/// "0.008", "1/125"; nothing for "auto".
std::optional<double> parse_exposure_time(const std::string& option, const std::string& text);
/// "x,y,z".
Vec3d parse_point(const std::string& option, const std::string& text);
/// "36x24".
std::array<double, 2> parse_size(const std::string& option, const std::string& text);
/// "0,-3.5".
std::array<double, 2> parse_shift(const std::string& option, const std::string& text);
/// "960x640".
std::array<int, 2> parse_resolution(const std::string& option, const std::string& text);
CameraModel parse_model(const std::string& text);
ToneCurve parse_tone(const std::string& text);

/// "2.5 m", "infinity".
std::string distance_text(double metres);
/// "1/125 s", "2 s".
std::string exposure_text(double seconds);

}  // namespace realcam::app
