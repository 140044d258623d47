#include "axis_crossings.hpp"
#include "../../scene/assembly.hpp"

#include <algorithm>

namespace realcam {

AxisCrossings::AxisCrossings(const Assembly& assembly, Vec3d origin, Vec3d direction) {
    add(*assembly.static_geometry, origin, direction);
    ObjectBoxes boxes;
    for (const Instance& instance : assembly.instances) {
        const InverseAffine<double> into = instance.scene_from_object.inverse();
        // The map keeps the line's parameter, which is therefore a distance in the scene.
        const Vec3d from = into.point(origin), along = into.direction(direction);
        if (meets(boxes.of(*instance.object), from, along)) add(*instance.object, from, along);
    }
    std::sort(distances_m_.begin(), distances_m_.end());
}

double AxisCrossings::first_beyond(double distance_m) const {
    const auto found = std::upper_bound(distances_m_.begin(), distances_m_.end(), distance_m);
    return found == distances_m_.end() ? BoundingBox::kNone : *found;
}

bool AxisCrossings::meets(const BoundingBox& box, Vec3d origin, Vec3d direction) {
    double from = -BoundingBox::kNone, to = BoundingBox::kNone;
    const double leave = 1e-9 * (box.diagonal() + length(origin - box.nearest(origin)));
    const auto cut = [&](double o, double d, double low, double high) {
        if (d == 0) {
            if (o < low - leave || o > high + leave) to = -BoundingBox::kNone;
            return;
        }
        const double a = (low - leave - o) / d, b = (high + leave - o) / d;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    };
    if (box.empty()) return false;
    cut(origin.x, direction.x, box.low.x, box.high.x);
    cut(origin.y, direction.y, box.low.y, box.high.y);
    cut(origin.z, direction.z, box.low.z, box.high.z);
    return from <= to;
}

void AxisCrossings::add(const Scene& scene, Vec3d origin, Vec3d direction) {
    for (const Triangle& t : scene.triangles) {
        const Vec3d a = scene.positions_m[t.vertices[0]] - origin;
        const Vec3d u = scene.positions_m[t.vertices[1]] - origin - a;
        const Vec3d v = scene.positions_m[t.vertices[2]] - origin - a;
        const Vec3d p = cross(direction, v), q = cross(u, a);
        const double determinant = dot(u, p);
        const double first = -dot(a, p) / determinant, second = dot(direction, q) / determinant;
        if (!(first >= 0 && second >= 0 && first + second <= 1)) continue;
        distances_m_.push_back(dot(v, q) / determinant);
    }
}

}  // namespace realcam
