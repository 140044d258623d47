#pragma once
#include <array>
#include <cstddef>

#include "../../scene/geometry/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// Subject of a scene: the scene without its surroundings. The default view shows it.
///
/// A scene consists of parts: triangles that share vertices, or whole instances if there are too many triangles to test
/// each (kMostTrianglesTested). Two rules remove parts until neither applies:
/// - Parts that enclose or carry the others, such as a sky or a floor. Each must be four times as long as all the
///   others together, and be flat, or have fewer triangles than they, or keep away from them.
/// - Small parts that are farther away than eight times the length of the large parts.
struct Subject {
    explicit Subject(const Assembly& assembly);

    /// True for a room, which has at least five walls that are seen from inside.
    bool is_room() const { return count_walls() >= 5; }
    int count_walls() const;

    BoundingBox box;
    /// True for the low and the high side of the box along each axis if it has a wall, which covers half of the side or
    /// more. Walls face inwards, or the only light comes from within; a cube that is seen from outside has no wall.
    std::array<bool, 6> has_wall{};
    BoundingBox content;  ///< bounds of all facets that do not lie in a wall
};

/// Coordinates of a vector, indexed by axis.
inline std::array<double, 3> coordinates(Vec3d v) {
    return {v.x, v.y, v.z};
}

}  // namespace REALCAM_NAMESPACE
