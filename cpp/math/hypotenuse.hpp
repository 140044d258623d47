#pragma once
#include <cmath>
#include <limits>

namespace realcam {

/// Returns sqrt(x^2 + y^2), rounded as well as std::hypot, without intermediate overflow or underflow; infinite if x or
/// y is. std::hypot is avoided, because its symbol requires glibc 2.35 or later at run time.
inline double hypotenuse(double x, double y) {
    using Wide = long double;
    if constexpr (std::numeric_limits<Wide>::max_exponent > 2 * std::numeric_limits<double>::max_exponent) {
        if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<double>::infinity();
        return static_cast<double>(std::sqrt(Wide{x} * Wide{x} + Wide{y} * Wide{y}));
    } else {
        return std::hypot(x, y);
    }
}

/// Single-precision overload. Squares of floats are exact in double precision.
inline float hypotenuse(float x, float y) {
    if (std::isinf(x) || std::isinf(y)) return std::numeric_limits<float>::infinity();
    return static_cast<float>(std::sqrt(double{x} * double{x} + double{y} * double{y}));
}

}  // namespace realcam
