#include "rings.hpp"

#include <algorithm>
#include <cmath>

namespace realcam {

void Rings::add(const Piece& p) {
    ++change_[static_cast<std::size_t>(first(p))];
    --change_[static_cast<std::size_t>(last(p)) + 1];
}

std::vector<int> Rings::gaps() const {
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

int Rings::step_of(double radius, double largest) {
    const double steps = 4 * std::log2(radius / largest) + kSteps - 1;
    return steps > 0 ? std::min(static_cast<int>(steps), kSteps - 1) : 0;
}

double Rings::farthest(const BoundingBox& box, Vec3d p) {
    return length(Vec3d{std::max(p.x - box.low.x, box.high.x - p.x), std::max(p.y - box.low.y, box.high.y - p.y),
                        std::max(p.z - box.low.z, box.high.z - p.z)});
}

}  // namespace realcam
