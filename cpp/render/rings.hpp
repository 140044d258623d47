#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene_pieces.hpp"

namespace REALCAM_NAMESPACE {

/// Which distances from a point the pieces of a scene touch.
class Rings {
public:
    /// `largest`: no piece is farther away, m.
    Rings(Vec3d centre, double largest) : centre_(centre), largest_(largest) {}

    int first(const Piece& p) const { return step_of(length(p.box.nearest(centre_) - centre_), largest_); }
    int last(const Piece& p) const { return step_of(farthest(p.box, centre_), largest_); }
    void add(const Piece& p) {
        ++change_[static_cast<std::size_t>(first(p))];
        --change_[static_cast<std::size_t>(last(p)) + 1];
    }
    /// The last steps that lie within a gap, the outermost gap first.
    std::vector<int> gaps() const {
        std::vector<int> found;
        int last_touched = -1;
        for (int i = 0, count = 0; i < kSteps; ++i) {
            count += change_[static_cast<std::size_t>(i)];
            if (count == 0) continue;
            if (last_touched >= 0 && i - last_touched > kGapSteps) found.insert(found.begin(), last_touched);
            last_touched = i;
        }
        return found;
    }

private:
    /// Radii in steps of the fourth root of two: eight times is twelve of them.
    static constexpr int kSteps = 128, kGapSteps = 12;

    static int step_of(double radius, double largest) {
        const double steps = 4 * std::log2(radius / largest) + kSteps - 1;
        return steps > 0 ? std::min(static_cast<int>(steps), kSteps - 1) : 0;
    }
    static double farthest(const BoundingBox& box, Vec3d p) {
        return length(Vec3d{std::max(p.x - box.low.x, box.high.x - p.x), std::max(p.y - box.low.y, box.high.y - p.y),
                            std::max(p.z - box.low.z, box.high.z - p.z)});
    }

    Vec3d centre_;
    double largest_;
    std::array<int, kSteps + 1> change_{};  ///< of the number of pieces, from one step to the next
};

}  // namespace REALCAM_NAMESPACE
