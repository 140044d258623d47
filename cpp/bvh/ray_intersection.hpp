#pragma once
#include "../scene/geometry/surface_point.hpp"
#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

// Intersection of a ray with the triangles and the boxes of a wide BVH.
//
// Triangles: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013: vertices are translated and
// sheared so that the ray is the z axis. The signs of three edge functions tell on which side of an edge it passes. A
// sheared vertex depends on the vertex and the ray alone, so the triangles at an edge agree if the signs are right.

/// Returns a b - c d with the right sign, and 0 only if it is 0, as long as nothing underflows (Jeannerod, Louvet and
/// Muller, "Further analysis of Kahan's algorithm for the accurate computation of 2x2 determinants", 2013: the error is
/// at most 1.5 units in the last place). The paper's fallback to double precision for edge cases is therefore not
/// needed.
REALCAM_INLINE float difference_of_products(float a, float b, float c, float d) {
    const float cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// Ray in the form that tests triangles: a shear along its dominant axis, the one of its direction's largest component.
struct ShearedRay {
    Vec3f origin;
    float slope_x, slope_y;  ///< change of the two minor coordinates per unit length along the dominant axis
    float per_z;  ///< ray parameter per unit length along the dominant axis
    int dominant;  ///< index of the dominant axis: 0 x, 1 y, 2 z

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
    /// Permutes the axes so that z is the dominant one.
    REALCAM_INLINE Vec3f dominant_last(Vec3f v) const {
        return {dominant == 0 ? v.z : v.x, dominant == 1 ? v.z : v.y, dominant == 0 ? v.x : dominant == 1 ? v.y : v.z};
    }
};

/// True if the ray hits the triangle, from either side, at a parameter in [0, hit.distance). Sets `hit` to the
/// parameter, the triangle's index and the barycentric coordinates of b and c then; leaves it unchanged otherwise.
REALCAM_INLINE bool intersects_triangle(const ShearedRay& ray, const BvhTriangle& triangle, Hit& hit) {
    const Vec3f a = ray.sheared(triangle.a), b = ray.sheared(triangle.b), c = ray.sheared(triangle.c);
    const float u = difference_of_products(c.x, b.y, c.y, b.x);
    const float v = difference_of_products(a.x, c.y, a.y, c.x);
    const float w = difference_of_products(b.x, a.y, b.y, a.x);
    const bool some_left = u < 0 || v < 0 || w < 0, some_right = u > 0 || v > 0 || w > 0;
    if (some_left == some_right) return false;  // outside, or edge-on
    // A product of a coordinate and an edge function would overflow in a scene of 1e18 m. Twice the area, at most 2^126
    // there, still has a reciprocal that is a normal number.
    const float inverse_area = quotient(1.0f, u + v + w);
    const float weight_a = u * inverse_area, weight_b = v * inverse_area, weight_c = w * inverse_area;
    const float t = (weight_a * a.z + weight_b * b.z + weight_c * c.z) * ray.per_z;
    if (!(t >= 0 && t < hit.distance)) return false;
    hit = {t, triangle.index, weight_b, weight_c};
    return true;
}

/// Ray in the form that tests the eight boxes of a node at once.
///
/// The test must find the box of every triangle that intersects_triangle would accept, or light leaks through edges.
/// intersects_triangle sees vertices displaced by up to 6 roundings of their distance from the ray's origin (along the
/// dominant axis). The parameter of a plane, converted back to a coordinate, is off by up to 7 roundings. All boxes of
/// a node are therefore enlarged by 16 roundings of the distance of its farthest corner, and no other tolerance is
/// needed.
struct SlabRay {
    Vec3f origin;
    Vec3f per_axis;  ///< ray parameter per unit length along each axis
    unsigned near_first, near_second, near_third;  ///< masks of the slots on the near side, dominant axis first
    bool down_x, down_y, down_z;  ///< true if the direction's component is negative
    std::uint32_t bits_of_32768;  ///< kBitsOf32768, hidden from the compiler: an instruction has room for one constant

    /// The direction's components have a magnitude in [0, 4), the largest of at least 1.
    REALCAM_INLINE SlabRay(Vec3f from, Vec3f direction) : origin(from) {
        down_x = direction.x < 0;
        down_y = direction.y < 0;
        down_z = direction.z < 0;
        bits_of_32768 = kBitsOf32768 | std::bit_cast<std::uint32_t>(direction.x - direction.x);
        per_axis = {reciprocal(direction.x), reciprocal(direction.y), reciprocal(direction.z)};
        // Slots whose index has the bit of an axis clear lie towards the negative end of that axis (WideNode).
        const unsigned near_x = down_x ? 0xaau : 0x55u, near_y = down_y ? 0xccu : 0x33u,
                       near_z = down_z ? 0xf0u : 0x0fu;
        const float x = std::fabs(direction.x), y = std::fabs(direction.y), z = std::fabs(direction.z);
        const bool x_first = x > y && x > z, y_first = !x_first && y > z;
        near_first = x_first ? near_x : y_first ? near_y : near_z;
        near_second = x_first   ? (y > z ? near_y : near_z)
                      : y_first ? (x > z ? near_x : near_z)
                      : x > y   ? near_x
                                : near_y;
        near_third = near_x ^ near_y ^ near_z ^ near_first ^ near_second;
    }

    /// Returns a mask of the slots whose boxes the ray intersects at a parameter in [0, far]. Bits of empty slots are
    /// undefined. `has_less_code`: half the code size, for a few more instructions.
    template <bool has_less_code>
    REALCAM_INLINE unsigned intersected_slots(const WideNode& node, float far) const {
        const Vec3f to = node.origin - origin;
        // The reach is 18 * 255 steps: 255 steps for the farthest plane, and 17 * 255 steps, which 2^-20 reduces to
        // 2^-8 of a step, for the two roundings of 32768 steps.
        const float reach = std::bit_cast<float>(node.step_z_reach << 16);
        const float slack =
            0x1p-20f * (std::fmax(std::fmax(std::fabs(to.x), std::fabs(to.y)), std::fabs(to.z)) + reach);
        const Axis x(to.x, std::bit_cast<float>(node.steps_xy & 0xffff0000u), per_axis.x, slack);
        const Axis y(to.y, std::bit_cast<float>(node.steps_xy << 16), per_axis.y, slack);
        const Axis z(to.z, std::bit_cast<float>(node.step_z_reach & 0xffff0000u), per_axis.z, slack);
        unsigned missed = 0;
        const auto test = [&](const FourSlots& slots) {
            for (unsigned i = 4; i-- > 0;) {
                const float enter = largest_or_zero(x.near(byte(slots.near_x, i)), y.near(byte(slots.near_y, i)),
                                                    z.near(byte(slots.near_z, i)));
                const float leave = smallest_if_positive(x.far(byte(slots.far_x, i)), y.far(byte(slots.far_y, i)),
                                                         z.far(byte(slots.far_z, i)), far);
                missed = append_sign(missed, leave - enter);
            }
        };
        if constexpr (has_less_code) {
            FourSlots slots = four_slots(node, 1);
            REALCAM_NO_UNROLL
            for (int pass = 0; pass < 2; ++pass) {
                test(slots);
                slots = four_slots(node, 0);
            }
        } else {
            test(four_slots(node, 1));
            test(four_slots(node, 0));
        }
        return ~missed & 0xffu;
    }

    /// Returns the bit of the slot that comes first along the ray. `slots` is not 0.
    REALCAM_INLINE unsigned nearest(unsigned slots) const {
        slots = slots & near_first ? slots & near_first : slots;
        slots = slots & near_second ? slots & near_second : slots;
        return slots & near_third ? slots & near_third : slots;
    }

private:
    /// Box planes of one axis as ray parameters: linear functions of 32768 + a plane's byte (byte_above_32768).
    struct Axis {
        float step, near_start, far_start;

        /// `to`: from the ray's origin to the node's; `box_step`: the node's step; `slack`: enlargement of the boxes.
        REALCAM_INLINE Axis(float to, float box_step, float per_axis, float slack) : step(box_step * per_axis) {
            const float start = std::fma(-32768.0f, step, to * per_axis);
            near_start = std::fma(-slack, std::fabs(per_axis), start);
            far_start = std::fma(slack, std::fabs(per_axis), start);
        }
        REALCAM_INLINE float near(float plane) const { return std::fma(plane, step, near_start); }
        REALCAM_INLINE float far(float plane) const { return std::fma(plane, step, far_start); }
    };

    /// Bytes of the near and far planes of half of a node's slots, as seen along the ray.
    struct FourSlots {
        std::uint32_t near_x, near_y, near_z, far_x, far_y, far_z;
    };
    /// `half`: 0 for slots 0 to 3, 1 for slots 4 to 7.
    REALCAM_INLINE FourSlots four_slots(const WideNode& node, int half) const {
        return {down_x ? node.upper[0][half] : node.lower[0][half], down_y ? node.upper[1][half] : node.lower[1][half],
                down_z ? node.upper[2][half] : node.lower[2][half], down_x ? node.lower[0][half] : node.upper[0][half],
                down_y ? node.lower[1][half] : node.upper[1][half], down_z ? node.lower[2][half] : node.upper[2][half]};
    }

    REALCAM_INLINE float byte(std::uint32_t planes, unsigned i) const {
        return byte_above_32768(planes, i, bits_of_32768);
    }

    /// Returns the reciprocal of a component whose magnitude is raised to at least 2^-40 (the largest component is at
    /// least 1): that moves the ray by less than a rounding, and no plane is at infinity, or at 0 times infinity.
    REALCAM_INLINE static float reciprocal(float component) {
        // -0 counts as positive, as in down_x, down_y and down_z.
        const float least = component < 0 ? -0x1p-40f : 0x1p-40f;
        return quotient(1.0f, std::fabs(component) < 0x1p-40f ? least : component);
    }
};

}  // namespace REALCAM_NAMESPACE
