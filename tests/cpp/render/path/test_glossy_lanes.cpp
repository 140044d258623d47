// Paths in scenes of all materials: those that GlossyBsdf describes have vector code, others do not, and each lane of a
// block takes the path of a block of one.

#include "../followed_paths.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

/// The narrowest lobe here: directions are off by some 2^-22, which are 3e-6 of its width, and its density goes with
/// the fourth power of that. At each of six surfaces: 7e-5, and twice that for what is met a little beside.
constexpr float kWallRoughness = 0.3f, kLaneTolerance = 2e-4f;

Material rough_metal_wall() {
    Material m;
    m.model = MaterialModel::metallic_roughness;
    m.diffuse = {0.9f, 0.6f, 0.3f};
    m.metallic = 1;
    m.roughness = kWallRoughness;
    return m;
}
Material varnished_wall() {
    Material m;
    m.model = MaterialModel::metallic_roughness;
    m.diffuse = {0.2f, 0.7f, 0.4f};
    m.specular = {1, 0.8f, 0.6f};
    m.roughness = 0.5f;
    return m;
}
/// Half metal, and reflecting little as a dielectric.
Material mixed_wall() {
    Material m = varnished_wall();
    m.metallic = 0.5f;
    m.specular_weight = 0.3f;
    return m;
}
Material coated_wall() {
    Material m = varnished_wall();
    m.clearcoat = 0.8f;
    m.clearcoat_roughness = kWallRoughness;
    return m;
}
Material rough_glass_wall() {
    Material m = varnished_wall();
    m.transmission = 0.7f;
    m.absorption = {0.1f, 0.2f, 0.3f};
    return m;
}
Material mirror() {
    Material m;
    m.mirror = {0.5f, 0.6f, 0.7f};
    return m;
}
Material polished() {
    Material m = varnished_wall();
    m.roughness = 0;
    return m;
}
Material phong_wall() {
    Material m;
    m.specular = {0.3f, 0.3f, 0.3f};
    m.shininess = 40;
    return m;
}

struct Wall {
    const char* name;
    Material (*material)();
};

const Wall kWalls[] = {{"rough metal", rough_metal_wall},
                       {"varnished", varnished_wall},
                       {"mixed", mixed_wall},
                       {"coated", coated_wall},
                       {"glass", rough_glass_wall},
                       {"mirror", mirror},
                       {"polished", polished},
                       {"phong", phong_wall}};

/// A floor of rough metal, a wall, and a Lambertian plate before it; the lamp shines up, too.
Scene room(const Material& wall) {
    Scene scene = lamp_room();
    scene.materials.push_back(scene.materials[0]);
    scene.materials[0] = rough_metal_wall();
    scene.materials[1] = wall;
    scene.materials[2].emits_on_both_sides = 1;
    add_quad(scene, {-1, 0, -1}, {1, 0, -1}, {1, 1, -1}, {-1, 1, -1}, 3);
    return scene;
}

}  // namespace

TEST_CASE("in scenes of all materials each lane of a block takes the path of a block of one") {
    for (const AddedLight& light : kAddedLights)
        for (const Wall& wall : kWalls)
            for (const PathSettings& settings : kFollowedSettings) {
                CAPTURE(std::string(light.name));
                CAPTURE(std::string(wall.name));
                CAPTURE(settings.max_bounces);
                Scene scene = room(wall.material());
                light.add(scene);
                check_lanes<SceneKind::opaque>(Assembly(scene), settings, kLaneTolerance);
                scene.materials[3].only_shadows = 1;
                check_lanes<SceneKind::any>(Assembly(scene), settings, kLaneTolerance);
            }
}

TEST_CASE("smooth normals that turn away from the eye are the same in all lanes") {
    Scene scene = room(varnished_wall());
    scene.normals.resize(scene.positions_m.size(), {0.9f, 0.1f, 0.4f});
    for (Vec3f& n : scene.normals) n = normalized(n);
    check_lanes<SceneKind::opaque>(Assembly(scene), PathSettings{5}, kLaneTolerance);
}

TEST_CASE("a lane without a light holds a direction that tables can be read by, whatever was in memory") {
    constexpr int kLanes = 16;
    Scene scene = room(varnished_wall());
    scene.environment.constant = grey(1e-6f);  // too dim for a sample of its own
    const BothTraversals traversals{Assembly(scene)};
    const SceneView view = traversals.scene();
    SampleBlock<kLanes> block;
    PathState<kLanes> path;
    PathResults<kLanes> results;
    begin_all_around(0, block, path, results);
    path.count = 5;
    GlossySurfaces<kLanes> surfaces;
    for (int i = 0; i < kLanes; ++i) {
        SurfacePoint point{};
        point.normal = point.geometric_normal = {0, 1, 0};
        point.material = &view.materials[1];
        surfaces.set(i, point);
    }
    LightSamples<kLanes> samples;
    for (int i = 0; i < kLanes; ++i) samples.set(i, {{1e30f, 1e30f, 1e30f}, 1e30f, 1e30f, grey(1e30f), 1e30f});
    const LightKindsLanes<kLanes> kinds(view, SkySampling::apart, surfaces, path.count);
    const PathNumbers<kLanes> numbers(block, path, dimension::of_bounce(0) + dimension::light);
    sample_lights<SceneKind::opaque>(view, kinds, 1, surfaces, path, numbers, [](int) { return 1u; }, samples);
    for (int i = 0; i < whole_vectors<kLanes>(path.count); ++i) {
        CHECK(samples[i].direction.y == 1.0f);
        CHECK(is_black(samples[i].irradiance));
        CHECK(samples[i].pdf == kDelta);
    }
}
