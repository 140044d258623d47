#pragma once
#include <array>
#include <cstddef>

#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// The subject of a scene is the scene without its surroundings. The default view shows it.
///
/// A scene consists of parts: triangles that share vertices, or instances where these have too many triangles to look
/// at each (kMostTrianglesAsked). Two rules remove parts until neither finds any more:
/// - Parts that enclose or carry the others, as a sky or a floor does. Each must be four times as long as all the
///   others together, and be flat, or have fewer triangles than they, or keep away from them.
/// - Small parts that are farther away than eight times the length of the large parts.
struct Subject {
    explicit Subject(const Assembly& assembly);

    /// A room has at least five walls that are seen from inside.
    bool is_room() const { return count_walls() >= 5; }
    int count_walls() const;

    BoundingBox box;
    /// The low and the high side of the box along each axis have a wall if triangles cover half of it or more. Walls
    /// face inwards, or the only light comes from within; a cube, which is seen from outside, has none.
    std::array<bool, 6> has_wall{};
    BoundingBox content;  ///< holds all that does not lie in a wall
};

/// The coordinates of a vector, by the number of their axis.
inline std::array<double, 3> coordinates(Vec3d v) {
    return {v.x, v.y, v.z};
}

}  // namespace REALCAM_NAMESPACE
