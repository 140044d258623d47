// The choice of a light, and of a point on a shining triangle.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bare_scene.hpp"
#include "chi_square.hpp"
#include "render/path/light_choices.hpp"
#include "scene/lights/light.hpp"
#include "scene/render_space/render_space_scene.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kLampSamples = 1 << 18;

// Histogram of a light's points in barycentric coordinates: 4 x 4 cells of the unit square, whose lower left half is
// the triangle. Expected counts follow from pdf(distance, cosine), per steradian, at a point in front of the light.
struct OnLights {
    std::vector<double> expected, counts;

    template <class Pdf>
    OnLights(const AreaLight& light, Vec3f from, Pdf&& pdf) {
        const Vec3d u = static_cast<Vec3d>(light.edge_u), v = static_cast<Vec3d>(light.edge_v), n = cross(u, v),
                    corner = static_cast<Vec3d>(light.corner) - static_cast<Vec3d>(from);
        const auto per_share = [&](double s, double t) {
            const Vec3d way = corner + s * u + t * v;
            const double distance = length(way), cosine = -dot(way, n) / (distance * length(n));
            return static_cast<double>(pdf(static_cast<float>(distance), static_cast<float>(cosine))) * cosine /
                   (distance * distance) * length(n);
        };
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) {
                const auto in_part = [&](double x, double y) {
                    // In a cell that the long side cuts, only the part below it.
                    const double height = a + b == 3 ? 1 - x : 1;
                    return height * per_share((a + x) / 4, (b + height * y) / 4) / 16;
                };
                expected.push_back(a + b > 3 ? 0 : kLampSamples * integral(in_part, 0, 1, 0, 1, 8));
            }
        counts.resize(expected.size());
    }

    void add(const AreaLight& light, Vec3d point) {
        const Vec3d u = static_cast<Vec3d>(light.edge_u), v = static_cast<Vec3d>(light.edge_v), n = cross(u, v);
        const Vec3d p = point - static_cast<Vec3d>(light.corner);
        const double s = dot(cross(p, v), n) / dot(n, n), t = dot(cross(u, p), n) / dot(n, n);
        // Rounding may take a point over the edge.
        const int a = std::clamp(static_cast<int>(std::floor(4 * s)), 0, 3);
        const int b = std::clamp(static_cast<int>(std::floor(4 * t)), 0, 3 - a);
        ++counts[static_cast<std::size_t>(4 * a + b)];
    }
};

Scene with_lamps(const std::vector<Lamp>& lamps) {
    Scene scene = bare_scene();
    add_lamps(scene, lamps);
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
    int near_count = 0;
    for (const std::vector<Lamp>& group : groups) {
        const Scene scene = with_lamps(group);
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const SceneView view = placed.view();
        REQUIRE(view.area_count == static_cast<int>(group.size()));
        Uniform uniform(seed++);
        std::vector<std::pair<int, float>> views;  // of lights, from a height
        for (int k = 0; k < view.area_count; k += std::max(1, view.area_count / 8))
            for (const float height : {0.5f, 0.05f}) views.emplace_back(k, height);
        for (const auto& [k, height] : views) {
            const AreaLight& light = view.areas[k];
            // Straight above the origin, so that x and y keep a sliver's width.
            const Vec3f from{0, 0, height};
            near_count += is_near(light, from);
            OnLights by_area(light, from, [&](float distance, float cosine) {
                return area_light_pdf(light.area, distance * distance, cosine);
            });
            OnLights seen(light, from,
                          [&](float distance, float cosine) { return solid_angle_pdf(light, from, distance, cosine); });
            for (int i = 0; i < kLampSamples; ++i) {
                const Vec2f u = uniform.pair();
                const auto add = [&](const LightSample& sample, OnLights& bins) {
                    bins.add(light, static_cast<Vec3d>(from) +
                                        static_cast<double>(sample.distance) * static_cast<Vec3d>(sample.direction));
                };
                add(sample_area<SceneKind::plain>(view, light, from, u), by_area);
                add(sample_area_light<SceneKind::plain>(view, light, from, u), seen);
            }
            tests.add(by_area.expected, by_area.counts);
            tests.add(seen.expected, seen.counts);
        }
    }
    CHECK(near_count > 4);
    tests.hold();

    const Scene scene = with_lamps({kLamps[0]});
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const AreaLight& lamp = placed.view().areas[0];
    OnLights bins(lamp, {0, 0, 1},
                  [&](float distance, float cosine) { return area_light_pdf(lamp.area, distance * distance, cosine); });
    Uniform uniform(1);
    for (int i = 0; i < kLampSamples; ++i) {
        const Vec2f u = uniform.pair();
        bins.add(lamp, {static_cast<double>(u.x * (1 - u.y)), static_cast<double>(u.x * u.y), 0});
    }
    ChiSquareTests broken("sample_area_light without the square root");
    broken.add(bins.expected, bins.counts);
    broken.breaks();

    const Scene all = with_lamps(kLamps);
    const RenderSpaceScene lamps(all, {0, 0, 0});
    for (int k = 0; k < lamps.view().area_count; ++k)
        for (const Vec2f u : extreme_inputs())
            for (const Vec3f from : {Vec3f{0.2f, 0.2f, 1}, Vec3f{0, 0, 1e-6f}, Vec3f{0, 0, 0}, Vec3f{0.2f, 0.2f, -1}}) {
                const AreaLight& light = lamps.view().areas[k];
                const LightSample sample = sample_area_light<SceneKind::plain>(lamps.view(), light, from, u);
                CHECK((sample.irradiance.r >= 0 && std::isfinite(sample.irradiance.r)));
                CHECK(std::fabs(length(sample.direction) - 1) < 1e-6f);
                CHECK(!(sample.reach > 1));
                if (from.z <= 0) CHECK(sample.irradiance.r == 0);  // on the lights and behind them
                // Scattered rays that hit this point are weighted by solid_angle_pdf. It has the rounding of the cosine
                // if the light is not near.
                const float cosine = -dot(sample.direction, light.normal);
                if (sample.pdf < kDelta)
                    CHECK(solid_angle_pdf(light, from, sample.distance, cosine) ==
                          doctest::Approx(sample.pdf).epsilon(1e-5));
            }
}

TEST_CASE("the mean cosine of a cone is near its integral") {
    for (int t = 0; t <= 180; t += 4)
        for (int s = 2; s <= 180; s += 4) {
            CAPTURE(t);
            CAPTURE(s);
            const double theta = t * std::numbers::pi / 180, spread = s * std::numbers::pi / 180;
            constexpr int kSteps = 100;
            double sum = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double z = 1 + (i + 0.5) / kSteps * (std::cos(spread) - 1), r = std::sqrt(1 - z * z);
                for (int k = 0; k < kSteps; ++k)
                    sum += std::max(0.0, z * std::cos(theta) +
                                             r * std::cos((k + 0.5) / kSteps * std::numbers::pi) * std::sin(theta));
            }
            const double mean = sum / (kSteps * kSteps);
            const float found = mean_cosine(static_cast<float>(std::cos(theta)), static_cast<float>(std::cos(spread)));
            CHECK(static_cast<double>(found) == doctest::Approx(mean).scale(1).epsilon(0.03));
        }
}

TEST_CASE("a lamp's importance is its illuminance, and its bound above that") {
    // An octahedron from afar.
    std::vector<Lamp> faces;
    const Vec3d axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0}) {
                const Vec3d a = x * axes[0], b = y * axes[1], c = z * axes[2];
                faces.push_back(x * y * z > 0 ? Lamp{a, b, c, 1.0f} : Lamp{a, c, b, 1.0f});
            }
    const Scene scene = with_lamps(faces);
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const SceneView view = placed.view();
    Uniform uniform(5);
    for (int i = 0; i < 100; ++i) {
        const Vec3f direction = sample_sphere(uniform.pair());
        const LightReceiver receiver{30.0f * direction, sample_sphere(uniform.pair())};
        double illuminance = 0;
        for (int k = 0; k < view.area_count; ++k) {
            const AreaLight& face = view.areas[k];
            const Vec3f way = face.corner + (1.0f / 3.0f) * (face.edge_u + face.edge_v) - receiver.position;
            const float squared = dot(way, way), emitted = -dot(face.normal, way), received = dot(receiver.normal, way);
            if (emitted > 0 && received > 0)
                illuminance += static_cast<double>(luminance(face.radiance) * face.area * emitted * received) /
                               static_cast<double>(squared * squared);
        }
        const LightNode& all = view.light_nodes[0];
        // Treats the body as a ball, whose silhouette is a quarter of the area, sqrt(3). The body's own silhouettes are
        // from sqrt(2) to 2.
        const double of_ball = static_cast<double>(luminance(view.areas[0].radiance)) * std::sqrt(3.0) / 900;
        CHECK(std::fabs(static_cast<double>(light_importance(all, receiver)) - illuminance) < 0.22 * of_ball);
        CHECK(static_cast<double>(max_illuminance(all, receiver)) >= illuminance);
    }
}

TEST_CASE("a lamp's importance for a glossy surface is what the surface shows of it") {
    // Small lamps in the directions that the lobe shows and in others, each turned to the surface, at 10 m.
    constexpr double kSide = 0.02;
    const Vec3f to_eye = normalized(Vec3f{0.8f, 0, 0.6f}), normal{0, 0, 1};
    for (const float alpha : {0.1f, 0.3f})
        for (int i = 0; i < 60; ++i) {
            const double elevation = (5 + 80 * (i % 10) / 9.0) * std::numbers::pi / 180, azimuth = 0.6 * (i / 10);
            const Vec3d way{-std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                            std::sin(elevation)};
            const Vec3d u = normalized(cross(way, Vec3d{0, 0, 1})), v = cross(way, u), at = 10.0 * way;
            const Scene scene = with_lamps({{at, at + kSide * v, at + kSide * u, 1.0f}});
            const RenderSpaceScene placed(scene, {0, 0, 0});
            const SceneView view = placed.view();
            REQUIRE(view.area_count == 1);
            // Walter et al. 2007, without Fresnel's term and shadowing, over the diffuse surface's cosine / pi.
            const Vec3d eye = static_cast<Vec3d>(to_eye), h = normalized(eye + way);
            const double a2 = static_cast<double>(alpha * alpha), k = h.z * h.z * (a2 - 1) + 1;
            const double lobe = a2 / (k * k * 4 * eye.z);
            const LightReceiver diffuse{{0, 0, 0}, normal}, glossy{{0, 0, 0}, normal, 0, {to_eye, alpha, 1}};
            const auto importance = [&](const LightReceiver& r) {
                return static_cast<double>(light_importance(view.light_nodes[0], r));
            };
            CAPTURE(elevation);
            CAPTURE(azimuth);
            // A tenth is left to the illuminance. The lamp's half degree turns facets by up to half of that.
            CHECK(importance(glossy) / importance(diffuse) == doctest::Approx(0.1 + 0.9 * lobe / way.z).epsilon(0.03));
        }
}

namespace {

/// A flat lamp in the plane z = at.z.
void add_disc(std::vector<Lamp>& lamps, Vec3d at, double radius, float radiance) {
    constexpr int kCorners = 16;
    const auto corner = [&](int k) {
        const double angle = 2 * std::numbers::pi * k / kCorners;
        return at + Vec3d{radius * std::cos(angle), radius * std::sin(angle), 0};
    };
    for (int k = 1; k + 1 < kCorners; ++k) lamps.push_back({corner(0), corner(k), corner(k + 1), radiance});
}

/// 400 area lights, 10 discs of triangles, and 100 point lights.
Scene many_lights() {
    std::vector<Lamp> many;
    Uniform place(8);
    for (int i = 0; i < 400; ++i) {
        const Vec3d at{4 * static_cast<double>(place()) - 2, 4 * static_cast<double>(place()) - 2,
                       static_cast<double>(place())};
        const double size = std::pow(10.0, -3.0 * static_cast<double>(place()));
        const Vec3d v = i % 3 ? Vec3d{0, size, 0} : Vec3d{0, 0, size};
        many.push_back({at, at + Vec3d{size, 0, 0}, at + v, i % 2 ? 1.0f : 100.0f});
    }
    for (int i = 0; i < 10; ++i)
        add_disc(many, {0.4 * i - 2, 0.1 * i, static_cast<double>(place())}, 0.02 + 0.02 * i, 50.0f);
    Scene scene = with_lamps(many);
    for (int i = 0; i < 100; ++i)
        scene.points.push_back(
            {{static_cast<double>(place()), 3 * static_cast<double>(place()), 2}, {1e-3f, 1e-3f, 0}});
    return scene;
}

/// To their lights from within, from beside and from far away, some with a lobe.
std::vector<LightReceiver> receivers_of_many_lights() {
    std::vector<LightReceiver> receivers;
    for (const Vec3f position : {Vec3f{0, 0, 0.5f}, Vec3f{1, -1, -3}, Vec3f{50, 20, 10}})
        for (const LightReceiver& receiver : {LightReceiver{position, {0, 0, 0}}, LightReceiver{position, {0, 0, 1}},
                                              LightReceiver{position, {0, 0, -1}}, LightReceiver{position, {-1, 0, 0}},
                                              LightReceiver{position, {0, 0, 1}, 0, {{0.8f, 0, 0.6f}, 0.2f, 0.5f}},
                                              LightReceiver{position, {-1, 0, 0}, 0, {{-0.1f, 0.995f, 0}, 0.01f, 1}}})
            receivers.push_back(receiver);
    return receivers;
}

}  // namespace

TEST_CASE("the triangles of a flat lamp are one leaf of the tree") {
    const auto leaves = [](const std::vector<Lamp>& lamps) {
        const Scene scene = with_lamps(lamps);
        return (RenderSpaceScene(scene, {0, 0, 0}).view().light_node_count + 1) / 2;
    };
    std::vector<Lamp> discs;
    add_disc(discs, {0, 0, 2}, 0.03, 1);
    CHECK(leaves(discs) == 1);
    add_disc(discs, {0.2, 0, 2}, 0.03, 1);
    CHECK(leaves(discs) == 2);
    const Vec3d along{0.02, 2, 0}, across{0.05, -0.0005, 0};  // a tube of 40 : 1, turned
    CHECK(leaves({{{0, 0, 2}, along, across, 1}, {along, along + across, across, 1}}) == 2);
    CHECK(leaves({{{0, 0, 0}, along, across, 1}, {along, along + across, across, 1}}) == 1);
    CHECK(leaves({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}, {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}, 1}}) == 2);
    CHECK(leaves({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}, {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 100}}) == 2);
    std::vector<Lamp> sheet;
    for (int k = 0; k < 5; ++k)
        for (const Lamp& half : {Lamp{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}, Lamp{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, 1}}) {
            const Vec3d at{1.0 * k, 0, 0};
            sheet.push_back({half.a + at, half.b + at, half.c + at, 1});
        }
    CHECK(leaves(sheet) > 1);  // of 5 : 1, whose ends bring more to what is near them
}

TEST_CASE("a light is chosen from the tree with the probability that is said of it") {
    ChiSquareTests tests("choose_light: 540 area lights and 100 point lights, by the tree");
    const Scene scene = many_lights();
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const SceneView view = placed.view();
    const int lights = view.point_count + view.area_count;
    unsigned seed = 1;
    double worst = 0;
    for (const LightReceiver& receiver : receivers_of_many_lights()) {
        std::vector<double> expected, counts(static_cast<std::size_t>(lights));
        for (int i = 0; i < lights; ++i)
            expected.push_back(kLampSamples * static_cast<double>(light_probability(view, receiver, i)));
        Uniform uniform(seed++);
        for (int i = 0; i < kLampSamples; ++i) {
            const LightChoice choice = choose_light(view, receiver, uniform(), static_cast<std::uint32_t>(i));
            REQUIRE((choice.light >= 0 && choice.light < lights && choice.fresh >= 0 && choice.fresh < 1));
            const auto light = static_cast<std::size_t>(choice.light);
            worst = std::max(worst,
                             std::fabs(kLampSamples * static_cast<double>(choice.probability) / expected[light] - 1));
            ++counts[light];
        }
        tests.add(expected, counts);
    }
    tests.hold();
    CHECK(worst < 1e-5);
}

TEST_CASE("many receivers at once choose the lights that each of them chooses") {
    constexpr int kLanes = 32;
    const Scene scene = many_lights();
    const RenderSpaceScene placed(scene, {0, 0, 0});
    const SceneView view = placed.view();
    const std::vector<LightReceiver> receivers = receivers_of_many_lights();
    const auto receiver = [&](int i) { return receivers[static_cast<std::size_t>(i) % receivers.size()]; };
    Uniform uniform(3);
    int others = 0;
    for (int turn = 0; turn < 1000; ++turn) {
        float u[kLanes];
        std::uint32_t seed[kLanes];
        for (int i = 0; i < kLanes; ++i) {
            u[i] = uniform();
            seed[i] = static_cast<std::uint32_t>(kLanes * turn + i);
        }
        LightChoices<kLanes> chosen;
        choose_lights<kLanes>(view, receiver, u, seed, kLanes, chosen);
        for (int i = 0; i < kLanes; ++i) {
            const LightChoice alone = choose_light(view, receiver(i), u[i], seed[i]);
            if (chosen.light[i] != alone.light) {
                ++others;
                continue;
            }
            REQUIRE(chosen.probability[i] == doctest::Approx(alone.probability).epsilon(1e-5));
            REQUIRE((chosen.fresh[i] >= 0 && chosen.fresh[i] < 1));
        }
    }
    // If the compiler rounds differently, a random number at the boundary of two lights may select either.
    CHECK(others < 5);
}

namespace {

/// How often each kind is picked, against its probability: point and area lights, two suns, and a sky.
void check_kinds(ChiSquareTests& tests, const SceneView& view, LightReceiver receiver, const LightKinds& kinds,
                 unsigned seed) {
    const double share[] = {static_cast<double>(kinds.local_probability),
                            static_cast<double>(kinds.sun_probability(view.suns[0], receiver.normal)),
                            static_cast<double>(kinds.sun_probability(view.suns[1], receiver.normal)),
                            static_cast<double>(kinds.environment_probability)};
    CHECK(share[0] + share[1] + share[2] + share[3] == doctest::Approx(1).epsilon(1e-6));
    CHECK((share[3] > 0) != kinds.environment_is_separate);
    std::vector<double> expected, counts(4);
    for (const double s : share) expected.push_back(s * kLampSamples);
    Uniform uniform(seed);
    for (int i = 0; i < kLampSamples; ++i) {
        const LightPick pick = pick_light(view, receiver, kinds, 0, uniform.pair(), 1);
        ++counts[pick.kind == LightKind::sun           ? static_cast<std::size_t>(1 + pick.index)
                 : pick.kind == LightKind::environment ? 3u
                                                       : 0u];
    }
    tests.add(expected, counts);
    const LightPick second = pick_light(view, receiver, kinds, 1, {0.5f, 0.5f}, 1);
    CHECK(second.kind == LightKind::environment);
    CHECK(second.probability == (kinds.environment_is_separate ? 1.0f : 0.0f));
}

}  // namespace

TEST_CASE("kinds of light are chosen with the probabilities of LightKinds, which add up to 1") {
    ChiSquareTests tests("pick_light: the choice of a kind");
    unsigned seed = 1;
    for (const float sky : {1.0f, 1e-3f}) {
        Scene scene = with_lamps({{{0, 2, 0}, {1, 2, 0}, {0, 2, 1}, 1}});
        scene.suns = {{{0, -1, 0}, {1, 1, 0}}, {{0, -0.6f, 0.8f}, {0, 10, 0}}};
        scene.environment.constant = {sky, 0, sky};
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const SceneView view = placed.view();
        for (const Vec3f normal : {Vec3f{0, 1, 0}, Vec3f{0, 0, -1}, Vec3f{0, -1, 0}, Vec3f{0, 0, 0}}) {
            CAPTURE(sky);
            const LightReceiver receiver{{0.2f, 0, 0.1f}, normal};
            const LightKinds kinds = light_kinds(view, SkySampling::apart, receiver);
            // A dim sky is the only light of a surface that faces away from the other lights.
            CHECK((!kinds.environment_is_separate || sky == 1.0f || normal.y < 0));
            check_kinds(tests, view, receiver, kinds, seed++);
            check_kinds(tests, view, receiver, light_kinds(view, SkySampling::chosen, receiver), seed++);
        }
    }
    tests.hold();

    const Scene dark = bare_scene();
    const RenderSpaceScene nothing(dark, {0, 0, 0});
    for (int k = 0; k < kLightSampleCount; ++k) CHECK_FALSE(has_light(nothing.view(), SkySampling::apart, k));
}
