#pragma once
#include <cstdint>

#include "../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

// What kernels see of a scene: plain data and pointers. Positions are float and relative to an origin near the camera
// (PlacedScene); light is photometric and per colour channel (linear Rec. 709): radiance in cd/m^2, intensity in cd,
// illuminance in lux.

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

/// A triangle that shines, with the probability that it is chosen among all of them.
struct AreaLight {
    Vec3f corner, edge_u, edge_v;
    Vec3f normal;  ///< unit; light leaves on this side
    Vec3f radiance;
    float area;
    float probability;
};

/// Light from infinity all around: constant, or a latitude-longitude image (row 0 up, +y; the middle column -z).
struct EnvironmentView {
    Vec3f constant;
    const Vec3f* pixels;          ///< null: constant
    const float* marginal_cdf;    ///< height + 1 values, for importance sampling
    const float* conditional_cdf; ///< height rows of width + 1 values
    std::int32_t width, height;
};

struct SceneView {
    const Triangle* triangles;
    const Vec3f* positions;
    const Vec3f* normals;  ///< per vertex, unit, or zero where the triangle is flat; null: all flat
    const Vec2f* uvs;      ///< per vertex; null: none
    const Material* materials;
    const TextureView* textures;
    const PointLight* points;
    const SunLight* suns;
    const AreaLight* areas;
    const float* area_cdf;  ///< area_count + 1 values
    std::int32_t point_count, sun_count, area_count;
    bool has_environment;
    EnvironmentView environment;
};

}  // namespace REALCAM_NAMESPACE
