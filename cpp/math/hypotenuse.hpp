#pragma once
#include <cmath>
#include <limits>

namespace realcam {

/// sqrt(x^2 + y^2), rounded as well as std::hypot, without overflow or underflow on the way; infinite where one of the
/// two is. glibc has had its hypot since 2.35 alone, and a package that calls it would ask for a system of that age.
inline double hypotenuse(double x, double y) {
    using Wide = long double;
    if constexpr (std::numeric_limits<Wide>::max_exponent > 2 * std::numeric_limits<double>::max_exponent) {
        if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
        return static_cast<double>(std::sqrt(Wide{x} * Wide{x} + Wide{y} * Wide{y}));
    } else {
        return std::hypot(x, y);
    }
}

/// The same of single numbers, whose squares double holds without rounding.
inline float hypotenuse(float x, float y) {
    if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<float>::infinity();
    return static_cast<float>(std::sqrt(double{x} * double{x} + double{y} * double{y}));
}

}  // namespace realcam
