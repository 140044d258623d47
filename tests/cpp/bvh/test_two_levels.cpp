// Instances of objects, against the same triangles in one mesh, transformed in double precision.
#if defined(REALCAM_HAS_BVH)

#include <cmath>
#include <vector>

#include "bvh/scene_bvh.hpp"
#include "bvh/traverse_scene.hpp"
#include "bvh_rays.hpp"
#include "doctest/doctest.h"
#include "refusal.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

/// Turns about two axes, scales each axis otherwise, and mirrors now and then.
Affine<double> drawn_place(BvhDraw& draw, float room) {
    Affine<double> map;
    map.x = static_cast<Vec3d>(draw.direction());
    map.y = normalized(cross(map.x, static_cast<Vec3d>(draw.direction())));
    map.z = (draw.below(2) ? 1.0 : -1.0) * cross(map.x, map.y);
    for (Vec3d* axis : {&map.x, &map.y, &map.z}) *axis = static_cast<double>(draw.within(0.3f, 2.0f)) * *axis;
    map.origin = static_cast<Vec3d>(draw.in_cube(room));
    return map;
}

Assembly drawn_assembly(BvhDraw& draw) {
    Assembly assembly(scene_of(soup(500, 20, 2, 8)));
    const std::shared_ptr<const Scene> objects[] = {scene_of(potato(12, 20, {1, 2, 3}, 1, 0.3f)),
                                                    scene_of(soup(40, 1, 1, 9)), scene_of(soup(1, 1, 1, 10))};
    for (unsigned i = 0; i < 60; ++i) assembly.instances.push_back({objects[i % 3], drawn_place(draw, 15), ""});
    return assembly;
}

/// All transformed triangles in one mesh, and the index of each instance's first triangle.
struct Baked {
    Mesh mesh;
    std::vector<std::uint32_t> first;

    Baked(const Assembly& assembly, Vec3d origin) {
        add(*assembly.static_geometry, {}, origin);
        for (const Instance& instance : assembly.instances) {
            first.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
            add(*instance.object, instance.scene_from_object, origin);
        }
    }
    std::uint32_t number(const Hit& hit) const {
        if (hit.triangle == kNoTriangle || hit.instance == kNoInstance) return hit.triangle;
        return first[hit.instance] + hit.triangle;
    }

private:
    void add(const Scene& scene, const Affine<double>& map, Vec3d origin) {
        for (const Triangle& t : scene.triangles) {
            Vec3f corner[3];
            for (int k = 0; k < 3; ++k)
                corner[k] = static_cast<Vec3f>(map.point(scene.positions_m[t.vertices[k]]) - origin);
            mesh.add(corner[0], corner[1], corner[2]);
        }
    }
};

struct OnHost {
    RenderSpaceScene placed;
    SceneBvh bvh;
    std::vector<BvhInstance> leaves;

    OnHost(const Assembly& assembly, Vec3d origin) : placed(assembly, origin), bvh(build_scene_bvh(placed)) { list(); }
    void move(const Assembly& assembly) {
        placed.move(assembly);
        refit_instances(bvh, placed);
        list();
    }
    SceneBvhView view() const { return {bvh.static_geometry.view(), bvh.instances.nodes.data(), leaves.data()}; }

private:
    void list() {
        std::vector<WideBvhView> objects;
        for (const WideBvh& object : bvh.objects) objects.push_back(object.view());
        leaves = bvh_instances(bvh, placed, objects);
    }
};

void hold_hits(const OnHost& two_levels, const Baked& baked, BvhDraw& draw) {
    const WideBvh one_level = baked.mesh.bvh();
    constexpr int kRays = 50000;
    int hits = 0, on_objects = 0, other = 0, shadows = 0;
    double worst = 0;
    for (int i = 0; i < kRays; ++i) {
        const Vec3f from = draw.in_cube(25);
        const Vec3f direction = draw.within(0.5f, 4.0f) * normalized(draw.in_cube(12) - from);
        const Hit expected = closest_hit(one_level.view(), from, direction, kFarAway);
        const Hit hit = closest_hit<true>(two_levels.view(), from, direction, kFarAway);
        const float far = draw.within(0.1f, 10.0f);
        shadows +=
            any_hit<true>(two_levels.view(), from, direction, far) != any_hit(one_level.view(), from, direction, far);
        if (baked.number(hit) != expected.triangle) {
            ++other;
            continue;
        }
        if (expected.triangle == kNoTriangle) {
            CHECK(hit.distance == kFarAway);
            continue;
        }
        ++hits;
        on_objects += hit.instance != kNoInstance;
        worst = std::max(worst, std::fabs(static_cast<double>(hit.distance) - static_cast<double>(expected.distance)));
    }
    CHECK(hits > kRays / 8);
    CHECK(on_objects > hits / 5);
    // Corners and rays of 40 m are right to some 2^-24 of it, 1e-5 m; seen along a surface, the distance changes by a
    // multiple of that, and rays beside an edge by 1e-5 of a size of 1 m go to the other side.
    CHECK(worst < 2e-2);
    CHECK(other < kRays / 2000);
    CHECK(shadows < kRays / 2000);
}

}  // namespace

TEST_CASE("two levels: the hits are those of the same triangles without objects") {
    BvhDraw draw(3);
    const Assembly assembly = drawn_assembly(draw);
    hold_hits(OnHost(assembly, {1, 2, 3}), Baked(assembly, {1, 2, 3}), draw);
}

TEST_CASE("two levels: objects that have moved are met where they are") {
    BvhDraw draw(4);
    Assembly assembly = drawn_assembly(draw);
    OnHost moving(assembly, {0, 0, 0});
    for (Instance& instance : assembly.instances) instance.scene_from_object = drawn_place(draw, 15);
    REQUIRE(moving.placed.can_move_to(assembly));
    moving.move(assembly);
    // All of them at once: what was near each other no longer is, and no box is as large as the room for long.
    CHECK(expected_nodes(moving.bvh.instances.nodes) <=
          2 * expected_nodes(OnHost(assembly, {0, 0, 0}).bvh.instances.nodes));
    hold_hits(moving, Baked(assembly, {0, 0, 0}), draw);
    assembly.instances.pop_back();
    CHECK_FALSE(moving.placed.can_move_to(assembly));
}

TEST_CASE("two levels: the hierarchy over objects is built anew only where it has become twice as dear") {
    BvhDraw draw(6);
    Assembly assembly = drawn_assembly(draw);
    OnHost moving(assembly, {0, 0, 0});
    const std::vector<std::uint32_t> order = moving.bvh.instances.order;
    assembly.instances[7].scene_from_object.origin += Vec3d{0.5, 0, 0};
    moving.move(assembly);
    CHECK(moving.bvh.instances.order == order);
    const double before = expected_nodes(moving.bvh.instances.nodes);
    for (std::size_t i = 0; i < assembly.instances.size(); ++i)
        assembly.instances[i].scene_from_object.origin = {i % 2 ? 1000.0 : -1000.0, static_cast<double>(i), 0};
    moving.move(assembly);
    CHECK(moving.bvh.instances.order != order);
    CHECK(expected_nodes(moving.bvh.instances.nodes) < 2 * before);
}

TEST_CASE("two levels: no ground, one object, no hit") {
    Assembly assembly{Scene{}};
    assembly.instances.push_back({scene_of(soup(20, 1, 1, 2)), {}, "alone"});
    const OnHost scene(assembly, {0, 0, 0});
    CHECK(closest_hit<true>(scene.view(), {5, 5, 5}, {1, 0, 0}, 7).distance == 7);
    CHECK(closest_hit<true>(scene.view(), {5, 5, 5}, {-1, -1, -1}, 7).instance == 0);
    CHECK_FALSE(any_hit<true>(scene.view(), {5, 5, 5}, {1, 0, 0}, kFarAway));
}

TEST_CASE("assembly: what cannot stand is refused") {
    Assembly assembly(scene_of(soup(2, 1, 1, 2)));
    assembly.instances.push_back({assembly.static_geometry, {}, "chair"});
    validate(assembly);
    Affine<double>& map = assembly.instances[0].scene_from_object;
    const auto refused = [&] { return message_of([&] { validate(assembly); }); };
    map.z = {1, 0, 0};
    CHECK(contains(refused(), "instance 0 (\"chair\")"));
    CHECK(contains(refused(), "flat"));
    map.z = {0, 0, std::nan("")};
    CHECK(contains(refused(), "finite"));
    map.z = {0, 0, 1e-9};
    CHECK(contains(refused(), "1e-6"));
    map.z = {0, 0, 1};
    map.origin.x = 1e13;
    CHECK(contains(refused(), "1e12 m"));
    CHECK(contains(message_of([] { validate(Assembly{Scene{}}); }), "empty"));
}

TEST_CASE("affine: a map, its inverse and its normals") {
    BvhDraw draw(5);
    for (int i = 0; i < 100; ++i) {
        const Affine<double> map = drawn_place(draw, 10), other = drawn_place(draw, 10);
        const InverseAffine<double> inverse = map.inverse();
        const Vec3d p = static_cast<Vec3d>(draw.in_cube(3)), u = static_cast<Vec3d>(draw.direction()),
                    v = static_cast<Vec3d>(draw.direction());
        CHECK(length(inverse.point(map.point(p)) - p) < 1e-12);
        CHECK(length((map * other).point(p) - map.point(other.point(p))) < 1e-12);
        const Vec3d n = cross(u, v), placed = inverse.normal_of(n);
        CHECK(std::fabs(dot(placed, map.direction(u))) < 1e-12);
        CHECK(std::fabs(dot(placed, map.direction(v))) < 1e-12);
        // Covectors: what lies on the normal's side still does, also in a mirror.
        const Vec3d w = static_cast<Vec3d>(draw.direction());
        CHECK(dot(placed, map.direction(w)) == doctest::Approx(dot(n, w)).epsilon(1e-9));
        CHECK(dot(normalized(map.normal(n)), normalized(placed)) == doctest::Approx(1).epsilon(1e-12));
    }
}

#endif
