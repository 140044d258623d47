#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "air.hpp"
#include "deformation.hpp"
#include "scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// Texture image, row by row from the top: 8-bit codes in `rgba` or floats in `linear_rgba`; the other one is empty.
struct Texture {
    std::string name;  ///< file name, for messages
    std::int32_t width = 0, height = 0;  ///< in texels
    std::vector<std::uint8_t> rgba;  ///< four codes for each texel; empty: linear_rgba holds the texels
    std::vector<float> linear_rgba;  ///< four floats for each texel
    TextureEncoding encoding = TextureEncoding::srgb;  ///< of `rgba`
};

/// A point light in scene coordinates, metres.
struct ScenePointLight {
    Vec3d position_m;
    Color intensity;  ///< in cd; for a spot, on its axis
    /// Direction of a spot, a unit vector; (0, 0, 0): the light radiates in all directions.
    Vec3d axis = {0, 0, 0};
    /// Angles from a spot's axis at which the falloff begins and ends: 0 <= inner <= outer <= pi / 2.
    double inner_cone_rad = 0, outer_cone_rad = 0;
};

/// Light from infinity: the same radiance from all directions, or a latitude-longitude map (row 0 is +y, the middle
/// column -z).
struct Environment {
    Color constant = {0, 0, 0};  ///< radiance in cd/m^2, used if there are no pixels
    std::int32_t width = 0, height = 0;  ///< of the map, in pixels
    std::vector<Color> pixels;  ///< radiance in cd/m^2, row by row; empty: the environment is constant

    bool emits() const { return !pixels.empty() || !is_black(constant); }
};

/// Scene as specified by the user: one list of triangles in metres, double precision, right-handed, y up. Embree and
/// CUDA backends read it through RenderSpaceScene.
struct Scene {
    std::vector<Vec3d> positions_m;
    std::vector<Vec3f> normals;  ///< empty, or one per position; (0, 0, 0): flat shading
    std::vector<Vec2f> uvs;      ///< empty, or one per position
    /// Second set, for textures with TextureReference::uv_set 1; empty, or one per position.
    std::vector<Vec2f> second_uvs;
    std::vector<VertexColor> colors;  ///< empty (white), or one per position
    std::vector<Triangle> triangles;
    std::vector<Material> materials;
    /// From the file; empty, or one for each material, which is empty for a material without a name.
    std::vector<std::string> material_names;
    std::vector<Texture> textures;
    std::vector<ScenePointLight> points;
    std::vector<SunLight> suns;
    Environment environment;
    Air air;
    /// Null if the shape is constant; otherwise positions and normals are those at time 0. Only objects may deform.
    std::shared_ptr<const Deformation> deformation = nullptr;
    /// Problems that the reader tolerated, such as a missing texture, for the caller to show.
    std::vector<std::string> warnings;

    /// True if anything emits light: a point light, an emissive triangle, a sun or the environment.
    bool has_light() const { return has_local_light() || !suns.empty() || environment.emits(); }

    /// True if the scene has a light at a finite position: a point light or an emissive triangle.
    bool has_local_light() const;
};

/// Returns a unique name for each material: that of the file, "material 3" for one without a name, "wood.2" for the
/// second "wood".
std::vector<std::string> material_names(const Scene& scene);

/// Change of an environment before rendering.
struct EnvironmentChange {
    double scale = 1;  ///< factor of its radiance
    double rotation_deg = 0;  ///< about +y, the vertical, counterclockwise seen from above: 90 degrees take -z to -x

    bool says_nothing() const { return scale == 1 && rotation_deg == 0; }
};

/// Throws InputError if the scale is not a positive number or the rotation not finite.
void check_environment_change(const EnvironmentChange& change);

/// Returns the scaled and rotated environment. A rotation by a fraction of a column interpolates linearly between
/// neighbours, which preserves the total light.
Environment changed(Environment environment, const EnvironmentChange& change);

}  // namespace REALCAM_NAMESPACE
