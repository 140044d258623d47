#pragma once
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>

#include "lens_writers.hpp"

namespace realcam::io {

/// Returns a number as a TOML float: without a point, TOML reads a 64-bit integer.
inline std::string toml_number(double value) {
    const std::string text = exact_number(value);
    return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

/// Returns a number near `near` that `back` maps exactly to `value`; std::nullopt if rounding leaves no such number.
template <class Back>
std::optional<double> before_rounding(double near, double value, const Back& back) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {near, std::nextafter(near, kInfinity), std::nextafter(near, -kInfinity)})
        if (std::isfinite(candidate) && back(candidate) == value) return candidate;
    return std::nullopt;
}

}  // namespace realcam::io
