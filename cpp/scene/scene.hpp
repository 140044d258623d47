#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

struct Texture {
    std::string name;  ///< file, for messages
    std::int32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  ///< empty: floats
    std::vector<float> linear_rgba;  ///< four for each texel
    TextureEncoding encoding = TextureEncoding::srgb;  ///< of the codes
};

/// A point light in scene coordinates, metres.
struct ScenePointLight {
    Vec3d position_m;
    Color intensity;  ///< cd; of a spot, on its axis
    /// The direction of a spot, a unit vector. (0, 0, 0): light leaves in all directions.
    Vec3d axis = {0, 0, 0};
    /// Angles of a spot from its axis: where it begins to fade, and where it ends. 0 <= inner <= outer <= pi / 2.
    double inner_cone_rad = 0, outer_cone_rad = 0;
};

struct Environment {
    Color constant = {0, 0, 0};  ///< cd/m^2
    std::int32_t width = 0, height = 0;
    std::vector<Color> pixels;  ///< empty: constant

    bool emits() const { return !pixels.empty() || !is_black(constant); }
};

/// A scene as the user gave it: one list of triangles in metres, double precision, right-handed, y up.
/// Read by Embree and CUDA backends through RenderSpaceScene.
struct Scene {
    std::vector<Vec3d> positions_m;
    std::vector<Vec3f> normals;  ///< empty, or one per position; (0, 0, 0): flat
    std::vector<Vec2f> uvs;      ///< empty, or one per position
    std::vector<Vec2f> second_uvs;  ///< the same, of textures that lie by others (TextureReference::uv_set)
    std::vector<VertexColor> colors;  ///< empty (white), or one per position
    std::vector<Triangle> triangles;
    std::vector<Material> materials;
    std::vector<std::string> material_names;  ///< as in the file; empty, or one for each material (empty: none)
    std::vector<Texture> textures;
    std::vector<ScenePointLight> points;
    std::vector<SunLight> suns;
    Environment environment;
    std::vector<std::string> warnings;  ///< what the reader put up with (a missing texture), for the caller to show

    bool has_light() const { return has_local_light() || !suns.empty() || environment.emits(); }

    /// A light that is somewhere: a point light or an emissive triangle.
    bool has_local_light() const;
};

}  // namespace REALCAM_NAMESPACE
