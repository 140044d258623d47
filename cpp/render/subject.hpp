#pragma once
#include <array>
#include <vector>

#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// Subject of a scene: the scene without its surroundings. The default view shows it.
///
/// A scene consists of parts: triangles that share vertices, or whole instances if there are too many triangles to test
/// each (kMostTrianglesAsked). Two rules remove parts until neither applies:
/// - If a part carries or encloses others, such as a floor, a table top, a wall or a sky, those are the subject. The
///   carrier must be twice and the scene three and a half times as long as they are. Flat parts of half the length of
///   the scene, lamps, and parts below a horizontal carrier are surroundings; other parts beside the carrier may have a
///   quarter of the triangles of the subject. Carriers and skies that are not flat have fewer triangles than the
///   subject, or keep away from it.
/// - Small parts are removed if they are farther away than eight times the length of the large parts.
class Subject {
public:
    /// `up`: unit.
    Subject(const Assembly& assembly, Vec3d up);

    BoundingBox box;
    std::vector<BoundingBox> part_boxes;
    BoundingBox content;  ///< bounds of all triangles that do not lie in a side of `box`

    /// True if the side of the box towards `direction` is a wall: triangles cover at least half of it, and face inwards
    /// or enclose the only light. A cube that is seen from outside has no walls. `direction` is nearly along an axis.
    bool has_wall(Vec3d direction) const;
    /// True if there are at least five walls.
    bool is_room() const;

private:
    std::array<bool, 6> walls_{};  ///< low and high side of the box along each axis
};

}  // namespace REALCAM_NAMESPACE
