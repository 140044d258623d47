#pragma once
#include <cstdint>

#include "../math/affine.hpp"

namespace REALCAM_NAMESPACE {

// What kernels see of a scene: plain data and pointers. Positions are float and relative to an origin near the camera
// (RenderSpaceScene); light is photometric and per colour channel (linear Rec. 709): radiance in cd/m^2, intensity in
// cd, illuminance in lux.

struct Material {
    Vec3f diffuse = {0.5f, 0.5f, 0.5f};   ///< reflectance; times the texture where there is one
    Vec3f specular = {0, 0, 0};           ///< reflectance of the Phong lobe
    float shininess = 0;                  ///< Phong exponent (MTL Ns)
    Vec3f emission = {0, 0, 0};           ///< radiance, on the side of the geometric normal
    std::int32_t diffuse_texture = -1;    ///< index, or -1
};

struct Triangle {
    std::uint32_t vertices[3];
    std::uint32_t material;
};

/// The plane of a triangle, from positions in double precision: float corners of a sliver have no normal, and those of
/// a large triangle give no place on it.
struct TrianglePlane {
    Vec3f normal;  ///< unit, by the right-hand rule over the corners
    float height;  ///< dot(normal, p) of the points p on it
    float margin;  ///< how far from it the float triangle, and what traversal makes of it, may lie
};

/// Margin over the largest coordinate of the corners: 25 roundings to 24 bits. Corners and a point between them take
/// up to two each along the normal, and traversal, which works relative to the ray's origin, some ten of twice the
/// size.
inline constexpr float kMarginShare = 1.5e-6f;

/// 8-bit sRGB, row 0 at the top, texture coordinate v upwards, repeated outside 0..1.
struct TextureView {
    const std::uint8_t* rgba;
    std::int32_t width, height;
};

struct PointLight {
    Vec3f position;
    Vec3f intensity;
};

/// A light at infinity: parallel rays.
struct SunLight {
    Vec3f direction;    ///< of travel, unit
    Vec3f illuminance;  ///< on a plane that it meets at a right angle
};

/// A triangle that emits light.
struct AreaLight {
    Vec3f corner, edge_u, edge_v;
    Vec3f normal;  ///< unit; light leaves on this side
    Vec3f radiance;
    float density;  ///< of points chosen on all area lights, per square metre of this one
    float margin;   ///< see TrianglePlane
};

/// Light from infinity all around: constant, or a latitude-longitude image (row 0 up, +y; the middle column -z).
struct EnvironmentView {
    Vec3f constant;
    const Vec3f* pixels;          ///< null: constant
    const float* marginal_cdf;    ///< height + 1 values, for importance sampling (math/cdf.hpp)
    const float* conditional_cdf; ///< height rows of width + 1 values
    std::int32_t width, height;
};

// Every array of the following is also named in scene_arrays.hpp.

/// Triangles and what they are made of.
struct MeshView {
    const Triangle* triangles;
    const TrianglePlane* planes;  ///< one for each triangle
    const Vec3f* positions;
    const Vec3f* normals;  ///< per vertex, zero where the triangle is flat; null: all flat
    const Vec2f* uvs;      ///< per vertex; null: none
    const Material* materials;
    const TextureView* textures;
    std::int32_t triangle_count, vertex_count, material_count, texture_count;
};

/// An instance of an object.
struct InstanceView {
    Affine<float> render_from_object;
    InverseAffine<float> object_from_render;
    Vec3f margin;  ///< how far off along the object's axes a point may be for each unit of its placed coordinates
    float reach_margin;  ///< and, in the placed scene, for what the object's own coordinates leave, at most
    std::uint32_t object;
};

/// What depends on instance transforms: the instances, and the lights that may move with them.
struct InstancesView {
    const InstanceView* instances;
    const PointLight* points;
    const AreaLight* areas;
    const float* area_cdf;  ///< area_count + 1 values; null: no area light
    std::int32_t instance_count, point_count, area_count;
};

/// Static geometry's triangles, objects in frames of their own, and lights.
struct SceneView : MeshView, InstancesView {
    const MeshView* objects;
    const SunLight* suns;
    std::int32_t object_count, sun_count;
    bool has_environment;
    EnvironmentView environment;
};

}  // namespace REALCAM_NAMESPACE
