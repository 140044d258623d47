#pragma once
#include <bit>

#include "wide_bvh.hpp"

namespace REALCAM_NAMESPACE {

// Bounding boxes, and their quantisation to the bytes of a WideNode.

/// Axis-aligned bounding box.
struct Box {
    Vec3f lower, upper;
};

/// Enlarges the box to contain another one.
REALCAM_INLINE void grow(Box& box, const Box& by) {
    box.lower = {std::fmin(box.lower.x, by.lower.x), std::fmin(box.lower.y, by.lower.y),
                 std::fmin(box.lower.z, by.lower.z)};
    box.upper = {std::fmax(box.upper.x, by.upper.x), std::fmax(box.upper.y, by.upper.y),
                 std::fmax(box.upper.z, by.upper.z)};
}

REALCAM_INLINE Box box_of(const BvhTriangle& t) {
    Box box = {t.a, t.a};
    grow(box, {t.b, t.b});
    grow(box, {t.c, t.c});
    return box;
}

/// Returns the smallest bfloat16 number of at least v, as the bits of a float whose lower half is 0. v is positive; the
/// result is at least 2^-126.
REALCAM_INLINE std::uint32_t bfloat16_above(double v) {
    const float near = static_cast<float>(v < 1.2e-38 ? 1.2e-38 : v);
    std::uint32_t bits = (std::bit_cast<std::uint32_t>(near) + 0xffffu) & 0xffff0000u;
    // The conversion may have rounded down.
    if (static_cast<double>(std::bit_cast<float>(bits)) < v) bits += 0x10000u;
    return bits;
}

/// Quantises the box planes of one axis outwards: sets the origin and the bytes of WideNode, and returns the bits of
/// the step. `used_slots`: mask of the slots that have a box. The results are exact: differences of floats are
/// multiples of the smaller one's last digit, so origin + byte * step has at most 41 binary digits, and double
/// arithmetic does not round.
REALCAM_HD inline std::uint32_t quantise_axis(const float (&lower)[kSlots], const float (&upper)[kSlots],
                                              unsigned used_slots, float& origin, std::uint32_t (&lower_bytes)[2],
                                              std::uint32_t (&upper_bytes)[2]) {
    float least = 0, most = 0;
    bool first = true;
    for (unsigned s = 0; s < kSlots; ++s) {
        if (!(used_slots >> s & 1u)) continue;
        least = first || lower[s] < least ? lower[s] : least;
        most = first || upper[s] > most ? upper[s] : most;
        first = false;
    }
    origin = least;
    const double from = least, extent = static_cast<double>(most) - from;
    std::uint32_t step_bits = extent > 0 ? bfloat16_above(extent / 255) : 0;
    while (from + 255 * static_cast<double>(std::bit_cast<float>(step_bits)) < static_cast<double>(most))
        step_bits += 0x10000u;
    const double step = static_cast<double>(std::bit_cast<float>(step_bits));

    lower_bytes[0] = lower_bytes[1] = upper_bytes[0] = upper_bytes[1] = 0;
    for (unsigned s = 0; s < kSlots; ++s) {
        unsigned low = 255, high = 0;  // inverted planes of an empty slot
        if (used_slots >> s & 1u) {
            const double l = lower[s], u = upper[s];
            low = step > 0 ? static_cast<unsigned>((l - from) / step) : 0;
            if (low > 255) low = 255;
            while (from + low * step > l) --low;
            high = step > 0 ? static_cast<unsigned>((u - from) / step) : 0;
            if (high > 255) high = 255;
            while (from + high * step < u) ++high;
        }
        lower_bytes[s / 4] |= low << (8 * (s % 4));
        upper_bytes[s / 4] |= high << (8 * (s % 4));
    }
    return step_bits;
}

/// Writes a node's origin, steps and planes for the boxes of the slots in `used_slots`. Leaves the node's content
/// unchanged.
REALCAM_HD inline void quantise_boxes(WideNode& node, const Box (&boxes)[kSlots], unsigned used_slots) {
    float lower[kSlots], upper[kSlots];
    std::uint32_t step[3];
    const auto axis = [&](int i, float Vec3f::* member) {
        for (unsigned s = 0; s < kSlots; ++s) {
            lower[s] = boxes[s].lower.*member;
            upper[s] = boxes[s].upper.*member;
        }
        step[i] = quantise_axis(lower, upper, used_slots, node.origin.*member, node.lower[i], node.upper[i]);
    };
    axis(0, &Vec3f::x);
    axis(1, &Vec3f::y);
    axis(2, &Vec3f::z);
    std::uint32_t largest = step[0] > step[1] ? step[0] : step[1];
    largest = largest > step[2] ? largest : step[2];
    const std::uint32_t reach =
        largest ? bfloat16_above(18 * 255 * static_cast<double>(std::bit_cast<float>(largest))) : 0;
    node.steps_xy = step[0] | step[1] >> 16;
    node.step_z_reach = step[2] | reach >> 16;
}

}  // namespace REALCAM_NAMESPACE
