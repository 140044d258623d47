#pragma once
#include "../../math/lanes.hpp"
#include "../textures/texture.hpp"
#include "instance_at.hpp"

namespace REALCAM_NAMESPACE {

// Shading point of a hit: position, normals, textures and material parameters, on static geometry and on instances.

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;
inline constexpr std::uint32_t kNoInstance = 0xffffffffu;
/// Value of Hit::triangle of a path that a medium scatters in front of the surface (cross_medium).
inline constexpr std::uint32_t kScatteredInMedium = 0xfffffffeu;

/// Closest hit of a ray: triangle and barycentric coordinates.
struct Hit {
    float distance;  ///< in lengths of the ray's direction
    std::uint32_t triangle;  ///< kNoTriangle: the ray hits nothing
    float u, v;              ///< barycentric, of the second and third corner
    std::uint32_t instance = kNoInstance;  ///< kNoInstance: static geometry
};

/// Hits of N rays.
template <int N>
struct Hits {
    Lanes<float, N> distance;
    Lanes<std::uint32_t, N> triangle;
    Lanes<float, N> u, v;
    Lanes<std::uint32_t, N> instance;

    REALCAM_INLINE Hit operator[](int lane) const {
        return {distance[lane], triangle[lane], u[lane], v[lane], instance[lane]};
    }
};

/// Mesh of an instance's object, or of static geometry for kNoInstance.
REALCAM_INLINE const MeshView& mesh_of(const SceneView& scene, std::uint32_t instance) {
    if (instance == kNoInstance) return scene;
    return scene.objects[scene.instances[instance].object];
}

/// Point on a surface from which rays start; the normal faces the arriving ray's origin.
struct RaySpawnPoint {
    Vec3f position;
    Vec3f geometric_normal;
    float self_offset;  ///< offset along the normal at which the next ray must start to avoid self-intersection
};

/// Surface point with its shading parameters.
struct SurfacePoint : RaySpawnPoint {
    Vec3f normal;  ///< shading normal, unit, on the side of the ray's origin
    const Material* material;
    Color diffuse;  ///< the material's diffuse colour times texture and vertex colour
    Color emission;     ///< radiance towards the ray's origin
    bool is_front;  ///< the ray arrives on the side of the triangle's normal
    Color specular;  ///< this and the following members are set only if the scene kind is not plain
    float metallic, roughness, shininess, transmission, specular_weight, clearcoat, clearcoat_roughness;
    Vec3f coat_normal;  ///< shading normal of the clear coat, if there is one
};

/// Largest absolute coordinate.
REALCAM_INLINE float largest_coordinate(Vec3f p) {
    const float x = std::fabs(p.x), y = std::fabs(p.y), z = std::fabs(p.z);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

/// Position of a hit on the mesh.
REALCAM_INLINE Vec3f hit_position(const MeshView& mesh, const TrianglePlane& plane, Hit hit, Vec3f ray_origin,
                                  Vec3f ray_direction) {
    // The point is computed along the ray, because the barycentric coordinates of a sliver have a relative error of its
    // aspect ratio times a rounding error, which would shift the point along the sliver. From afar the error of the
    // distance along the ray exceeds that of the corners; then barycentric coordinates are used.
    constexpr float kMaxMargins = 16.0f;  // error along the ray, in plane margins, from which on it is not used
    const Vec3f offset = hit.distance * ray_direction;
    Vec3f p = ray_origin + offset;
    if ((largest_coordinate(ray_origin) + largest_coordinate(offset)) * kMarginShare > kMaxMargins * plane.margin) {
        const std::uint32_t* corner = mesh.triangles[hit.triangle].vertices;
        p = (1.0f - hit.u - hit.v) * mesh.positions[corner[0]] + hit.u * mesh.positions[corner[1]] +
            hit.v * mesh.positions[corner[2]];
    }
    // Projected onto the plane.
    return p + (plane.height - dot(p, plane.normal)) * plane.normal;
}

/// Texture coordinates of a hit and their derivatives over the triangle.
struct SurfaceUv {
    Vec2f at;  ///< texture coordinates of the hit
    Vec2f along_u, along_v;  ///< differences from the first corner to the second and to the third
};

/// Returns the texture coordinates of a hit. `uvs`: those of the vertices; null: all results are 0.
REALCAM_INLINE SurfaceUv surface_uv(const Vec2f* uvs, const Triangle& triangle, Hit hit) {
    if (!uvs) return {{0, 0}, {0, 0}, {0, 0}};
    const Vec2f a = uvs[triangle.vertices[0]], b = uvs[triangle.vertices[1]], c = uvs[triangle.vertices[2]];
    const float w = 1.0f - hit.u - hit.v;
    return {{w * a.x + hit.u * b.x + hit.v * c.x, w * a.y + hit.u * b.y + hit.v * c.y},
            {b.x - a.x, b.y - a.y},
            {c.x - a.x, c.y - a.y}};
}

/// Returns the texture coordinates of a hit in the UV set that a texture reference uses.
REALCAM_INLINE SurfaceUv surface_uv(const MeshView& mesh, const Triangle& triangle, Hit hit,
                                    const TextureReference& reference) {
    return surface_uv(reference.uv_set == 0 ? mesh.uvs : mesh.second_uvs, triangle, hit);
}

/// Applies the affine texture transform of a reference (KHR_texture_transform) to texture coordinates.
REALCAM_INLINE Vec2f transformed(const TextureReference& reference, Vec2f uv) {
    const Vec3f homogeneous = {uv.x, uv.y, 1.0f};
    return {dot(reference.to_u, homogeneous), dot(reference.to_v, homogeneous)};
}

/// Cross section of the beam that a ray represents, as a solid angle, for filtering colour textures. On the film it is
/// the area of a pixel divided by the number of samples taken so far, because all samples together cover the pixel: so
/// the first samples are free of aliasing, and the mean of many is as sharp as the texture. The circle of confusion is
/// not included: its rays already hit the surface at many points, and the texture would be blurred twice.
struct Footprint {
    float area = 0;  ///< perpendicular to the ray, over the squared distance: in steradians; 0: a point
    float chance = 0;  ///< random number, 0 to 1, that chooses between two mipmap levels
};

/// Function that returns a footprint of zero area, for callers that filter no textures.
struct PointFootprint {
    REALCAM_INLINE Footprint operator()() const { return {}; }
};

/// Footprint in texture coordinates.
struct UvFootprint {
    float area = 0;  ///< in squared texture-coordinate units
    float chance = 0;  ///< see Footprint
};

/// Projects a ray's footprint onto the surface and into texture coordinates. `normal`: of the surface. In an object's
/// frame the ray's direction is not normalised and areas are scaled; the caller compensates by dividing the footprint's
/// area by the determinant of the object's transform. The transform's effect on the normal cancels.
REALCAM_INLINE UvFootprint uv_footprint(const MeshView& mesh, const Triangle& triangle, const SurfaceUv& uv, Hit hit,
                                        Vec3f normal, Vec3f ray_direction, Footprint footprint) {
    const Vec3f a = mesh.positions[triangle.vertices[0]];
    // Twice the area of the triangle, as a vector and in texture coordinates.
    const Vec3f double_area = cross(mesh.positions[triangle.vertices[1]] - a, mesh.positions[triangle.vertices[2]] - a);
    const float double_uv_area = std::fabs(uv.along_u.x * uv.along_v.y - uv.along_u.y * uv.along_v.x);
    // The footprint is elongated at grazing incidence; its length is limited to a hundred times its width.
    const float cosine = std::fabs(dot(normal, ray_direction)), min_cosine = 0.01f * length(ray_direction);
    const float on_surface = footprint.area * hit.distance * hit.distance / (cosine > min_cosine ? cosine : min_cosine);
    const float area = on_surface * double_uv_area / length(double_area);
    // A degenerate triangle makes the area infinite or NaN.
    return {area < 1e30f ? area : 0.0f, footprint.chance};
}

/// Returns the mipmap level of a texture for a footprint: one of the two levels between whose texel areas the
/// footprint's area lies, chosen at random so that the mean is the interpolation between both (Pharr et al. 2024).
REALCAM_INLINE TextureView level_for(const TextureView& texture, const TextureReference& reference,
                                     UvFootprint footprint) {
    if (!(footprint.area > 0.0f) || texture.coarse_levels == 0) return texture;
    // Area scale of the texture transform.
    const float determinant = std::fabs(reference.to_u.x * reference.to_v.y - reference.to_u.y * reference.to_v.x);
    const float texels =
        footprint.area * determinant * static_cast<float>(texture.width) * static_cast<float>(texture.height);
    if (!(texels > 1.0f)) return texture;
    return level_of(texture, static_cast<int>(0.5f * std::log2(texels < 1e30f ? texels : 1e30f) + footprint.chance));
}

/// Filtered texture lookup at the texture coordinates `uv` of the vertices, before the reference's transform.
REALCAM_ONE_COPY Color color_of(const TextureView& texture, const TextureReference& reference, Vec2f uv,
                                UvFootprint footprint) {
    return sample_texture(level_for(texture, reference, footprint), transformed(reference, uv), reference.sampler);
}

/// Texture colour; white if the reference has no texture or the mesh no texture coordinates. A footprint of zero area
/// samples the finest level.
REALCAM_INLINE Color texture_color(const MeshView& mesh, const TextureReference& reference, Vec2f uv,
                                   UvFootprint footprint = {}) {
    if (reference.texture < 0 || !mesh.uvs) return {1, 1, 1};
    return color_of(mesh.textures[reference.texture], reference, uv, footprint);
}

/// Texture colour for a texture that uses second_uvs. Few textures do, so that on GPUs this is a function call.
REALCAM_GPU_CALL Color color_by_second_uvs(const MeshView& mesh, const Triangle& triangle, Hit hit,
                                           const TextureReference& reference, Vec3f normal, Vec3f ray_direction,
                                           Footprint footprint) {
    const SurfaceUv uv = surface_uv(mesh.second_uvs, triangle, hit);
    UvFootprint filtered;
    if (footprint.area > 0.0f) filtered = uv_footprint(mesh, triangle, uv, hit, normal, ray_direction, footprint);
    return texture_color(mesh, reference, uv.at, filtered);
}

/// Interpolated vertex colour at a hit; white without vertex colours.
REALCAM_INLINE Color vertex_color(const MeshView& mesh, const Triangle& triangle, Hit hit) {
    if (!mesh.colors) return {1, 1, 1};
    const VertexColor a = mesh.colors[triangle.vertices[0]], b = mesh.colors[triangle.vertices[1]],
                      c = mesh.colors[triangle.vertices[2]];
    return (1.0f - hit.u - hit.v) * a.color + hit.u * b.color + hit.v * c.color;
}

/// Interpolated vertex alpha at a hit; 1 without vertex colours.
REALCAM_INLINE float vertex_alpha(const MeshView& mesh, const Triangle& triangle, Hit hit) {
    if (!mesh.colors) return 1.0f;
    const std::uint32_t* corner = triangle.vertices;
    return (1.0f - hit.u - hit.v) * mesh.colors[corner[0]].alpha + hit.u * mesh.colors[corner[1]].alpha +
           hit.v * mesh.colors[corner[2]].alpha;
}

/// Alpha channel of a texture, which must exist, at a hit. Not filtered.
REALCAM_INLINE float texture_alpha(const MeshView& mesh, const Triangle& triangle, Hit hit,
                                   const TextureReference& reference) {
    return sample_texture_alpha(mesh.textures[reference.texture],
                                transformed(reference, surface_uv(mesh, triangle, hit, reference).at),
                                reference.sampler);
}

/// Returns the shading normal from a tangent-space normal map, unit. `normal`: the unperturbed normal, on the outer
/// side; `scale`: factor of the map's x and y. Returns `normal` if the texture coordinates define no tangent.
REALCAM_INLINE Vec3f mapped_normal(const MeshView& mesh, const Triangle& triangle, const TextureReference& map,
                                   float scale, const SurfaceUv& uv, Vec3f normal) {
    const Color texel = texture_color(mesh, map, uv.at);
    const Vec3f bump = {scale * (2.0f * texel.r - 1.0f), scale * (2.0f * texel.g - 1.0f), 2.0f * texel.b - 1.0f};
    // Tangent: the direction of increasing u (v points up, as in glTF's tangent space).
    const Vec3f p = mesh.positions[triangle.vertices[0]], to_second = mesh.positions[triangle.vertices[1]] - p,
                to_third = mesh.positions[triangle.vertices[2]] - p;
    const Vec3f along_u = {uv.along_u.x, uv.along_u.y, 0}, along_v = {uv.along_v.x, uv.along_v.y, 0};
    const float u1 = dot(map.to_u, along_u), u2 = dot(map.to_u, along_v), v1 = dot(map.to_v, along_u),
                v2 = dot(map.to_v, along_v);
    const float determinant = u1 * v2 - u2 * v1;  // negative if the texture is mirrored on the surface
    const Vec3f tangent = v2 * to_second - v1 * to_third;
    const Vec3f projected = tangent - dot(tangent, normal) * normal;
    const float squared = dot(projected, projected);
    if (!(squared > 0.0f) || determinant == 0.0f) return normal;
    const Vec3f t = ((determinant > 0.0f ? 1.0f : -1.0f) / std::sqrt(squared)) * projected;
    const Vec3f b = (determinant > 0.0f ? 1.0f : -1.0f) * cross(normal, t);
    const Vec3f mapped = bump.x * t + bump.y * b + bump.z * normal;
    const float size2 = dot(mapped, mapped);
    return size2 > 0.0f ? (1.0f / std::sqrt(size2)) * mapped : normal;
}

/// Shading parameters at a hit on a mesh. `footprint_of`: function without arguments that returns the ray's Footprint,
/// called only if there are textures.
template <SceneKind scene_kind, class FootprintOf>
REALCAM_INLINE SurfacePoint point_on_mesh(const MeshView& mesh, Hit hit, Vec3f ray_origin, Vec3f ray_direction,
                                          FootprintOf&& footprint_of) {
    const Triangle triangle = mesh.triangles[hit.triangle];
    const TrianglePlane plane = mesh.planes[hit.triangle];
    const std::uint32_t* corner = triangle.vertices;
    const float w = 1.0f - hit.u - hit.v;
    const Material& material = mesh.materials[triangle.material];

    SurfacePoint point;
    point.position = hit_position(mesh, plane, hit, ray_origin, ray_direction);
    point.is_front = dot(plane.normal, ray_direction) <= 0;
    // Local variables until the end: gcc keeps members of `point` in memory, and reading them back stalls.
    const Vec3f geometric = (point.is_front ? 1.0f : -1.0f) * plane.normal;
    Vec3f normal = geometric;
    const bool is_textured = scene_kind != SceneKind::plain || material.diffuse_texture.texture >= 0;
    const SurfaceUv uv = is_textured ? surface_uv(mesh.uvs, triangle, hit) : SurfaceUv{{0, 0}, {0, 0}, {0, 0}};
    Footprint footprint;
    UvFootprint filtered;
    if (is_textured && mesh.uvs) {
        footprint = footprint_of();
        if (footprint.area > 0.0f)
            filtered = uv_footprint(mesh, triangle, uv, hit, plane.normal, ray_direction, footprint);
    }
    // Lookups without and with filtering.
    const auto at_point = [&](const TextureReference& map) {
        if (map.uv_set != 0) return color_by_second_uvs(mesh, triangle, hit, map, plane.normal, ray_direction, {});
        return texture_color(mesh, map, uv.at);
    };
    const auto over_footprint = [&](const TextureReference& map) {
        if (map.uv_set != 0)
            return color_by_second_uvs(mesh, triangle, hit, map, plane.normal, ray_direction, footprint);
        return texture_color(mesh, map, uv.at, filtered);
    };
    if (mesh.normals) {
        const Vec3f n = w * mesh.normals[corner[0]] + hit.u * mesh.normals[corner[1]] + hit.v * mesh.normals[corner[2]];
        const float n2 = dot(n, n);
        if (n2 > 0) normal = (1.0f / std::sqrt(n2)) * n;
    }
    if constexpr (scene_kind != SceneKind::plain) {
        const Vec3f smooth = normal;
        const auto mapped = [&](const TextureReference& map, float scale) {
            if (map.texture < 0 || !mesh.uvs) return smooth;
            const Vec3f outer = dot(smooth, plane.normal) < 0 ? -smooth : smooth;
            return mapped_normal(mesh, triangle, map, scale,
                                 map.uv_set == 0 ? uv : surface_uv(mesh.second_uvs, triangle, hit), outer);
        };
        point.clearcoat = material.clearcoat;
        point.coat_normal = smooth;
        if (point.clearcoat > 0.0f) {
            point.clearcoat *= at_point(material.clearcoat_texture).r;
            point.clearcoat_roughness = material.clearcoat_roughness * at_point(material.clearcoat_roughness_texture).g;
            point.coat_normal = mapped(material.clearcoat_normal_texture, material.clearcoat_normal_scale);
            if (dot(point.coat_normal, geometric) < 0) point.coat_normal = -point.coat_normal;
        }
        normal = mapped(material.normal_texture, material.normal_scale);
    }
    point.geometric_normal = geometric;
    // On the ray's side like the geometric normal, so that a silhouette seen from behind its shading normal does not
    // become black.
    point.normal = (dot(normal, geometric) < 0 ? -1.0f : 1.0f) * normal;
    point.material = &material;
    point.diffuse = material.diffuse;
    point.emission = point.is_front ? material.emission : Color{0, 0, 0};
    if (is_textured) point.diffuse *= over_footprint(material.diffuse_texture);
    if constexpr (scene_kind != SceneKind::plain) {
        if (mesh.colors) point.diffuse *= vertex_color(mesh, triangle, hit);
        if (material.emits_on_both_sides) point.emission = material.emission;
        point.emission *= over_footprint(material.emission_texture);
        if (material.vertex_emission) point.emission *= vertex_color(mesh, triangle, hit);
        const Color rough_metal = at_point(material.metallic_roughness_texture);
        point.specular = material.specular * over_footprint(material.specular_texture);
        point.roughness = material.roughness * rough_metal.g;
        point.metallic = material.metallic * rough_metal.b;
        point.shininess = material.shininess * rough_metal.g;
        point.transmission = material.transmission;
        if (point.transmission > 0.0f) point.transmission *= at_point(material.transmission_texture).r;
        point.specular_weight = material.specular_weight;
        const TextureReference& weights = material.specular_weight_texture;
        if (weights.texture >= 0 && mesh.uvs) point.specular_weight *= texture_alpha(mesh, triangle, hit, weights);
    }
    point.self_offset = plane.margin;
    return point;
}

/// Error bound of a triangle of an instance and of hits on it: TrianglePlane::margin in render space. It is the sum of
/// two parts: the rounding of the object's own coordinates, s m, at most InstanceView::max_object_margin, and that of
/// the transform, s c (|n.x| e.x + |n.y| e.y + |n.z| e.z). There, s is `stretch`, the scale of lengths along the normal
/// under the instance's transform; m is `plane_margin`, in object space; n is `object_normal`, unit; e is
/// InstanceView::margin, per axis, because an object that is flat or long in its own frame has different errors in
/// different directions; and c bounds the coordinates that are transformed. `position`: a point of the triangle in
/// render space.
REALCAM_INLINE float instance_margin(const InstanceView& instance, float plane_margin, Vec3f object_normal,
                                     float stretch, Vec3f position) {
    const float from_object = stretch * plane_margin;
    const float from_transform = std::fabs(object_normal.x) * instance.margin.x +
                                 std::fabs(object_normal.y) * instance.margin.y +
                                 std::fabs(object_normal.z) * instance.margin.z;
    const float coordinates = largest_coordinate(position) + largest_coordinate(instance.object_from_render.origin);
    return select(from_object < instance.max_object_margin, from_object, instance.max_object_margin) +
           stretch * from_transform * coordinates;
}

/// Shading parameters at a hit on an instance: transforms the ray into the object's frame, which keeps distances, and
/// the result back.
template <SceneKind scene_kind, class FootprintOf>
REALCAM_INLINE SurfacePoint point_on_instance(const MeshView& object, const InstanceView& instance, Hit hit,
                                              Vec3f ray_origin, Vec3f ray_direction, FootprintOf&& footprint_of) {
    const InverseAffine<float>& into_object = instance.object_from_render;
    const auto footprint_of_object = [&] {
        Footprint footprint = footprint_of();
        footprint.area /= std::fabs(instance.render_from_object.determinant());
        return footprint;
    };
    SurfacePoint point = point_on_mesh<scene_kind>(object, hit, into_object.point(ray_origin),
                                                   into_object.direction(ray_direction), footprint_of_object);
    point.position = instance.render_from_object.point(point.position);
    const Vec3f geometric = into_object.normal_of(point.geometric_normal),
                shading = into_object.normal_of(point.normal);
    const float stretch = 1.0f / length(geometric);
    // The next ray is intersected in the object's frame again, with the errors of its transform.
    point.self_offset = instance_margin(instance, point.self_offset, point.geometric_normal, stretch, point.position);
    point.geometric_normal = stretch * geometric;
    point.normal = normalized(dot(shading, geometric) < 0 ? -shading : shading);
    if constexpr (scene_kind != SceneKind::plain) {
        const Vec3f coat = into_object.normal_of(point.coat_normal);
        point.coat_normal = normalized(dot(coat, geometric) < 0 ? -coat : coat);
    }
    return point;
}

/// Shading parameters at a hit in the scene. `time`: fraction of the exposure, 0 to 1. `footprint_of`: see
/// point_on_mesh.
template <SceneKind scene_kind, class FootprintOf = PointFootprint>
REALCAM_INLINE SurfacePoint surface_point(const SceneView& scene, Hit hit, Vec3f ray_origin, Vec3f ray_direction,
                                          float time, FootprintOf&& footprint_of = {}) {
    if (hit.instance == kNoInstance)
        return point_on_mesh<scene_kind>(static_cast<const MeshView&>(scene), hit, ray_origin, ray_direction,
                                         footprint_of);
    const InstanceView& instance = scene.instances[hit.instance];
    const MeshView& object = scene.objects[instance.object];
    if constexpr (scene_kind == SceneKind::any) {
        const InstanceView moved = instance_at(scene, hit.instance, time);
        return point_on_instance<scene_kind>(object, moved, hit, ray_origin, ray_direction, footprint_of);
    }
    return point_on_instance<scene_kind>(object, instance, hit, ray_origin, ray_direction, footprint_of);
}

}  // namespace REALCAM_NAMESPACE
