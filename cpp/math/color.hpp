#pragma once
#include <cstdint>

#include "lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Light, or a factor on it such as a reflectance, in linear Rec. 709 channels.
struct Color {
    float r, g, b;

    constexpr bool operator==(const Color&) const = default;
};

/// Colour with three equal channels.
REALCAM_INLINE constexpr Color grey(float v) {
    return {v, v, v};
}
REALCAM_INLINE constexpr Color operator+(Color a, Color b) {
    return {a.r + b.r, a.g + b.g, a.b + b.b};
}
REALCAM_INLINE constexpr Color operator-(Color a, Color b) {
    return {a.r - b.r, a.g - b.g, a.b - b.b};
}
REALCAM_INLINE constexpr Color operator*(Color a, Color b) {
    return {a.r * b.r, a.g * b.g, a.b * b.b};
}
REALCAM_INLINE constexpr Color operator/(Color a, Color b) {
    return {a.r / b.r, a.g / b.g, a.b / b.b};
}
REALCAM_INLINE constexpr Color operator*(float s, Color c) {
    return {s * c.r, s * c.g, s * c.b};
}
REALCAM_INLINE constexpr Color& operator+=(Color& a, Color b) {
    return a = a + b;
}
REALCAM_INLINE constexpr Color& operator*=(Color& a, Color b) {
    return a = a * b;
}
/// Interpolates linearly from a (t = 0) to b (t = 1).
REALCAM_INLINE constexpr Color mix(Color a, Color b, float t) {
    return (1.0f - t) * a + t * b;
}

/// Largest of the three channels.
REALCAM_INLINE constexpr float largest(Color c) {
    const float rg = c.r > c.g ? c.r : c.g;
    return rg > c.b ? rg : c.b;
}
/// True if the channels sum to 0 or less, or to NaN.
REALCAM_INLINE constexpr bool is_black(Color c) {
    return !(c.r + c.g + c.b > 0.0f);
}
/// Luminance of a linear Rec. 709 colour (ITU-R BT.709).
REALCAM_INLINE constexpr float luminance(Color c) {
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}
/// Returns a if the condition holds, else b, without a branch.
REALCAM_INLINE constexpr Color select(bool condition, Color a, Color b) {
    return {condition ? a.r : b.r, condition ? a.g : b.g, condition ? a.b : b.b};
}

/// N colours in structure-of-arrays form; see Vec3Lanes.
template <int N>
struct ColorLanes {
    Lanes<float, N> r, g, b;

    REALCAM_INLINE Color operator[](int lane) const { return {r[lane], g[lane], b[lane]}; }
    REALCAM_INLINE void set(int lane, Color c) {
        r[lane] = c.r;
        g[lane] = c.g;
        b[lane] = c.b;
    }
};

}  // namespace REALCAM_NAMESPACE
