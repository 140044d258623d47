// Ctrl-C while a scene is made ready: everything whose time grows with the scene looks up in between.

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "bvh/build_wide_bvh.hpp"
#include "scene/render_space/render_space_scene.hpp"
#include "scene/scene_checks.hpp"

using namespace realcam;

namespace {

/// A carpet of a million triangles: preparing it takes several times the 20 ms between two calls of KeepGoing.
Scene carpet() {
    Scene scene;
    constexpr std::uint32_t kCount = 1'000'000;
    for (std::uint32_t i = 0; i < kCount + 2; ++i) scene.positions_m.push_back({0.001 * i, i % 2 == 0 ? 0.0 : 1.0, -5});
    for (std::uint32_t i = 0; i < kCount; ++i) scene.triangles.push_back({{i, i + 1, i + 2}, 0});
    scene.materials = {Material{}};
    return scene;
}

const KeepGoing no = [] { return false; };

}  // namespace

TEST_CASE("a scene of a million triangles: checks, preparation and hierarchy can be stopped") {
    const Scene scene = carpet();
    Checkpoint checkpoint(no);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // a fast machine has looked through it within 20
    CHECK_THROWS_AS(validate(scene, {}, false, checkpoint), Cancelled);
    CHECK_THROWS_AS(RenderSpaceScene(Assembly(scene), {0, 0, 0}, {}, no), Cancelled);
    const RenderSpaceScene placed(Assembly(scene), {0, 0, 0});
    CHECK_THROWS_AS(build_wide_bvh(placed.static_geometry().positions(), placed.static_geometry().triangles(), no),
                    Cancelled);
}

TEST_CASE("a million emitters and a large environment can be stopped") {
    Scene scene = carpet();
    scene.materials[0].emission = {1, 1, 1};
    const RenderSpaceScene placed(Assembly(scene), {0, 0, 0});
    const InstancesView lights = placed.instances_view();
    std::vector<LightLeaf> leaves;
    for (std::int32_t i = 0; i < lights.area_count; ++i) leaves.push_back(LightTree::leaf(lights.areas[i], 1));
    Checkpoint checkpoint(no);
    CHECK_THROWS_AS(LightTree(leaves, checkpoint), Cancelled);

    Environment sky;
    sky.width = 4096;
    sky.height = 2048;
    sky.pixels.assign(std::size_t{4096} * 2048, {1, 1, 1});
    Checkpoint other(no);
    CHECK_THROWS_AS(environment_tables(sky, other), Cancelled);
}
