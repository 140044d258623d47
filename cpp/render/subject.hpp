#pragma once
#include <array>
#include <cstddef>

#include "../scene/bounding_box.hpp"

namespace REALCAM_NAMESPACE {

/// What a picture of a scene shows where nobody says it: the scene without its surroundings.
///
/// A scene consists of parts: triangles that share vertices, or instances where these have too many triangles to look
/// at each (kMostTrianglesAsked). Parts are surroundings in two cases, which are looked for again in what is left:
/// - they enclose or carry the rest, as a sky or a floor does: each of them is four times as long as all the rest, and
///   flat, of fewer triangles than the rest, or at a distance from it;
/// - they are small, and farther away than eight times the length of the large parts.
struct Subject {
    explicit Subject(const Assembly& assembly);

    /// A box whose walls are seen from inside: these face inwards, or the only light comes from within.
    bool is_room() const { return count_walls() >= 5; }
    int count_walls() const;

    BoundingBox box;
    /// Of the box: the low and the high side of each axis that a wall covers by half or more; none of what is seen from
    /// outside, as a cube is.
    std::array<bool, 6> has_wall{};
    BoundingBox content;  ///< what does not lie in a wall; empty: nothing
};

/// The coordinates of a vector, by the number of their axis.
inline std::array<double, 3> coordinates(Vec3d v) {
    return {v.x, v.y, v.z};
}

}  // namespace REALCAM_NAMESPACE
