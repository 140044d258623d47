#pragma once
#include <array>
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
    void add(const Piece& p);
    /// The last steps that lie within a gap, the outermost gap first.
    std::vector<int> gaps() const;

private:
    /// Radii in steps of the fourth root of two: eight times is twelve of them.
    static constexpr int kSteps = 128, kGapSteps = 12;

    static int step_of(double radius, double largest);
    static double farthest(const BoundingBox& box, Vec3d p);

    Vec3d centre_;
    double largest_;
    std::array<int, kSteps + 1> change_{};  ///< of the number of pieces, from one step to the next
};

}  // namespace REALCAM_NAMESPACE
