#pragma once
#include <cmath>

#include "../platform.hpp"

// Vectors of two and three components for CPU and GPU, with the usual operators and products.

namespace REALCAM_NAMESPACE {

/// Vector of two components.
template <class T>
struct Vec2 {
    T x, y;

    constexpr bool operator==(const Vec2&) const = default;
};

/// Vector, point, or colour of three components.
template <class T>
struct Vec3 {
    T x, y, z;

    constexpr bool operator==(const Vec3&) const = default;

    template <class U>
    REALCAM_INLINE explicit constexpr operator Vec3<U>() const {
        return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
    }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
REALCAM_INLINE constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
REALCAM_INLINE constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
REALCAM_INLINE constexpr Vec3<T> operator-(Vec3<T> a) {
    return {-a.x, -a.y, -a.z};
}
template <class T>
REALCAM_INLINE constexpr Vec3<T> operator*(T s, Vec3<T> a) {
    return {s * a.x, s * a.y, s * a.z};
}
/// Component-wise product, as of two colours.
template <class T>
REALCAM_INLINE constexpr Vec3<T> operator*(Vec3<T> a, Vec3<T> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
REALCAM_INLINE constexpr Vec3<T>& operator+=(Vec3<T>& a, Vec3<T> b) {
    return a = a + b;
}
template <class T>
REALCAM_INLINE constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
REALCAM_INLINE constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Returns x and y of the intersection of a line through `origin` with the plane at this z. `direction` may have any
/// length; its z must not be 0.
template <class T>
REALCAM_INLINE Vec2<T> crossing_at(T z, Vec3<T> origin, Vec3<T> direction) {
    const T distance = quotient(z - origin.z, direction.z);
    return {origin.x + distance * direction.x, origin.y + distance * direction.y};
}
/// Interpolates linearly from a (t = 0) to b (t = 1).
template <class T>
REALCAM_INLINE constexpr Vec3<T> mix(Vec3<T> a, Vec3<T> b, T t) {
    return (T(1) - t) * a + t * b;
}
template <class T>
REALCAM_INLINE T length(Vec3<T> a) {
    return std::sqrt(dot(a, a));
}
/// Returns the vector divided by its length, which must not be 0.
template <class T>
REALCAM_INLINE Vec3<T> normalized(Vec3<T> a) {
    return (T(1) / length(a)) * a;
}

}  // namespace REALCAM_NAMESPACE
