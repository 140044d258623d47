// Motion during an exposure: interpolation against closed forms, both traversals against each other and against a
// static scene at the same time, and moving lights.
#if defined(REALCAM_HAS_BVH)

#include <cmath>

#include "both_traversals.hpp"
#include "bvh_rays.hpp"
#include "camera/film/camera.hpp"
#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "math/motion.hpp"
#include "scene/lights/light.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

Affine<double> turn_about(Vec3d axis, double angle) {
    return rotation({std::sin(angle / 2) * normalized(axis), std::cos(angle / 2)});
}

double distance(const Affine<double>& a, const Affine<double>& b) {
    return length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z) + length(a.origin - b.origin);
}

Affine<double> drawn_map(BvhDraw& draw, bool mirrors) {
    Affine<double> map = turn_about(static_cast<Vec3d>(draw.direction()), static_cast<double>(draw.within(0, 6)));
    for (Vec3d* axis : {&map.x, &map.y, &map.z}) *axis = static_cast<double>(draw.within(0.2f, 3.0f)) * *axis;
    map = turn_about(static_cast<Vec3d>(draw.direction()), static_cast<double>(draw.within(0, 6))) * map;
    if (mirrors) map.z = -map.z;
    map.origin = static_cast<Vec3d>(draw.in_cube(10));
    return map;
}

/// Instances that go, turn and stretch within the first second.
Assembly moving_assembly(BvhDraw& draw) {
    Assembly assembly(scene_of(soup(300, 20, 2, 8)));
    const std::shared_ptr<const Scene> objects[] = {scene_of(potato(12, 20, {1, 2, 3}, 1, 0.3f)),
                                                    scene_of(soup(40, 1, 1, 9))};
    for (unsigned i = 0; i < 40; ++i) {
        const bool mirrors = draw.below(4) == 0;
        Affine<double> begin = drawn_map(draw, mirrors), end = drawn_map(draw, mirrors);
        end.origin = begin.origin + static_cast<Vec3d>(draw.in_cube(2));
        assembly.instances.push_back({objects[i % 2], begin, ""});
        if (i % 3 != 0) assembly.instances.back().set_transform(Motion{{0, 1}, {begin, end}});
    }
    return assembly;
}

}  // namespace

TEST_CASE("motion: a map is its rotation after its stretch, and maps between two turn evenly") {
    BvhDraw draw(1);
    for (int i = 0; i < 300; ++i) {
        const bool mirrors = i % 2 == 0;
        const Affine<double> map = drawn_map(draw, mirrors);
        const PolarDecomposition polar = polar_decomposition(map);
        const Affine<double>& s = polar.stretch;
        Affine<double> back = rotation(polar.rotation) * s;
        back.origin = map.origin;
        CHECK(distance(back, map) < 1e-13);
        CHECK(std::fabs(s.x.y - s.y.x) + std::fabs(s.x.z - s.z.x) + std::fabs(s.y.z - s.z.y) < 1e-13);

        const Vec3d axis = static_cast<Vec3d>(draw.direction());
        const double angle = static_cast<double>(draw.within(0, 3.14f));
        Affine<double> turned = turn_about(axis, angle) * map;
        const double share = static_cast<double>(draw.within(0, 1));
        // A turn after any map turns evenly, too: of R S it is R that turns.
        Affine<double> expected = turn_about(axis, share * angle) * map;
        turned.origin = map.origin;
        expected.origin = map.origin;
        CHECK(distance(interpolated(map, turned, share), expected) < 1e-12);
        CHECK(distance(interpolated(map, turned, 0), map) < 1e-13);
        CHECK(distance(interpolated(map, turned, 1), turned) < 1e-12);
    }
    // An arc cosine would make 1e-9 nothing.
    const Affine<double> half = interpolated({}, turn_about({0, 0, 1}, 1e-8), 0.5);
    CHECK(std::fabs(half.x.y - 0.5e-8) < 1e-16);
}

TEST_CASE("motion: keys for kernels are as many as a thousandth of the way wants") {
    const Vec3d points[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
    Affine<double> there;
    there.origin = {3, 0, 0};
    CHECK(key_steps({{0, 1}, {{}, there}}, {0, 1}, points) == 1);
    CHECK(key_steps({{0, 1}, {{}, there}}, {2, 3}, points) == 0);
    // An arc of 1 radian in steps of d radians: the error is d^2 / 8 for a distance of 2 sin 0.5, hence d = 0.0876.
    CHECK(key_steps({{0, 1}, {{}, turn_about({0, 0, 1}, 1)}}, {0, 1}, points) == 16);
    // A bend at 1/3, next to which the path is cut by 1/3 of a step: 2/9 of a step's length with 128 steps.
    CHECK(key_steps({{0, 1.0 / 3, 1}, {{}, there, {}}}, {0, 1}, points).value_or(0) == kMaxKeySteps);
    Motion fast;
    for (int k = 0; k < 200; ++k) {
        fast.times_s.push_back(k);
        fast.transforms.push_back(turn_about({0, 0, 1}, 2.5 * k));
    }
    CHECK_FALSE(key_steps(fast, {0, 199}, points).has_value());
    CHECK(key_steps(fast, {0, 2}, points).has_value());
}

TEST_CASE("motion: both traversals meet the same, and what stands there at the time") {
    BvhDraw draw(2);
    const Assembly assembly = moving_assembly(draw);
    const BothTraversals both(assembly, {0, 1});
    const SceneView scene = both.scene();
    REQUIRE(scene.kind == SceneKind::any);
    auto packets = both.packets();
    for (const double time : {0.0, 0.37, 1.0}) {
        CAPTURE(time);
        const BothTraversals standing(frozen_at(assembly, time));
        constexpr int kLanes = 64, kBlocks = 300;
        int hits = 0, on_moving = 0, differ = 0, stands_elsewhere = 0, wrong_shadows = 0;
        double worst_normal = 0, worst_place = 0;
        for (int block = 0; block < kBlocks; ++block) {
            const auto rays = drawn_rays<kLanes>(draw, static_cast<float>(time), [](int) { return 2u; });
            Hits<kLanes> found;
            std::int32_t hidden[kLanes];
            packets.intersect(rays, found);
            packets.occluded(rays, hidden);
            for (int i = 0; i < kLanes; ++i) {
                const Vec3f from = rays.origin[i], to = rays.direction[i];
                const AnySceneRay scene_ray{scene, 2, rays.time[i]};
                const Hit hit = closest_hit<true>(both.bvh(), from, to, kFarAway, scene_ray);
                const Hit still = closest_hit<true>(standing.bvh(), from, to, kFarAway);
                differ += hit.triangle != found.triangle[i] || hit.instance != found.instance[i];
                wrong_shadows +=
                    any_hit<true>(both.bvh(), from, to, kFarAway, scene_ray) != (hit.triangle != kNoTriangle);
                wrong_shadows += (hidden[i] != 0) != (found.triangle[i] != kNoTriangle);
                if (hit.triangle != still.triangle || hit.instance != still.instance) {
                    ++stands_elsewhere;
                    continue;
                }
                if (hit.triangle == kNoTriangle) continue;
                ++hits;
                on_moving += hit.instance != kNoInstance && scene.instances[hit.instance].key_count > 0;
                const auto a = surface_point<SceneKind::any>(scene, hit, from, to, rays.time[i]);
                const auto b = surface_point<SceneKind::any>(standing.scene(), still, from, to, 0);
                worst_normal = std::max(worst_normal, static_cast<double>(length(a.normal - b.normal)));
                const Vec3f off = a.position - b.position;
                worst_place = std::max(worst_place, std::fabs(static_cast<double>(dot(off, b.geometric_normal))));
            }
        }
        CHECK(hits > 3000);
        CHECK(on_moving > 1000);
        CHECK(differ <= 5);
        CHECK(wrong_shadows <= 1);
        // Between keys, positions are off by up to 1/1000 of distances of some 7 m (bodies of 2 m that turn by up to
        // half a circle and stretch 3-fold); at keys, by rounding only.
        const bool at_key = time == 0 || time == 1;
        CHECK(stands_elsewhere < (at_key ? 10 : 300));
        CHECK(worst_place < (at_key ? 1e-4 : 2e-2));
        CHECK(worst_normal < (at_key ? 1e-3 : 0.1));
    }
}

TEST_CASE("motion: lamps shine from where they are") {
    BvhDraw draw(3);
    Material lamp;
    lamp.emission = {30, 20, 10};
    Scene object = *scene_of(soup(3, 1, 1, 5), lamp);
    object.points.push_back({{0.2, 0.3, 0.4}, {100, 100, 100}, {0, 1, 0}, 0.1, 0.7});
    const auto shared = std::make_shared<const Scene>(object);
    Assembly assembly(scene_of(soup(10, 5, 1, 6)));
    Affine<double> begin = drawn_map(draw, false), end = drawn_map(draw, false);
    // The same turn and an even stretch: between keys every corner goes along a line.
    end = {2.0 * begin.x, 2.0 * begin.y, 2.0 * begin.z, end.origin};
    assembly.instances.push_back({shared, begin, ""});
    assembly.instances.back().set_transform(Motion{{0, 1}, {begin, end}});
    const RenderSpaceScene moving(assembly, {0, 0, 0}, {0, 1});
    const SceneView view = moving.view();
    REQUIRE(view.area_count == 3);
    REQUIRE(view.point_count == 1);
    for (const float time : {0.0f, 0.3f, 1.0f}) {
        CAPTURE(time);
        const RenderSpaceScene standing(frozen_at(assembly, static_cast<double>(time)), {0, 0, 0});
        const SceneView still = standing.view();
        for (int i = 0; i < 200; ++i) {
            const LightReceiver receiver = {draw.in_cube(20), draw.direction(), time};
            const Vec2f u = {draw.within(0, 1), draw.within(0, 1)};
            const LightSample point = sample_point_light(point_light_at(view, view.points[0], time), receiver.position),
                              point_still = sample_point_light(still.points[0], receiver.position);
            CHECK(length(point.direction - point_still.direction) < 1e-5f);
            CHECK(point.irradiance.r == doctest::Approx(point_still.irradiance.r).epsilon(1e-4));
            for (int a = 0; a < 3; ++a) {
                const auto light = sample_area_light<SceneKind::any>(view, area_light_at(view, view.areas[a], time),
                                                                     receiver.position, u);
                const auto expected = sample_area_light<SceneKind::any>(still, still.areas[a], receiver.position, u);
                CHECK(length(light.direction - expected.direction) < 1e-5f);
                // Near an edge-on lamp the cosine has few digits.
                CHECK(light.irradiance.g == doctest::Approx(expected.irradiance.g).epsilon(1e-3));
                CHECK((light.pdf == expected.pdf || light.pdf == doctest::Approx(expected.pdf).epsilon(1e-3)));
            }
            // No choice is left out, and the chances of all are 1.
            float sum = 0;
            for (std::int32_t light = 0; light < 4; ++light) sum += light_probability(view, receiver, light);
            CHECK(sum == doctest::Approx(1).epsilon(1e-5));
        }
    }
}

#endif
