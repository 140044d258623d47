#pragma once
#include <vector>

#include "../../scene/geometry/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// Intersections of a straight line with all triangles of a scene. Each triangle is tested once, which costs less than
/// building a hierarchy for a camera whose position on the line is still to be found.
class AxisCrossings {
public:
    /// `direction`: unit.
    AxisCrossings(const Assembly& assembly, Vec3d origin, Vec3d direction);

    /// Signed distances from the origin, in ascending order.
    const std::vector<double>& distances_m() const { return distances_m_; }

    /// The nearest intersection farther than this distance; infinite if all are nearer.
    double first_beyond(double distance_m) const;

private:
    /// True if the line intersects the box, with a tolerance for rounding: a box may be flat.
    static bool meets(const BoundingBox& box, Vec3d origin, Vec3d direction);

    /// Intersects the triangles (Moeller and Trumbore 1997).
    void add(const Scene& scene, Vec3d origin, Vec3d direction);

    std::vector<double> distances_m_;
};

}  // namespace REALCAM_NAMESPACE
