#include "first_hit.hpp"

#include "../../scene/geometry/bounding_box.hpp"

namespace realcam {
namespace {

/// Intersects the triangles of one scene (Moeller and Trumbore 1997). The unit of the result is the length of
/// `direction`.
double first_hit(const Scene& scene, Vec3d origin, Vec3d direction, double beyond) {
    double first = BoundingBox::kNone;
    for (const Triangle& t : scene.triangles) {
        const Vec3d a = scene.positions_m[t.vertices[0]] - origin;
        const Vec3d u = scene.positions_m[t.vertices[1]] - origin - a;
        const Vec3d v = scene.positions_m[t.vertices[2]] - origin - a;
        const Vec3d p = cross(direction, v), q = cross(u, a);
        const double determinant = dot(u, p);
        const double along_u = -dot(a, p) / determinant, along_v = dot(direction, q) / determinant;
        if (!(along_u >= 0 && along_v >= 0 && along_u + along_v <= 1)) continue;
        const double distance = dot(v, q) / determinant;
        if (distance > beyond) first = std::min(first, distance);
    }
    return first;
}

}  // namespace

double first_hit(const Assembly& assembly, Vec3d origin, Vec3d direction, double beyond_m) {
    double first = first_hit(*assembly.static_geometry, origin, direction, beyond_m);
    ObjectBoxes boxes;
    for (const Instance& instance : assembly.instances) {
        const InverseAffine<double> into = instance.scene_from_object.inverse();
        // The map keeps the ray's parameter, which is therefore a distance in the scene.
        const Vec3d from = into.point(origin), along = into.direction(direction);
        const BoundingBox& box = boxes.of(*instance.object);
        const double radius = 0.5 * (1 + 1e-9) * box.diagonal();
        if (length(cross(box.middle() - from, along)) <= radius * length(along))
            first = std::min(first, first_hit(*instance.object, from, along, beyond_m));
    }
    return first;
}

}  // namespace realcam
