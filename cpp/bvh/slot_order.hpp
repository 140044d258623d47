#pragma once
#include "quantised_boxes.hpp"

namespace REALCAM_NAMESPACE {

/// Assigns children to slots so that the slot's index tells where in the node a child lies (see WideNode), and a ray
/// finds near children first. Greedy: takes the best pair of a child and a slot, then the best of the remaining ones.
/// `boxes`: `count` bounding boxes of the children, at most kSlots. `slot_of`: receives the slot of each child.
inline void order_slots(const Box* boxes, unsigned count, unsigned (&slot_of)[kSlots]) {
    Vec3d centre[kSlots], middle = {0, 0, 0};
    for (unsigned c = 0; c < count; ++c) {
        centre[c] = static_cast<Vec3d>(boxes[c].lower) + static_cast<Vec3d>(boxes[c].upper);
        middle += (1.0 / count) * centre[c];
    }
    unsigned open_children = (1u << count) - 1, open_slots = 0xffu;
    while (open_children) {
        double best = -1e300;
        unsigned best_child = 0, best_slot = 0;
        for (unsigned c = 0; c < count; ++c) {
            if (!(open_children >> c & 1u)) continue;
            const Vec3d off = centre[c] - middle;
            for (unsigned s = 0; s < kSlots; ++s) {
                if (!(open_slots >> s & 1u)) continue;
                const double fit = (s & 1u ? off.x : -off.x) + (s & 2u ? off.y : -off.y) + (s & 4u ? off.z : -off.z);
                if (!(fit > best)) continue;
                best = fit;
                best_child = c;
                best_slot = s;
            }
        }
        slot_of[best_child] = best_slot;
        open_children &= ~(1u << best_child);
        open_slots &= ~(1u << best_slot);
    }
}

}  // namespace REALCAM_NAMESPACE
