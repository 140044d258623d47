#pragma once
#include <vector>

#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// Where a straight line meets the triangles of a scene. They are asked once, which costs less than a hierarchy for a
/// camera that has yet to find its place on the line.
class AxisCrossings {
public:
    /// `direction`: unit.
    AxisCrossings(const Assembly& assembly, Vec3d origin, Vec3d direction);

    /// Signed, from the origin, in rising order.
    const std::vector<double>& distances_m() const { return distances_m_; }

    /// The nearest one that is farther than this; infinite where there is none.
    double first_beyond(double distance_m) const;

private:
    /// With leave for rounding: a box may be flat.
    static bool meets(const BoundingBox& box, Vec3d origin, Vec3d direction);

    /// Moeller and Trumbore 1997.
    void add(const Scene& scene, Vec3d origin, Vec3d direction);

    std::vector<double> distances_m_;
};

}  // namespace REALCAM_NAMESPACE
