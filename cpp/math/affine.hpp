#pragma once
#include <cmath>
#include <numbers>

#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Inverse of an affine map. To map a point, it subtracts `origin`, the image of the origin under the original map, and
/// then applies the inverse linear map. This loses no precision near that image.
template <class T>
struct InverseAffine {
    Vec3<T> x, y, z;  ///< images of the axes under the inverse linear map
    Vec3<T> origin;  ///< image of the origin under the original map

    /// Transforms a direction by the inverse linear map; its length is not preserved.
    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return d.x * x + d.y * y + d.z * z; }
    /// Transforms a point by the inverse map.
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p - origin); }

    /// Transforms the normal of a plane by the original map, not by its inverse: multiplies with the transpose of the
    /// inverse. The result stays on the same side of the plane even if the map mirrors. For a unit normal, its length
    /// is the factor by which the map shrinks distances from the plane.
    REALCAM_INLINE Vec3<T> normal_of(Vec3<T> n) const { return {dot(x, n), dot(y, n), dot(z, n)}; }

    template <class U>
    REALCAM_INLINE explicit operator InverseAffine<U>() const {
        return {static_cast<Vec3<U>>(x), static_cast<Vec3<U>>(y), static_cast<Vec3<U>>(z),
                static_cast<Vec3<U>>(origin)};
    }
};

/// Affine map p -> p.x x + p.y y + p.z z + origin: `x`, `y`, `z` are the images of the axes (the columns of the
/// matrix), and `origin` is the image of the origin. The default is the identity.
template <class T>
struct Affine {
    Vec3<T> x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, origin = {0, 0, 0};

    constexpr bool operator==(const Affine&) const = default;

    /// Transforms a direction, without the translation.
    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return d.x * x + d.y * y + d.z * z; }
    /// Transforms a point.
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p) + origin; }
    /// Determinant of the linear part: volume factor, negative if the map mirrors.
    REALCAM_INLINE T determinant() const { return dot(x, cross(y, z)); }
    /// True if the map is a positive uniform scale and a translation.
    REALCAM_INLINE bool is_scale_and_shift() const {
        return x.x > 0 && x == Vec3<T>{x.x, 0, 0} && y == Vec3<T>{0, x.x, 0} && z == Vec3<T>{0, 0, x.x};
    }

    /// Transforms the normal of a plane. The result stays on the same side of the plane even if the map mirrors, and is
    /// not of unit length. It uses the cofactor matrix, which is the transpose of the inverse times the determinant,
    /// and which exists for singular maps too.
    REALCAM_INLINE Vec3<T> normal(Vec3<T> n) const {
        const Vec3<T> m = n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y);
        return determinant() < 0 ? -m : m;
    }

    /// Returns the inverse map. The determinant must not be 0.
    REALCAM_INLINE InverseAffine<T> inverse() const {
        const T scale = T(1) / determinant();
        const Vec3<T> a = scale * cross(y, z), b = scale * cross(z, x), c = scale * cross(x, y);
        return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, origin};
    }

    /// Returns the composition: b is applied first.
    friend REALCAM_INLINE Affine operator*(const Affine& a, const Affine& b) {
        Affine c;
        c.x = a.direction(b.x);
        c.y = a.direction(b.y);
        c.z = a.direction(b.z);
        c.origin = a.point(b.origin);
        return c;
    }

    /// Interpolates linearly from a (t = 0) to b (t = 1), entry by entry. See interpolated() for rotations.
    friend REALCAM_INLINE Affine mix(const Affine& a, const Affine& b, T t) {
        return {mix(a.x, b.x, t), mix(a.y, b.y, t), mix(a.z, b.z, t), mix(a.origin, b.origin, t)};
    }

    template <class U>
    REALCAM_INLINE explicit operator Affine<U>() const {
        return {static_cast<Vec3<U>>(x), static_cast<Vec3<U>>(y), static_cast<Vec3<U>>(z),
                static_cast<Vec3<U>>(origin)};
    }
};

inline constexpr double kDegree = std::numbers::pi / 180;  ///< one degree, in radians

/// Returns the rotation about the fixed axes x, then y, then z, by angles in degrees, counter-clockwise when the axis
/// points to the viewer.
inline Affine<double> euler_rotation(Vec3d degrees) {
    // Rotation that takes axis a towards axis b.
    const auto rotation = [](double angle_deg, Vec3d Affine<double>::* a, Vec3d Affine<double>::* b) {
        const double angle = angle_deg * kDegree;
        Affine<double> map;
        const Vec3d u = map.*a, v = map.*b;
        map.*a = std::cos(angle) * u + std::sin(angle) * v;
        map.*b = std::cos(angle) * v - std::sin(angle) * u;
        return map;
    };
    using A = Affine<double>;
    return rotation(degrees.z, &A::x, &A::y) * rotation(degrees.y, &A::z, &A::x) * rotation(degrees.x, &A::y, &A::z);
}

}  // namespace REALCAM_NAMESPACE
