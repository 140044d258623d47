#pragma once
#include "../../math/lanes.hpp"

namespace REALCAM_NAMESPACE {

/// Surface of the film, a plane or a spherical cap, in a frame whose z axis passes through the film's vertex and points
/// along the light that arrives. Film points are specified by x and y, mm. The tangent frame of a film point consists
/// of the film's axes after the shortest rotation that takes z to the surface normal there.
template <class T>
struct FilmSurface {
    T distance;  ///< z of the vertex, mm
    T curvature;  ///< 1/mm; positive if the centre of curvature lies behind the film

    /// Returns the position of a film point.
    REALCAM_INLINE Vec3<T> point(Vec2<T> at) const {
        const T squared = at.x * at.x + at.y * at.y;
        return {at.x, at.y, distance + curvature * squared / (T(1) + cosine(squared))};
    }

    /// Transforms a direction from the tangent frame of a film point to the film's frame.
    REALCAM_INLINE Vec3<T> direction(Vec2<T> at, Vec3<T> local) const {
        // With the normal n, x is rotated to (1 - nx nx / (1 + nz), -nx ny / (1 + nz), -nx), and y likewise.
        const T nx = -curvature * at.x, ny = -curvature * at.y, nz = cosine(at);
        const T along = (nx * local.x + ny * local.y) / (T(1) + nz);
        return {local.x - along * nx + local.z * nx, local.y - along * ny + local.z * ny,
                local.z * nz - nx * local.x - ny * local.y};
    }

    /// Returns the film point at which a ray from the lens arrives, or NaN if the ray misses the film. `direction` may
    /// have any length.
    REALCAM_INLINE Vec2<T> landing(Vec3<T> origin, Vec3<T> direction) const {
        // The formula of intersect_sphere for the intersection near the vertex.
        const Vec3<T> o = {origin.x, origin.y, origin.z - distance};
        const T F = curvature * dot(o, o) - T(2) * o.z;
        const T G = direction.z - curvature * dot(o, direction);
        const T A = curvature * dot(direction, direction);
        const T t = F / (G + std::sqrt(G * G - A * F));
        return {o.x + t * direction.x, o.y + t * direction.y};
    }

    /// Returns the cosine of the angle between the surface normal and z: the ratio of an area in x and y to the area of
    /// the film that it covers.
    REALCAM_INLINE T cosine(Vec2<T> at) const { return cosine(at.x * at.x + at.y * at.y); }

private:
    REALCAM_INLINE T cosine(T squared_radius) const {
        return sqrt_or_zero(T(1) - curvature * curvature * squared_radius);
    }
};

}  // namespace REALCAM_NAMESPACE
