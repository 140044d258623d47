#pragma once
#include <cstdint>

#include "../math/affine.hpp"
#include "material.hpp"

namespace REALCAM_NAMESPACE {

// Scene as kernels see it: plain data and pointers. Positions are float and relative to an origin near the camera
// (RenderSpaceScene). Light is photometric, per channel of linear Rec. 709: radiance in cd/m^2, intensity in cd,
// illuminance in lux.

/// Triangle of a mesh.
struct Triangle {
    std::uint32_t vertices[3];  ///< indices of its corners
    std::uint32_t material;  ///< index of its material
};

/// Plane of a triangle, computed from double-precision positions: the float corners of a sliver define no normal, and
/// those of a large triangle no accurate point on it.
struct TrianglePlane {
    Vec3f normal;  ///< unit, by the right-hand rule from the winding
    float height;  ///< dot(normal, p) for points p on the plane
    float margin;  ///< bound on the distance from the plane to the float triangle and to computed hit points
};

/// TrianglePlane::margin over the largest coordinate of the corners: 25 rounding errors of float (2^-24 each). Corners
/// and interpolated points have errors of up to two roundings each along the normal. Traversal works relative to the
/// ray's origin, with coordinates up to twice as large, and adds about ten roundings of these.
inline constexpr float kMarginShare = 1.5e-6f;

/// Transfer function of a texture's values.
enum class TextureEncoding : std::int32_t { srgb, linear };

/// Texture of 8-bit codes or floats. Row 0 is at the top, texture coordinate v points up; it repeats outside 0..1.
struct TextureView {
    const std::uint8_t* rgba;  ///< four codes for each texel; null: linear_rgba holds the texels
    const float* linear_rgba;  ///< four floats for each texel
    std::int32_t width, height;
    TextureEncoding encoding;  ///< transfer function of `rgba`
    /// Mipmap levels 1 and up, concatenated (texture_levels.hpp). Width and height of each are half those of the
    /// previous level, rounded down, at least 1.
    const std::uint8_t* coarse_rgba = nullptr;
    const float* coarse_linear_rgba = nullptr;
    std::int32_t coarse_levels = 0;  ///< number of these levels
};

/// Point light or spot: intensity times clamp(cos_scale c + cos_offset, 0, 1)^2, where c is the cosine of the angle to
/// the axis (KHR_lights_punctual). The default values radiate equally in all directions.
struct PointLight {
    Vec3f position;
    Color intensity;  ///< cd; for a spot, on its axis
    Vec3f axis = {0, 0, 1};  ///< direction of a spot, unit
    float cos_scale = 0, cos_offset = 1;
    /// Instance in whose object frame position and axis are given; negative: fixed, in render space.
    std::int32_t moves_with = -1;
};

/// A light at infinity: parallel rays.
struct SunLight {
    Vec3f direction;  ///< direction of propagation, unit
    Color illuminance;  ///< at perpendicular incidence
};

/// A triangle that emits light.
struct AreaLight {
    /// First corner, and edges from it to the second and third; for a moving light: at shutter open (area_light_at).
    Vec3f corner, edge_u, edge_v;
    Vec3f normal;  ///< unit, on the emitting side
    std::int32_t is_two_sided;  ///< not 0: emits on both sides
    Color radiance;
    float area;  ///< square metres
    float margin;  ///< see TrianglePlane
    std::uint32_t triangle, instance;  ///< indices that a hit on it has (see Hit)
};

/// Environment light at infinity: constant, or a latitude-longitude image (row 0 is +y, the middle column -z).
struct EnvironmentView {
    Color constant;
    const Color* pixels;  ///< null: the environment is constant
    const float* marginal_cdf;  ///< height + 1 values, for importance sampling (math/cdf.hpp)
    const float* conditional_cdf;  ///< `height` rows of width + 1 values
    std::int32_t width, height;
    float mean_luminance;  ///< cd/m^2, over all directions
};

/// LightNode::cos_spread of lights that radiate equally in all directions.
inline constexpr float kIsotropic = 2;

/// Node of a light tree over all point and area lights, for choosing one by its contribution to a point (Conty Estevez
/// and Kulla 2018). The first child follows its parent. A leaf holds one light, or the triangles of one flat lamp.
struct alignas(16) LightNode {
    Vec3f middle;  ///< centre of the bounding box of the lights
    float squared_radius;  ///< squared radius of the bounding sphere of that box
    Vec3f axis;  ///< axis of the cone of the area lights' normals
    /// Cosine of the half angle of the cone that holds all normals; -1: all directions; or kIsotropic.
    float cos_spread;
    float intensity;  ///< sum of the luminous intensities along the normals, cd
    /// Index of the second child; negative for a leaf, whose first light is -1 - second_child.
    std::int32_t second_child;
    /// For a leaf of two lights: index of the second; of one light: -1; of more lights, which is slower on a GPU: below
    /// -1, and all lights of the leaf, the first included, are listed from index -2 - partner on in leaf_lights.
    std::int32_t partner;
    float first_probability;  ///< for a leaf: probability of its first light
};

/// Light of a leaf with more than two lights; the lights of a leaf are contiguous in InstancesView::leaf_lights.
struct LeafLight {
    std::int32_t light;  ///< index among the point lights, then the area lights; -1 terminates the list
    float below;  ///< cumulative probability of the preceding lights of the leaf
};

/// Vertex colour: multiplies the diffuse colour of a surface and, if its material says so, emission and opacity;
/// interpolated over triangles.
struct VertexColor {
    Color color = {1, 1, 1};  ///< linear
    float alpha = 1;

    constexpr bool operator==(const VertexColor&) const = default;
};

/// Medium that fills a box, except for the interiors of glass (Air). A black extinction stands for clear air.
struct AirView : Medium {
    Vec3f low = {0, 0, 0}, high = {0, 0, 0};  ///< corners of the box; -kFarAway and kFarAway: unlimited

    REALCAM_INLINE bool is_present() const { return !is_black(extinction); }
};

// Every array of the following structs must also be listed in scene_arrays.hpp.

/// Triangle mesh with its materials and textures.
struct MeshView {
    const Triangle* triangles;
    const TrianglePlane* planes;  ///< one for each triangle
    const Vec3f* positions;  ///< per vertex
    const Vec3f* normals;  ///< per vertex, zero for flat shading; null: all flat
    const Vec2f *uvs, *second_uvs;  ///< per vertex; null: no texture coordinates
    const VertexColor* colors;  ///< per vertex; null: white
    const Material* materials;
    const TextureView* textures;
    const std::uint32_t* emitters;  ///< indices of the triangles that emit light, ascending
    std::int32_t triangle_count, vertex_count, material_count, texture_count, emitter_count;
};

/// Instance of an object. If it moves, the transforms are those at shutter open (instance_at).
struct InstanceView {
    Affine<float> render_from_object;
    InverseAffine<float> object_from_render;
    /// Bound on the error of a transformed point along each of the object's axes, in object units, per unit of the
    /// point's largest render-space coordinate (instance_margin).
    Vec3f margin;
    /// Upper limit, in render space, of the error that the rounding of the object's own coordinates contributes.
    float max_object_margin;
    std::uint32_t object;  ///< index in SceneView::objects
    std::int32_t first_area;  ///< index of the area light of the object's first emitter
    std::int32_t first_key, key_count;  ///< keys of its motion in InstancesView::keys; a count of 0: it does not move
};

/// Part of a scene that depends on instance transforms: the instances, the lights that move with them, the scene kind,
/// which tells whether anything moves, and the air, whose box encloses the instances.
struct InstancesView {
    SceneKind kind;
    const InstanceView* instances;
    const Affine<float>* keys;  ///< render_from_object of moving instances, at equally spaced times of the exposure
    const PointLight* points;
    const AreaLight* areas;  ///< static geometry's lights first, in the order of its emitters
    const LightNode* light_nodes;  ///< null: there is no point or area light
    const LeafLight* leaf_lights;  ///< lights of the leaves with more than two lights, leaf by leaf
    /// For point lights, then area lights: the path from the root to the light's leaf, one bit per step, 1 for a second
    /// child, first step in the lowest bit.
    const std::uint64_t* light_trails;
    const float* leaf_probabilities;  ///< for the same lights: probability of the light within its leaf
    std::int32_t instance_count, key_count, point_count, area_count, light_node_count, leaf_light_count;
    AirView air;
    bool has_scattering_media;  ///< true if there is air, or any material has an interior that scatters light
};

/// Complete scene: static geometry, objects in frames of their own, and lights.
struct SceneView : MeshView, InstancesView {
    const MeshView* objects;
    const SunLight* suns;
    std::int32_t object_count, sun_count;
    bool has_environment;
    EnvironmentView environment;
};

}  // namespace REALCAM_NAMESPACE
