#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// The film, a spherical cap or a plane, in its own frame: the vertex lies on the z axis, and light arrives with
/// growing z. Points are given by their x and y. Directions at a point are in the frame of the tangent plane there: the
/// film's axes after the shortest rotation that takes z to the normal.
template <class T>
struct FilmSurface {
    T distance;  ///< z of the vertex, mm
    T curvature;  ///< 1/mm; above 0: the centre lies behind the film

    REALCAM_INLINE Vec3<T> point(Vec2<T> at) const {
        const T squared = at.x * at.x + at.y * at.y;
        return {at.x, at.y, distance + curvature * squared / (T(1) + cosine(squared))};
    }

    /// Transforms a direction from the tangent frame at a point to the film's frame.
    REALCAM_INLINE Vec3<T> direction(Vec2<T> at, Vec3<T> local) const {
        // With n the normal: x becomes (1 - nx nx / (1 + nz), -nx ny / (1 + nz), -nx), and y likewise.
        const T nx = -curvature * at.x, ny = -curvature * at.y, nz = cosine(at);
        const T along = (nx * local.x + ny * local.y) / (T(1) + nz);
        return {local.x - along * nx + local.z * nx, local.y - along * ny + local.z * ny,
                local.z * nz - nx * local.x - ny * local.y};
    }

    /// Film point at which a ray from the lens arrives; NaN if it misses the film.
    REALCAM_INLINE Vec2<T> landing(Vec3<T> origin, Vec3<T> direction) const {
        // Same as intersect_sphere, for the near cap.
        const Vec3<T> o = {origin.x, origin.y, origin.z - distance};
        const T F = curvature * dot(o, o) - T(2) * o.z;
        const T G = direction.z - curvature * dot(o, direction);
        const T A = curvature * dot(direction, direction);
        const T t = F / (G + std::sqrt(G * G - A * F));
        return {o.x + t * direction.x, o.y + t * direction.y};
    }

    /// Cosine of the angle between the normal and z: an area in x and y over the area of the film above it.
    REALCAM_INLINE T cosine(Vec2<T> at) const { return cosine(at.x * at.x + at.y * at.y); }

private:
    REALCAM_INLINE T cosine(T squared_radius) const {
        return sqrt_or_zero(T(1) - curvature * curvature * squared_radius);
    }
};

}  // namespace REALCAM_NAMESPACE
