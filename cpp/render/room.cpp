#include "room.hpp"

#include <array>
#include <cmath>

namespace realcam {

bool is_room(const Assembly& assembly, const Surroundings& subject, Vec3d backward) {
    const BoundingBox box = subject.box();
    const double thick = 0.02 * box.diagonal();
    const auto low = numbers(box.low), high = numbers(box.high), size = numbers(box.size()),
               to_camera = numbers(backward);
    std::array<double, 6> covered{};  // the low and the high side of each axis, m^2
    double inwards = 0, all = 0;
    bool lit_within = false;
    subject.for_each([&](std::size_t, const Piece& piece) {
        const auto from = numbers(piece.box.low), to = numbers(piece.box.high), area = numbers(piece.area);
        if (piece.emits) lit_within |= dot(box.middle() - piece.box.middle(), piece.area) > 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool at_low = to[axis] <= low[axis] + thick, at_high = from[axis] >= high[axis] - thick;
            if (!at_low && !at_high) continue;
            covered[2 * axis + (at_high ? 1 : 0)] += std::fabs(area[axis]);
            inwards += at_high ? -area[axis] : area[axis];
            all += std::fabs(area[axis]);
        }
    });
    int walls = 0;
    bool front = false;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t side = 0; side < 2; ++side) {
            const double whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
            const bool wall = whole > 0 && covered[2 * axis + side] >= 0.5 * whole;
            walls += wall;
            front |= wall && to_camera[axis] * (side == 1 ? 1 : -1) > 0.5;
        }
    if (!front || walls < 5) return false;
    const Scene& sky = *assembly.static_geometry;
    for (const ScenePointLight& light : sky.points)
        lit_within |= length(box.nearest(light.position_m) - light.position_m) == 0;
    const bool lit_from_outside = !sky.suns.empty() || sky.environment.emits();
    return inwards > 0.5 * all || (lit_within && !lit_from_outside);
}

}  // namespace realcam
