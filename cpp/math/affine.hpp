#pragma once
#include <cmath>
#include <numbers>

#include "vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Inverse of an affine map, in the form that loses no precision near the image of the origin under that map: `origin`
/// is subtracted first.
template <class T>
struct InverseAffine {
    Vec3<T> x, y, z, origin;

    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return d.x * x + d.y * y + d.z * z; }
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p - origin); }

    /// Transforms a plane's normal by the map itself, not its inverse. The result stays on the same side also if the
    /// map mirrors, and is longer than 1 if the map shrinks along the normal.
    REALCAM_INLINE Vec3<T> normal_of(Vec3<T> n) const { return {dot(x, n), dot(y, n), dot(z, n)}; }

    template <class U>
    REALCAM_INLINE explicit operator InverseAffine<U>() const {
        return {static_cast<Vec3<U>>(x), static_cast<Vec3<U>>(y), static_cast<Vec3<U>>(z),
                static_cast<Vec3<U>>(origin)};
    }
};

/// Affine map: a linear map and a translation, as the images of the axes and of the origin.
template <class T>
struct Affine {
    Vec3<T> x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1}, origin = {0, 0, 0};

    constexpr bool operator==(const Affine&) const = default;

    REALCAM_INLINE Vec3<T> direction(Vec3<T> d) const { return d.x * x + d.y * y + d.z * z; }
    REALCAM_INLINE Vec3<T> point(Vec3<T> p) const { return direction(p) + origin; }
    REALCAM_INLINE T determinant() const { return dot(x, cross(y, z)); }
    /// True if the map is a positive uniform scale and a translation.
    REALCAM_INLINE bool is_scale_and_shift() const {
        return x.x > 0 && x == Vec3<T>{x.x, 0, 0} && y == Vec3<T>{0, x.x, 0} && z == Vec3<T>{0, 0, x.x};
    }

    /// Transforms the normal of a plane. The result stays on the same side of the surface also if the map mirrors, and
    /// is not of unit length. The cofactors are the inverse transpose times the determinant, and exist even if the
    /// inverse does not.
    REALCAM_INLINE Vec3<T> normal(Vec3<T> n) const {
        const Vec3<T> m = n.x * cross(y, z) + n.y * cross(z, x) + n.z * cross(x, y);
        return determinant() < 0 ? -m : m;
    }

    /// The determinant must not be 0.
    REALCAM_INLINE InverseAffine<T> inverse() const {
        const T scale = T(1) / determinant();
        const Vec3<T> a = scale * cross(y, z), b = scale * cross(z, x), c = scale * cross(x, y);
        return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}, origin};
    }

    friend REALCAM_INLINE Affine operator*(const Affine& a, const Affine& b) {
        Affine c;
        c.x = a.direction(b.x);
        c.y = a.direction(b.y);
        c.z = a.direction(b.z);
        c.origin = a.point(b.origin);
        return c;
    }

    /// Interpolates linearly, entry by entry.
    friend REALCAM_INLINE Affine mix(const Affine& a, const Affine& b, T share_of_b) {
        return {mix(a.x, b.x, share_of_b), mix(a.y, b.y, share_of_b), mix(a.z, b.z, share_of_b),
                mix(a.origin, b.origin, share_of_b)};
    }

    template <class U>
    REALCAM_INLINE explicit operator Affine<U>() const {
        return {static_cast<Vec3<U>>(x), static_cast<Vec3<U>>(y), static_cast<Vec3<U>>(z),
                static_cast<Vec3<U>>(origin)};
    }
};

/// Returns the rotation about x, then y, then z, by angles in degrees.
inline Affine<double> turn_of(Vec3d degrees) {
    const auto turn = [](double angle_deg, Vec3d Affine<double>::* a, Vec3d Affine<double>::* b) {
        const double angle = angle_deg * (std::numbers::pi / 180);
        Affine<double> map;
        const Vec3d u = map.*a, v = map.*b;
        map.*a = std::cos(angle) * u + std::sin(angle) * v;
        map.*b = std::cos(angle) * v - std::sin(angle) * u;
        return map;
    };
    using A = Affine<double>;
    return turn(degrees.z, &A::x, &A::y) * turn(degrees.y, &A::z, &A::x) * turn(degrees.x, &A::y, &A::z);
}

}  // namespace REALCAM_NAMESPACE
