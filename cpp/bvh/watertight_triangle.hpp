#pragma once
#include "../scene/surface_point.hpp"
#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013: vertices are translated and sheared so
// that the ray is the z axis. The signs of three edge functions tell on which side of an edge it passes. A sheared
// vertex depends on the vertex and the ray alone, so the triangles at an edge agree if the signs are right.

/// Returns a b - c d with the right sign, and 0 only if it is 0, as long as nothing underflows (Jeannerod, Louvet and
/// Muller, "Further analysis of Kahan's algorithm for the accurate computation of 2x2 determinants", 2013: the error is
/// at most 1.5 units in the last place). The paper's fallback to double precision for edge cases is therefore not
/// needed.
REALCAM_INLINE float difference_of_products(float a, float b, float c, float d) {
    const float cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// Ray constants shared by all triangle tests.
struct ShearedRay {
    Vec3f origin;
    float slope_x, slope_y;  ///< slopes of the two minor axes along the dominant one
    float per_z;  ///< ray parameter along the dominant axis
    int dominant;

    /// The direction's components have a magnitude in [0, 4), the largest of at least 1.
    REALCAM_INLINE ShearedRay(Vec3f from, Vec3f direction) : origin(from) {
        const float x = std::fabs(direction.x), y = std::fabs(direction.y), z = std::fabs(direction.z);
        dominant = x > y ? (x > z ? 0 : 2) : (y > z ? 1 : 2);
        const Vec3f d = dominant_last(direction);
        per_z = quotient(1.0f, d.z);
        slope_x = d.x * per_z;
        slope_y = d.y * per_z;
    }

    /// Returns a vertex in the sheared frame. Explicitly fused, so that no compiler treats one vertex differently from
    /// another.
    REALCAM_INLINE Vec3f sheared(Vec3f corner) const {
        const Vec3f p = dominant_last(corner - origin);
        return {std::fma(-slope_x, p.z, p.x), std::fma(-slope_y, p.z, p.y), p.z};
    }

private:
    REALCAM_INLINE Vec3f dominant_last(Vec3f v) const {
        return {dominant == 0 ? v.z : v.x, dominant == 1 ? v.z : v.y, dominant == 0 ? v.x : dominant == 1 ? v.y : v.z};
    }
};

/// True if the ray hits the triangle, from either side, at a parameter in [0, hit.distance); then sets `hit`.
REALCAM_INLINE bool intersects_triangle(const ShearedRay& ray, const BvhTriangle& triangle, Hit& hit) {
    const Vec3f a = ray.sheared(triangle.a), b = ray.sheared(triangle.b), c = ray.sheared(triangle.c);
    const float u = difference_of_products(c.x, b.y, c.y, b.x);
    const float v = difference_of_products(a.x, c.y, a.y, c.x);
    const float w = difference_of_products(b.x, a.y, b.y, a.x);
    const bool some_left = u < 0 || v < 0 || w < 0, some_right = u > 0 || v > 0 || w > 0;
    if (some_left == some_right) return false;  // outside, or edge-on
    // A product of a coordinate and an edge function would overflow in a scene of 1e18 m. Twice the area, at most 2^126
    // there, still has a reciprocal that is a normal number.
    const float share = quotient(1.0f, u + v + w);
    const float u_share = u * share, v_share = v * share, w_share = w * share;
    const float t = (u_share * a.z + v_share * b.z + w_share * c.z) * ray.per_z;
    if (!(t >= 0 && t < hit.distance)) return false;
    hit = {t, triangle.index, v_share, w_share};
    return true;
}

}  // namespace REALCAM_NAMESPACE
