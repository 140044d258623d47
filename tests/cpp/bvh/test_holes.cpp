// Rays at partially opaque surfaces: both traversals make the same decisions, at the rate given by the opacity.
#if defined(REALCAM_HAS_BVH)

#include <cmath>

#include "both_traversals.hpp"
#include "bvh_rays.hpp"
#include "doctest/doctest.h"

using namespace realcam;
using namespace realcam::test;

namespace {

Texture alpha_texture() {
    Texture texture;
    texture.width = texture.height = 2;
    texture.rgba = {0, 0, 0, 0, 0, 0, 0, 85, 0, 0, 0, 170, 0, 0, 0, 255};
    return texture;
}

/// Material 0 is opaque, 1 has an opacity of 0.4, 2 that of its texture, 3 is opaque where the texture is at least 1/2.
Scene holed(const Mesh& mesh) {
    Scene scene;
    for (const Vec3f p : mesh.positions) {
        scene.positions_m.push_back(static_cast<Vec3d>(p));
        scene.uvs.push_back({p.x, p.y});
    }
    scene.triangles = mesh.triangles;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) scene.triangles[i].material = i % 4;
    scene.materials.resize(4);
    scene.textures = {alpha_texture()};
    scene.materials[1].opacity = 0.4f;
    scene.materials[2].opacity_texture.texture = 0;
    scene.materials[3].opacity_texture.texture = 0;
    scene.materials[3].opacity_cutoff = 0.5f;
    return scene;
}

}  // namespace

TEST_CASE("opacity: factor, alpha channel between texels, cutoff") {
    Scene scene;
    scene.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.uvs = {{0, 0}, {1, 0}, {0, 1}};
    scene.triangles = {{{0, 1, 2}, 0}};
    scene.materials = {Material{}};
    scene.textures = {alpha_texture()};
    const auto opacity = [&](float u, float v) {
        const RenderSpaceScene placed(Assembly(scene), {0, 0, 0});
        const MeshView mesh = placed.view();
        return static_cast<double>(opacity_at(mesh, mesh.triangles[0], {1, 0, u, v}));
    };
    CHECK(opacity(0.25f, 0.25f) == 1.0);
    scene.materials[0].opacity = 0.5f;
    CHECK(opacity(0.25f, 0.25f) == 0.5);
    scene.materials[0].opacity_texture.texture = 0;
    // The middles of the texels, row 0 on top; then between them.
    CHECK(opacity(0.25f, 0.75f) == doctest::Approx(0));
    CHECK(opacity(0.75f, 0.75f) == doctest::Approx(0.5 / 3));
    CHECK(opacity(0.25f, 0.25f) == doctest::Approx(0.5 * 2 / 3));
    CHECK(opacity(0.75f, 0.25f) == doctest::Approx(0.5));
    CHECK(opacity(0.5f, 0.25f) == doctest::Approx(0.5 * 5 / 6));
    CHECK(opacity(0.5f, 0.5f) == doctest::Approx(0.25));
    scene.materials[0].opacity_cutoff = 0.3f;
    CHECK(opacity(0.25f, 0.25f) == 1.0);
    CHECK(opacity(0.5f, 0.5f) == 0.0);
}

TEST_CASE("holes: Embree's filter and the wide BVH stop a ray at the same triangle, by its number") {
    BvhDraw draw(71);
    Assembly assembly(holed(soup(400, 20, 4, 31)));
    const auto object = std::make_shared<const Scene>(holed(soup(30, 1, 1, 32)));
    for (int i = 0; i < 20; ++i) {
        Affine<double> place;
        place.origin = static_cast<Vec3d>(draw.in_cube(15));
        assembly.instances.push_back({object, place, ""});
    }
    for (const bool instanced : {false, true}) {
        CAPTURE(instanced);
        if (!instanced) assembly.instances.clear();
        const BothTraversals both(assembly);
        const SceneView scene = both.scene();
        const SceneBvhView view = both.bvh();
        REQUIRE(scene.kind == SceneKind::any);

        constexpr int kLanes = 64, kBlocks = 800;
        int differ = 0, hits = 0, through = 0, wrong_shadows = 0;
        auto packets = both.packets();
        for (int block = 0; block < kBlocks; ++block) {
            const auto rays = drawn_rays<kLanes>(
                draw, 0, [=](int i) { return hash32(static_cast<std::uint32_t>(block * kLanes + i)); });
            Hits<kLanes> found;
            std::int32_t hidden[kLanes];
            packets.intersect(rays, found);
            packets.occluded(rays, hidden);
            for (int i = 0; i < kLanes; ++i) {
                const AnySceneRay scene_ray{scene, rays.number[i], 0};
                const Vec3f from = rays.origin[i], to = rays.direction[i];
                const Hit hit = instanced ? closest_hit<true>(view, from, to, kFarAway, scene_ray)
                                          : closest_hit<false>(view, from, to, kFarAway, scene_ray);
                const bool any = instanced ? any_hit<true>(view, from, to, kFarAway, scene_ray)
                                           : any_hit<false>(view, from, to, kFarAway, scene_ray);
                const Hit solid = instanced ? closest_hit<true>(view, from, to, kFarAway)
                                            : closest_hit<false>(view, from, to, kFarAway);
                hits += hit.triangle != kNoTriangle;
                through += hit.triangle != solid.triangle;
                differ += hit.triangle != found.triangle[i] || hit.instance != found.instance[i];
                // A shadow ray is blocked exactly if the closest-hit query finds a hit, with both traversals.
                wrong_shadows += any != (hit.triangle != kNoTriangle);
                wrong_shadows += (hidden[i] != 0) != (found.triangle[i] != kNoTriangle);
            }
        }
        CHECK(hits > 5000);
        CHECK(through > 2000);
        CHECK(wrong_shadows == 0);
        // Barycentric coordinates of the two traversals differ by some 1e-6, and with them opacities, and where a ray
        // passes an edge or two triangles lie in one place: some 1e-5 of the rays.
        CHECK(differ <= 5);
    }
}

#endif
