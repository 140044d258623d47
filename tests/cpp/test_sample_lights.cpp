// The choice of a light, and of a point on a shining triangle.

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../cpp/scene/light.hpp"
#include "../../cpp/scene/render_space_scene.hpp"
#include "bare_scene.hpp"
#include "chi_square.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kSamples = 1 << 18;

// A light's points in barycentric coordinates: 4 x 4 parts of the unit square, of which the triangle has the lower left
// half. The bins of all lights in one list.
struct OnLights {
    std::vector<double> expected, counts;

    explicit OnLights(const SceneView& view) {
        for (int i = 0; i < view.area_count; ++i) {
            const AreaLight& light = view.areas[i];
            const double area = 0.5 * length(cross(static_cast<Vec3d>(light.edge_u), static_cast<Vec3d>(light.edge_v)));
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < 4; ++b)
                    expected.push_back(static_cast<double>(light.density) * 2 * area * kSamples *
                                       integral([](double, double) { return 1.0; }, a / 4.0, (a + 1) / 4.0, b / 4.0,
                                                (b + 1) / 4.0, 1) *
                                       (a + b < 3    ? 1.0
                                        : a + b == 3 ? 0.5
                                                     : 0.0));
        }
        counts.resize(expected.size());
    }

    void add(int index, const AreaLight& light, Vec3d point) {
        const Vec3d u = static_cast<Vec3d>(light.edge_u), v = static_cast<Vec3d>(light.edge_v), n = cross(u, v);
        const Vec3d p = point - static_cast<Vec3d>(light.corner);
        const double s = dot(cross(p, v), n) / dot(n, n), t = dot(cross(u, p), n) / dot(n, n);
        // Rounding may take a point over the edge.
        const int a = std::clamp(static_cast<int>(std::floor(4 * s)), 0, 3);
        const int b = std::clamp(static_cast<int>(std::floor(4 * t)), 0, 3 - a);
        ++counts[static_cast<std::size_t>(16 * index + 4 * a + b)];
    }
};

struct Lamp {
    Vec3d a, b, c;
    float radiance;
};

Scene with_lamps(const std::vector<Lamp>& lamps) {
    Scene scene = bare_scene();
    for (const Lamp& lamp : lamps) {
        const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
        scene.positions_m.insert(scene.positions_m.end(), {lamp.a, lamp.b, lamp.c});
        scene.triangles.push_back({{first, first + 1, first + 2}, static_cast<std::uint32_t>(scene.materials.size())});
        Material material;
        material.emission = {lamp.radiance, lamp.radiance, lamp.radiance};
        scene.materials.push_back(material);
    }
    return scene;
}

// In the plane z = 0 and facing +z: a large, a small, one 1e8 times as bright, a sliver of 1e6 : 1.
const std::vector<Lamp> kLamps = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1},
                                  {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, 5},
                                  {{0, 0, 0}, {-0.5, 0, 0}, {0, -0.3, 0}, 1e8f},
                                  {{0, 0, 0}, {0.7, 0, 0}, {0.35, 7e-7, 0}, 20}};

}  // namespace

TEST_CASE("sample_area_light follows its density over every triangle") {
    ChiSquareTests tests("sample_area_light: triangles of 1e6 : 1 in size, 1e8 : 1 in light");
    std::vector<Lamp> many;
    Uniform place(8);
    for (int i = 0; i < 400; ++i) {
        const Vec3d at{static_cast<double>(place()) - 0.5, static_cast<double>(place()) - 0.5, 0};
        const double size = std::pow(10.0, -3.0 * static_cast<double>(place()));
        many.push_back({at, at + Vec3d{size, 0, 0}, at + Vec3d{0, 0.1 * size, 0}, i % 2 ? 1.0f : 100.0f});
    }
    const std::vector<std::vector<Lamp>> groups = {kLamps, many, {kLamps[3]}};
    unsigned seed = 1;
    for (const std::vector<Lamp>& group : groups) {
        const Scene scene = with_lamps(group);
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const SceneView view = placed.view();
        REQUIRE(view.area_count == static_cast<int>(group.size()));
        OnLights bins(view);
        Uniform uniform(seed++);
        for (int i = 0; i < kSamples; ++i) {
            const Vec2f u = uniform.pair();
            // Straight above the origin, so that x and y keep a sliver's width.
            const Vec3f from{0, 0, 0.5f};
            const LightSample sample = sample_area_light(view, from, u);
            const int index = find_in_cdf(view.area_cdf, view.area_count, u.x);
            const Vec3d point =
                static_cast<Vec3d>(from) + static_cast<double>(sample.distance) * static_cast<Vec3d>(sample.direction);
            bins.add(index, view.areas[index], point);
        }
        tests.add(bins.expected, bins.counts);
    }
    tests.hold();

    const Scene scene = with_lamps({kLamps[0]});
    const RenderSpaceScene placed(scene, {0, 0, 0});
    OnLights bins(placed.view());
    Uniform uniform(1);
    for (int i = 0; i < kSamples; ++i) {
        const Vec2f u = uniform.pair();
        bins.add(0, placed.view().areas[0], {static_cast<double>(u.x * (1 - u.y)), static_cast<double>(u.x * u.y), 0});
    }
    ChiSquareTests broken("sample_area_light without the square root");
    broken.add(bins.expected, bins.counts);
    broken.breaks();

    const Scene all = with_lamps(kLamps);
    const RenderSpaceScene lamps(all, {0, 0, 0});
    for (const Vec2f u : extreme_inputs())
        for (const Vec3f from : {Vec3f{0.2f, 0.2f, 1}, Vec3f{0, 0, 1e-6f}, Vec3f{0, 0, 0}, Vec3f{0.2f, 0.2f, -1}}) {
            const LightSample sample = sample_area_light(lamps.view(), from, u);
            CHECK((sample.irradiance.x >= 0 && std::isfinite(sample.irradiance.x)));
            CHECK(std::fabs(length(sample.direction) - 1) < 1e-6f);
            CHECK(!(sample.reach > 1));
            if (from.z <= 0) CHECK(sample.irradiance.x == 0);  // on the lights and behind them
        }
}

TEST_CASE("kinds of light are chosen alike, and what is left of the number is fresh") {
    ChiSquareTests tests("sample_light: the choice of a kind, and the number left over");
    unsigned seed = 1;
    for (const int kinds : {1, 2, 3, 7, 100}) {
        Bins bins(Bins::even(0, kinds, kinds), Bins::even(0, 1, 8));
        bins.expect([&](double kind, double) { return choose_light(kinds, static_cast<float>(kind / kinds)).pdf; },
                    kSamples, 1);
        Uniform uniform(seed++);
        for (int i = 0; i < kSamples; ++i) {
            const LightChoice choice = choose_light(kinds, uniform());
            bins.add(choice.kind + 0.5, static_cast<double>(choice.fresh));
        }
        tests.add(bins);
        for (const Vec2f u : extreme_inputs()) {
            const LightChoice choice = choose_light(kinds, u.x);
            CHECK((choice.kind >= 0 && choice.kind < kinds && choice.fresh >= 0 && choice.fresh < 1));
        }
    }

    // sample_light itself, told apart by colour: two points, a sun, a shining triangle, a sky.
    Scene scene = with_lamps({{{0, 2, 0}, {1, 2, 0}, {0, 2, 1}, 1}});
    scene.materials.back().emission = {0, 0, 5};
    scene.points = {{{0, 1, 0}, {1, 0, 0}}, {{0, 3, 0}, {0, 1, 0}}};
    scene.suns = {{{0, -1, 0}, {1, 1, 0}}};
    scene.environment.constant = {1, 0, 1};
    const RenderSpaceScene placed(scene, {0, 0, 0});
    REQUIRE(light_kinds(placed.view()) == 5);
    SurfacePoint point{};
    point.normal = point.geometric_normal = {0, 1, 0};
    std::vector<double> counts(8);
    Uniform uniform(99);
    for (int i = 0; i < kSamples; ++i) {
        const Vec3f e = sample_light(placed.view(), point, uniform.pair()).irradiance;
        ++counts[static_cast<std::size_t>((e.x > 0) + 2 * (e.y > 0) + 4 * (e.z > 0))];
    }
    const double each = kSamples / 5.0;
    tests.add({0, each, each, each, each, each, 0, 0}, counts);
    tests.hold();

    const Scene dark = bare_scene();
    const RenderSpaceScene nothing(dark, {0, 0, 0});
    CHECK(sample_light(nothing.view(), point, {0.5f, 0.5f}).irradiance.x == 0);
}
