#pragma once
#include <cstdint>

#include "../math/affine.hpp"
#include "material.hpp"

namespace REALCAM_NAMESPACE {

// What kernels see of a scene: plain data and pointers. Positions are float and relative to an origin near the camera
// (RenderSpaceScene); light is photometric and per colour channel (linear Rec. 709): radiance in cd/m^2, intensity in
// cd, illuminance in lux.

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

/// How the numbers of a texture become light.
enum class TextureEncoding : std::int32_t { srgb, linear };

/// Row 0 at the top, texture coordinate v upwards, repeated outside 0..1. Either 8-bit codes or floats.
struct TextureView {
    const std::uint8_t* rgba;  ///< null: floats
    const float* linear_rgba;
    std::int32_t width, height;
    TextureEncoding encoding;  ///< of the codes
    /// Its coarser levels, one after the other (texture_levels.hpp): of each the width and height are half those of the
    /// one before, rounded down, and 1 at least.
    const std::uint8_t* coarse_rgba = nullptr;
    const float* coarse_linear_rgba = nullptr;
    std::int32_t coarse_levels = 0;
};

/// Intensity times (cos_scale c + cos_offset)^2, that sum kept between 0 and 1, at the cosine c of the angle to the
/// axis: a spot's (KHR_lights_punctual). As it is without an axis: the same in all directions.
struct PointLight {
    Vec3f position;
    Color intensity;
    Vec3f axis = {0, 0, 1};
    float cos_scale = 0, cos_offset = 1;
    std::int32_t moves_with = -1;  ///< instance in whose object's frame position and axis are; below 0: none, which
                                   ///< does not move
};

/// A light at infinity: parallel rays.
struct SunLight {
    Vec3f direction;  ///< of travel, unit
    Color illuminance;  ///< on a plane that it meets at a right angle
};

/// A triangle that emits light.
struct AreaLight {
    Vec3f corner, edge_u, edge_v;  ///< of one that moves: at the begin of the exposure (area_light_at)
    Vec3f normal;  ///< unit; light leaves on this side
    std::int32_t is_two_sided;  ///< not 0: and on the other
    Color radiance;
    float area;  ///< square metres
    float margin;  ///< see TrianglePlane
    std::uint32_t triangle, instance;  ///< where a ray meets it (see Hit)
};

/// Light from infinity all around: constant, or a latitude-longitude image (row 0 up, +y; the middle column -z).
struct EnvironmentView {
    Color constant;
    const Color* pixels;  ///< null: constant
    const float* marginal_cdf;  ///< height + 1 values, for importance sampling (math/cdf.hpp)
    const float* conditional_cdf;  ///< height rows of width + 1 values
    std::int32_t width, height;
    float mean_luminance;  ///< over all directions
};

/// LightNode::cos_spread of lights that shine in all directions alike.
inline constexpr float kIsotropic = 2;

/// Part of a tree over all point and area lights, from which one is chosen by what it may contribute to a point
/// (Conty Estevez and Kulla 2018). The first child of a node follows it. A leaf has one light, or the triangles of one
/// flat lamp.
struct alignas(16) LightNode {
    Vec3f middle;  ///< of the box about the lights
    float squared_radius;  ///< of the ball about that box
    Vec3f axis;  ///< middle of the normals of area lights
    float cos_spread;  ///< of the angle about it in which all normals lie; -1: all directions; or kIsotropic
    float intensity;  ///< luminous, along the normal, of all of them, cd
    std::int32_t second_child;  ///< below 0: a leaf, whose first light is -1 - second_child
    std::int32_t partner;  ///< of a leaf: its second light; -1: it has one; less: all are from -2 - partner on in
                           ///< leaf_lights, which takes a GPU longer than these two
    float first_share;  ///< probability of the first of two
};

/// One of more than two lights of a leaf, which follow each other.
struct LeafLight {
    std::int32_t light;  ///< a point light, or an area light after all point lights; -1: the last one was before
    float below;  ///< probability of those before it in its leaf
};

/// What the diffuse colour of a surface, and where its material says so emission and opacity, are multiplied by at a
/// vertex; in between it is interpolated.
struct VertexColor {
    Color color = {1, 1, 1};  ///< linear
    float alpha = 1;

    constexpr bool operator==(const VertexColor&) const = default;
};

// Every array of the following is also named in scene_arrays.hpp.

/// Triangles and what they are made of.
struct MeshView {
    const Triangle* triangles;
    const TrianglePlane* planes;  ///< one for each triangle
    const Vec3f* positions;
    const Vec3f* normals;  ///< per vertex, zero where the triangle is flat; null: all flat
    const Vec2f *uvs, *second_uvs;  ///< per vertex; null: none
    const VertexColor* colors;  ///< per vertex; null: white
    const Material* materials;
    const TextureView* textures;
    const std::uint32_t* emitters;  ///< the triangles that emit light, in rising order
    std::int32_t triangle_count, vertex_count, material_count, texture_count, emitter_count;
};

/// An instance of an object. Of one that moves, transforms are those at the begin of the exposure (instance_at).
struct InstanceView {
    Affine<float> render_from_object;
    InverseAffine<float> object_from_render;
    Vec3f margin;  ///< how far off along the object's axes a point may be for each unit of its placed coordinates
    float reach_margin;  ///< and, in the placed scene, for what the object's own coordinates leave, at most
    std::uint32_t object;
    std::int32_t first_area;  ///< area light of the object's first emitter
    std::int32_t first_key, key_count;  ///< of its motion; 0: it does not move
};

/// What depends on instance transforms: the instances, the lights that may move with them, and whether anything moves.
struct InstancesView {
    SceneKind kind;
    const InstanceView* instances;
    const Affine<float>* keys;  ///< render_from_object of instances that move, at even times of the exposure
    const PointLight* points;
    const AreaLight* areas;  ///< those of static geometry first, in the order of its emitters
    const LightNode* light_nodes;  ///< null: no point and no area light
    const LeafLight* leaf_lights;  ///< leaf by leaf
    const std::uint64_t* light_trails;  ///< of the point lights, then of the area lights: the turns from the root to
                                        ///< its leaf, 1 for a second child, the first turn in the lowest bit
    const float* light_shares;  ///< of the same lights: probability in its leaf
    std::int32_t instance_count, key_count, point_count, area_count, light_node_count, leaf_light_count;
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
