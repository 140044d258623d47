#pragma once
#include <vector>

#include "../../scene/geometry/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// Subject of a scene: the scene without its surroundings. The default view shows it.
///
/// A scene consists of parts: triangles that share vertices, or whole instances if there are too many triangles to test
/// each (kMaxTrianglesTested). Two rules remove parts until neither applies:
/// - If a part carries or encloses others, such as a floor, a table top, a wall or a sky, those are the subject. The
///   carrier must be twice and the scene three and a half times as long as they are. Flat parts of half the length of
///   the scene, lamps, and parts below a horizontal carrier are surroundings; other parts beside the carrier may have a
///   quarter of the triangles of the subject. Carriers and skies that are not flat have fewer triangles than the
///   subject, or keep away from it.
/// - Small parts are removed if they are farther away than eight times the length of the large parts.
struct Subject {
    /// `up`: unit vector.
    Subject(const Assembly& assembly, Vec3d up);

    BoundingBox box;  ///< bounds of the subject, m
    std::vector<BoundingBox> part_boxes;  ///< bounds of each of its parts
    BoundingBox content;  ///< bounds of all triangles that do not lie in a side of `box`

    /// Outward unit normals of the sides of the box that are walls: triangles cover at least half of the side, and face
    /// inwards or enclose the only light. A cube that is seen from outside has no walls.
    std::vector<Vec3d> walls;

    /// True if the side towards `direction`, which is nearly along an axis, is a wall.
    bool has_wall(Vec3d direction) const;
    /// True if the subject is a room: at least five sides are walls.
    bool is_room() const { return walls.size() >= 5; }
};

}  // namespace REALCAM_NAMESPACE
