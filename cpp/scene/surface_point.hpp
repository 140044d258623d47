#pragma once
#include "../math/lanes.hpp"
#include "scene_view.hpp"
#include "texture.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;
inline constexpr std::uint32_t kNoInstance = 0xffffffffu;

/// What traversal says of a ray: the nearest triangle, and where on it.
struct Hit {
    float distance;
    std::uint32_t triangle;  ///< kNoTriangle: none
    float u, v;              ///< barycentric, of the second and third corner
    std::uint32_t instance = kNoInstance;  ///< of which the triangle is a part; none: static geometry
};

template <int N>
struct Hits {
    alignas(kLaneAlignment<float, N>) float distance[N];
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t triangle[N];
    alignas(kLaneAlignment<float, N>) float u[N], v[N];
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t instance[N];

    REALCAM_INLINE Hit operator[](int lane) const {
        return {distance[lane], triangle[lane], u[lane], v[lane], instance[lane]};
    }
};

/// A point on a surface, turned to the side from which the ray came.
struct SurfacePoint {
    Vec3f position;
    Vec3f geometric_normal;
    Vec3f normal;  ///< interpolated
    Vec3f diffuse, specular;
    float shininess;
    Vec3f emission;     ///< radiance towards the ray's origin
    float self_offset;  ///< how far off the surface the next ray must start, so as not to meet it again
};

REALCAM_INLINE float largest_coordinate(Vec3f p) {
    const float x = std::fabs(p.x), y = std::fabs(p.y), z = std::fabs(p.z);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

/// Where a ray has met the mesh.
REALCAM_INLINE Vec3f hit_position(const MeshView& mesh, const TrianglePlane& plane, Hit hit, Vec3f ray_origin,
                                  Vec3f ray_direction) {
    // Along the ray: barycentric coordinates of a sliver are uncertain by its aspect ratio times the rounding, and
    // would carry the point along it. Not from afar, where the error of the distance exceeds that of the corners.
    const Vec3f way = hit.distance * ray_direction;
    Vec3f p = ray_origin + way;
    if ((largest_coordinate(ray_origin) + largest_coordinate(way)) * kMarginShare > 16.0f * plane.margin) {
        const std::uint32_t* corner = mesh.triangles[hit.triangle].vertices;
        p = (1.0f - hit.u - hit.v) * mesh.positions[corner[0]] + hit.u * mesh.positions[corner[1]] +
            hit.v * mesh.positions[corner[2]];
    }
    return p + (plane.height - dot(p, plane.normal)) * plane.normal;
}

REALCAM_INLINE SurfacePoint surface_point(const MeshView& mesh, Hit hit, Vec3f ray_origin, Vec3f ray_direction) {
    const Triangle triangle = mesh.triangles[hit.triangle];
    const TrianglePlane plane = mesh.planes[hit.triangle];
    const std::uint32_t* corner = triangle.vertices;
    const float w = 1.0f - hit.u - hit.v;
    const Material& material = mesh.materials[triangle.material];

    SurfacePoint point;
    point.position = hit_position(mesh, plane, hit, ray_origin, ray_direction);
    const bool from_front = dot(plane.normal, ray_direction) <= 0;
    point.geometric_normal = from_front ? plane.normal : -plane.normal;
    point.normal = point.geometric_normal;
    if (mesh.normals) {
        const Vec3f n = w * mesh.normals[corner[0]] + hit.u * mesh.normals[corner[1]] + hit.v * mesh.normals[corner[2]];
        const float n2 = dot(n, n);
        if (n2 > 0) {
            // On the ray's side too, so that a silhouette seen from behind its shading normal does not turn black.
            const Vec3f unit = (1.0f / std::sqrt(n2)) * n;
            point.normal = dot(unit, point.geometric_normal) < 0 ? -unit : unit;
        }
    }
    point.diffuse = material.diffuse;
    if (material.diffuse_texture >= 0 && mesh.uvs) {
        const Vec2f ua = mesh.uvs[corner[0]], ub = mesh.uvs[corner[1]], uc = mesh.uvs[corner[2]];
        const Vec2f uv = {w * ua.x + hit.u * ub.x + hit.v * uc.x, w * ua.y + hit.u * ub.y + hit.v * uc.y};
        point.diffuse = point.diffuse * sample_texture(mesh.textures[material.diffuse_texture], uv);
    }
    point.specular = material.specular;
    point.shininess = material.shininess;
    point.emission = from_front ? material.emission : Vec3f{0, 0, 0};
    point.self_offset = plane.margin;
    return point;
}

/// How far off a triangle of an instance lies, and what is traced to it: TrianglePlane's margin in the placed scene.
/// `stretch`: of lengths along the unit normal, by the way there. By axes, because an object that is flat or long in
/// its own frame is not as far off in one direction as in another.
REALCAM_INLINE float instance_margin(const InstanceView& instance, float plane_margin, Vec3f object_normal,
                                     float stretch, Vec3f placed) {
    const float own = stretch * plane_margin;
    const float off = std::fabs(object_normal.x) * instance.margin.x + std::fabs(object_normal.y) * instance.margin.y +
                      std::fabs(object_normal.z) * instance.margin.z;
    const float coordinates = largest_coordinate(placed) + largest_coordinate(instance.object_from_render.origin);
    return select(own < instance.reach_margin, own, instance.reach_margin) + stretch * off * coordinates;
}

/// Likewise of a whole scene: rays go into the object's frame, with the same distances, and what they find comes back.
REALCAM_INLINE SurfacePoint surface_point(const SceneView& scene, Hit hit, Vec3f ray_origin, Vec3f ray_direction) {
    if (hit.instance == kNoInstance)
        return surface_point(static_cast<const MeshView&>(scene), hit, ray_origin, ray_direction);
    const InstanceView& instance = scene.instances[hit.instance];
    const InverseAffine<float>& into = instance.object_from_render;
    SurfacePoint point =
        surface_point(scene.objects[instance.object], hit, into.point(ray_origin), into.direction(ray_direction));
    point.position = instance.render_from_object.point(point.position);
    const Vec3f geometric = into.normal_of(point.geometric_normal), shading = into.normal_of(point.normal);
    const float stretch = 1.0f / length(geometric);
    // The next ray is met in the object's frame again.
    point.self_offset = instance_margin(instance, point.self_offset, point.geometric_normal, stretch, point.position);
    point.geometric_normal = stretch * geometric;
    point.normal = normalized(dot(shading, geometric) < 0 ? -shading : shading);
    return point;
}

}  // namespace REALCAM_NAMESPACE
