#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "../../io/text/printable.hpp"
#include "../../math/color.hpp"

namespace realcam::bindings {

// Formatting for __repr__, whose result must fit on a line.

/// Formats a number with four significant digits, like %g.
inline std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

/// Formats a count with its noun: "1 ray", "12 rays".
inline std::string counted(std::size_t count, const std::string& what) {
    return std::to_string(count) + ' ' + what + (count == 1 ? "" : "s");
}

/// Formats a vector: "(1, 2.5, 3)".
template <class Vec>
std::string point_text(const Vec& v) {
    const auto number = [](auto x) { return digits(static_cast<double>(x)); };
    return '(' + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ')';
}

inline std::string color_text(Color c) {
    return point_text(Vec3f{c.r, c.g, c.b});
}

/// Truncates a name to a single line of at most 40 bytes.
inline std::string shortened(std::string name) {
    constexpr std::size_t kMaxBytes = 40;
    for (char& c : name)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (name.size() <= kMaxBytes) return name;
    return name.substr(0, io::utf8_begin(name, kMaxBytes - 3)) + "...";
}

/// Formats an exposure time: "1/125 s", "2 s".
inline std::string time_text(double seconds) {
    return seconds < 0.5 ? "1/" + digits(1 / seconds) + " s" : digits(seconds) + " s";
}

}  // namespace realcam::bindings
