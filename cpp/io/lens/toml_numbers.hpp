#pragma once
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>

#include "lens_writers.hpp"

namespace realcam::io {

/// In TOML a whole number without a point is an integer, of 64 bits.
inline std::string toml_number(double value) {
    const std::string text = exact_number(value);
    return text.find_first_of(".e") == text.npos ? text + ".0" : text;
}

/// What `back` makes exactly this value of; nothing where rounding leaves none.
template <class Back>
std::optional<double> before_rounding(double near, double value, const Back& back) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const double candidate : {near, std::nextafter(near, kInfinity), std::nextafter(near, -kInfinity)})
        if (std::isfinite(candidate) && back(candidate) == value) return candidate;
    return std::nullopt;
}

}  // namespace realcam::io
