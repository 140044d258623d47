#pragma once
#include "../math/lanes.hpp"
#include "scene_view.hpp"
#include "texture.hpp"

namespace REALCAM_NAMESPACE {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

/// What traversal says of a ray: the nearest triangle, and where on it.
struct Hit {
    float distance;
    std::uint32_t triangle;  ///< kNoTriangle: none
    float u, v;              ///< barycentric, of the second and third corner
};

template <int N>
struct Hits {
    alignas(kLaneAlignment<float, N>) float distance[N];
    alignas(kLaneAlignment<std::uint32_t, N>) std::uint32_t triangle[N];
    alignas(kLaneAlignment<float, N>) float u[N], v[N];

    REALCAM_INLINE Hit operator[](int lane) const { return {distance[lane], triangle[lane], u[lane], v[lane]}; }
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

/// Where a ray has met the scene.
REALCAM_INLINE Vec3f hit_position(const SceneView& scene, const TrianglePlane& plane, Hit hit, Vec3f ray_origin,
                                  Vec3f ray_direction) {
    // Along the ray: barycentric coordinates of a sliver are uncertain by its aspect ratio times the rounding, and
    // would carry the point along it. Not from afar, where the error of the distance exceeds that of the corners.
    Vec3f p = ray_origin + hit.distance * ray_direction;
    if ((largest_coordinate(ray_origin) + hit.distance) * kMarginShare > 16.0f * plane.margin) {
        const std::uint32_t* corner = scene.triangles[hit.triangle].vertices;
        p = (1.0f - hit.u - hit.v) * scene.positions[corner[0]] + hit.u * scene.positions[corner[1]] +
            hit.v * scene.positions[corner[2]];
    }
    return p + (plane.height - dot(p, plane.normal)) * plane.normal;
}

REALCAM_INLINE SurfacePoint surface_point(const SceneView& scene, Hit hit, Vec3f ray_origin, Vec3f ray_direction) {
    const Triangle triangle = scene.triangles[hit.triangle];
    const TrianglePlane plane = scene.planes[hit.triangle];
    const std::uint32_t* corner = triangle.vertices;
    const float w = 1.0f - hit.u - hit.v;
    const Material& material = scene.materials[triangle.material];

    SurfacePoint point;
    point.position = hit_position(scene, plane, hit, ray_origin, ray_direction);
    const bool from_front = dot(plane.normal, ray_direction) <= 0;
    point.geometric_normal = from_front ? plane.normal : -plane.normal;
    point.normal = point.geometric_normal;
    if (scene.normals) {
        const Vec3f n =
            w * scene.normals[corner[0]] + hit.u * scene.normals[corner[1]] + hit.v * scene.normals[corner[2]];
        const float n2 = dot(n, n);
        if (n2 > 0) {
            // On the ray's side too, so that a silhouette seen from behind its shading normal does not turn black.
            const Vec3f unit = (1.0f / std::sqrt(n2)) * n;
            point.normal = dot(unit, point.geometric_normal) < 0 ? -unit : unit;
        }
    }
    point.diffuse = material.diffuse;
    if (material.diffuse_texture >= 0 && scene.uvs) {
        const Vec2f ua = scene.uvs[corner[0]], ub = scene.uvs[corner[1]], uc = scene.uvs[corner[2]];
        const Vec2f uv = {w * ua.x + hit.u * ub.x + hit.v * uc.x, w * ua.y + hit.u * ub.y + hit.v * uc.y};
        point.diffuse = point.diffuse * sample_texture(scene.textures[material.diffuse_texture], uv);
    }
    point.specular = material.specular;
    point.shininess = material.shininess;
    point.emission = from_front ? material.emission : Vec3f{0, 0, 0};
    point.self_offset = plane.margin;
    return point;
}

}  // namespace REALCAM_NAMESPACE
