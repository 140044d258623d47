// Air that scatters light: attenuation, single scattering and a uniform enclosure against closed forms and quadrature.

#include <cmath>
#include <vector>

#include "chi_square.hpp"
#include "radiance_in_media.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kAirSamples = 1 << 17;

}  // namespace

TEST_CASE("the phase function is normalised, and its samples have its Legendre moments") {
    Worst worst;
    for (const float g : {-0.99f, -0.5f, 0.0f, 1e-4f, 0.3f, 0.8f, 0.99f}) {
        CAPTURE(g);
        const double exact = static_cast<double>(g);
        const auto moment = [&](auto&& f) {
            return Rule::integrate(
                [&](double c) {
                    return 2 * M_PI * f(c) * static_cast<double>(henyey_greenstein(g, static_cast<float>(c)));
                },
                -1.0, 1.0, 15, 1e-8);
        };
        // Float cosines: at g = 0.99 a rounding of 2^-24 of the cosine changes the value at the peak by 2e-3.
        CHECK(moment([](double) { return 1.0; }) == doctest::Approx(1).epsilon(1e-4));
        CHECK(moment([](double c) { return c; }) == doctest::Approx(exact).epsilon(1e-4));
        Uniform uniform(5);
        Mean first, second;
        const Vec3f arriving = normalized(Vec3f{0.3f, -0.5f, 0.8f});
        for (int i = 0; i < kAirSamples; ++i) {
            const Vec3f direction = sample_henyey_greenstein(g, arriving, uniform.pair());
            const double c = static_cast<double>(dot(direction, arriving));
            CHECK(length(direction) == doctest::Approx(1.0f).epsilon(1e-5));
            first.add(c);
            second.add(1.5 * c * c - 0.5);
        }
        // The moments of the phase function's Legendre expansion are powers of g (Henyey and Greenstein 1941). A moment
        // of 0 has a standard error, but no relative rounding.
        CHECK(std::fabs(first.value() - exact) <= kErrors * first.standard_error() + 1e-6);
        CHECK(std::fabs(second.value() - exact * exact) <= kErrors * second.standard_error() + 1e-6);
        for (const Vec2f u : extreme_inputs())
            CHECK(length(sample_henyey_greenstein(g, arriving, u)) == doctest::Approx(1.0f).epsilon(1e-5));
    }
}

TEST_CASE("the part of a ray in the air") {
    AirView air;
    air.extinction = {1, 1, 1};
    air.low = {-1, -2, -3};
    air.high = {1, 2, 3};
    const auto interval = [&](Vec3f origin, Vec3f direction, float distance) {
        const MediumInterval i = air_interval(air, origin, normalized(direction), distance);
        return std::pair(i.begin, i.length);
    };
    CHECK(interval({0, 0, 0}, {0, 0, 1}, 10) == std::pair(0.0f, 3.0f));
    CHECK(interval({0, 0, 0}, {0, 0, 1}, 2) == std::pair(0.0f, 2.0f));
    CHECK(interval({0, 0, -5}, {0, 0, 1}, kFarAway) == std::pair(2.0f, 6.0f));
    CHECK(interval({0, 0, -5}, {0, 0, 1}, 4) == std::pair(2.0f, 2.0f));
    CHECK(interval({0, 0, -5}, {0, 0, 1}, 1).second == 0);
    CHECK(interval({0, 0, -5}, {0, 0, -1}, kFarAway).second == 0);
    CHECK(interval({5, 0, 0}, {0, 1, 0}, kFarAway).second == 0);
    air.low = {-kFarAway, -kFarAway, -kFarAway};
    air.high = {kFarAway, kFarAway, kFarAway};
    CHECK(interval({1e5f, 0, 0}, {0, 1, 0}, 7) == std::pair(0.0f, 7.0f));
    CHECK(interval({0, 0, 0}, {0.5f, 1, 0}, kFarAway) == std::pair(0.0f, kFarAway));
}

TEST_CASE("the interior of glass has no air") {
    // A slab of clear glass that neither reflects nor refracts, 3 m thick, in front of a wall at 10 m.
    Scene scene = emitting_box({-50, -50, -11}, {50, 50, -10}, {100, 100, 100});
    scene.materials.push_back({});
    scene.materials[1].diffuse = {0, 0, 0};
    scene.materials[1].transmission = 1;
    scene.materials[1].ior = 1;
    add_quad(scene, {-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}, 1);
    add_quad(scene, {-9, 9, -5}, {9, 9, -5}, {9, -9, -5}, {-9, -9, -5}, 1);
    scene.air = air_of({0.1f, 0.2f, 0.3f}, {0, 0, 0}, 0);
    const ColorMean clear = radiance(scene, {{0, 0, 0}, {0, 0, -1}}, 3, 1 << 14);
    Worst worst;
    worst.add(clear.r, 100 * std::exp(-0.7));
    worst.add(clear.g, 100 * std::exp(-1.4));
    worst.add(clear.b, 100 * std::exp(-2.1));
    scene.materials[1].absorption = {0.3f, 0.2f, 0.1f};
    const ColorMean tinted = radiance(scene, {{0, 0, 0}, {0, 0, -1}}, 3, 1 << 14);
    worst.add(tinted.r, 100 * std::exp(-0.7 - 0.9));
    worst.add(tinted.g, 100 * std::exp(-1.4 - 0.6));
    worst.add(tinted.b, 100 * std::exp(-2.1 - 0.3));
}

TEST_CASE("light that the air scatters once from a point light and a spot") {
    struct Case {
        Vec3d lamp;
        float g;
        Color extinction;
        bool is_spot;
    };
    const std::vector<Case> cases = {
        {{1, 0.5, -3}, 0, {0.1f, 0.2f, 0.4f}, false},        {{1e-2, 0, -3}, 0.8f, {0.1f, 0.2f, 0.4f}, false},
        {{0, 2, 4}, -0.5f, {0.02f, 0.02f, 0.02f}, false},  // behind the camera
        {{20, 0, -100}, 0.5f, {0.01f, 0.02f, 0.05f}, false}, {{1, 2, -3}, 0.6f, {1.5f, 1, 0}, false},
        {{0, 2, -4}, 0.3f, {0.1f, 0.2f, 0.3f}, true}};
    Worst worst;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        CAPTURE(k);
        const Case& test = cases[k];
        Scene scene = nothing_in_view();
        // Half of the albedo, because the integral below is over the albedo.
        scene.air = air_of(test.extinction, {0.5f, 0.5f, 0.5f}, test.g);
        ScenePointLight lamp{test.lamp, {7, 7, 7}};
        if (test.is_spot) {
            lamp.axis = {0, -1, 0};
            lamp.outer_cone_rad = 0.6;
        }
        scene.points = {lamp};
        const Ray ray{{0, 0, 0}, {0.1f, 0.05f, -1}};
        const ColorMean mean = radiance(scene, ray, 0, kAirSamples);
        const auto truth = [&](float extinction) {
            const auto intensity = [&](Vec3d d) {
                if (!test.is_spot) return 7.0;
                const double outer = std::cos(0.6), falloff = std::clamp((-d.y - outer) / (1 - outer), 0.0, 1.0);
                return 7 * falloff * falloff;
            };
            // The integral up to 400 mean free paths of the thinnest air that is not clear.
            const double length = extinction > 0 ? 400 / static_cast<double>(extinction) : 1;
            return 0.5 * scattered_once({0, 0, 0}, normalized(Vec3d{0.1, 0.05, -1}), length,
                                        static_cast<double>(extinction), static_cast<double>(test.g), test.lamp,
                                        intensity);
        };
        worst.add(mean.r, truth(test.extinction.r));
        worst.add(mean.g, truth(test.extinction.g));
        if (test.extinction.b > 0)
            worst.add(mean.b, truth(test.extinction.b));
        else
            CHECK(mean.b.value() == 0);
    }
    hold({"Samplers", "light that fog scatters once from a point light: mean against quadrature",
          "6 cases of 2^17 samples: beside, behind and far from the lamp, a spot; three channels", "core", "float32",
          worst.errors, kErrors, "standard errors"});
}

TEST_CASE("samples of a lamp and samples of the phase function find the same light" * doctest::test_suite("slow")) {
    // A lamp of two triangles beside the ray; the albedo is so small that light scattered twice does not count.
    constexpr float kAlbedo = 1e-5f;
    Worst worst;
    for (const float g : {-0.3f, 0.0f, 0.9f})
        for (const double far : {2.5, 9.0}) {
            CAPTURE(g);
            CAPTURE(far);
            Scene scene = nothing_in_view();
            scene.materials.push_back({});
            scene.materials[1].diffuse = {0, 0, 0};
            scene.materials[1].emission = {5, 5, 5};
            const Vec3d u{1.5, 0, 0}, v{0, 1.5, 0};
            const Vec3d corner{0.5, -0.75, -far};
            add_quad(scene, corner, corner + u, corner + u + v, corner + v, 1);
            constexpr double kExtinction = 0.3;
            scene.air = air_of(grey(0.3f), grey(kAlbedo), g);
            const Ray ray{{0, 0, 0}, {0, 0, -1}};
            // The ray passes beside the lamp, which faces +z: only points in front of it are illuminated.
            const double truth = Rule::integrate(
                [&](double s) {
                    return Rule::integrate(
                        [&](double t) {
                            const Vec3d at = corner + s * u + t * v;
                            const double area = length(cross(u, v));
                            return area * scattered_once({0, 0, 0}, {0, 0, -1}, far, kExtinction,
                                                         static_cast<double>(g), at,
                                                         [&](Vec3d d) { return 5 * std::max(0.0, d.z); });
                        },
                        0.0, 1.0, 5, 1e-6);
                },
                0.0, 1.0, 5, 1e-6);
            Mean by_phase;
            const ColorMean light = radiance(scene, ray, 0, kAirSamples),
                            both = radiance(scene, ray, 1, 4 * kAirSamples);
            const auto over_albedo = [&](const ColorMean& mean) {
                Mean scaled = mean.g;
                scaled.sum /= static_cast<double>(kAlbedo);
                scaled.squares /= static_cast<double>(kAlbedo) * static_cast<double>(kAlbedo);
                return scaled;
            };
            worst.add(over_albedo(light), truth);
            worst.add(over_albedo(both), truth);
            // Phase-function samples alone, with the distances of cross_medium.
            const BothTraversals traversals(scene);
            const SceneView view = traversals.scene();
            Uniform uniform(3);
            for (int i = 0; i < 4 * kAirSamples; ++i) {
                MediumNumbers numbers{uniform.pair(), uniform.pair(), uniform.pair(), static_cast<std::uint32_t>(i)};
                const MediumCrossing crossing =
                    cross_medium(view, {ray.origin, ray.direction, kFarAway, 0, {1, 1, 1}}, true, numbers);
                const Vec2f direction_u = uniform.pair();
                if (crossing.scattered_at < 0) {
                    by_phase.add(0);
                    continue;
                }
                const Vec3f from = ray.origin + crossing.scattered_at * ray.direction;
                const Vec3f direction = sample_henyey_greenstein(g, ray.direction, direction_u);
                const Hit hit = closest_hit<true>(traversals.bvh(), from, direction, kFarAway);
                const bool is_lamp =
                    hit.triangle != kNoTriangle && direction.z < 0 && view.triangles[hit.triangle].material == 1;
                by_phase.add(is_lamp ? 5 * static_cast<double>(crossing.weight.g) / static_cast<double>(kAlbedo) *
                                           std::exp(-kExtinction * static_cast<double>(hit.distance))
                                     : 0.0);
            }
            worst.add(by_phase, truth);
        }
    hold({"Samplers", "light that fog scatters once from a lamp, by each sampling method: mean against quadrature",
          "6 cases of 2^17 to 2^19 samples: light samples, phase-function samples, and both combined", "core",
          "float32", worst.errors, kErrors, "standard errors"});
}

TEST_CASE("air that only scatters does not change a uniform enclosure") {
    Worst worst;
    const Ray ray{{0.2f, 0.1f, 0.3f}, {0.3f, -0.4f, 0.8f}};
    for (const float g : {0.0f, 0.8f})
        for (const Color extinction : {Color{0.2f, 0.2f, 0.2f}, Color{0.1f, 0.4f, 1.5f}}) {
            CAPTURE(g);
            Scene box = emitting_box({-2, -1, -1}, {1, 2, 3}, {3, 3, 3});
            box.air = air_of(extinction, {1, 1, 1}, g);
            const ColorMean in_box = radiance(box, ray, 64, kAirSamples);
            Scene sky = nothing_in_view();
            sky.positions_m = {{-1, -1, -1}, {-1, -1, -0.99}, {-1, -0.99, -1}};
            sky.environment.constant = {3, 3, 3};
            sky.air = box.air;
            sky.air.margin_m = 1.0;
            const ColorMean under_sky = radiance(sky, ray, 64, kAirSamples);
            Scene map = sky;
            map.environment.width = 4;
            map.environment.height = 2;
            map.environment.pixels.assign(8, {3, 3, 3});
            const ColorMean under_map = radiance(map, ray, 64, kAirSamples);
            for (const ColorMean& mean : {in_box, under_sky, under_map}) {
                worst.add(mean.r, 3);
                worst.add(mean.g, 3);
                worst.add(mean.b, 3);
            }
        }
    hold({"Samplers", "fog of albedo 1 in a uniform enclosure", "36 means of 2^17 paths: walls, skies, three channels",
          "core", "float32", worst.errors, kErrors, "standard errors"});
}

TEST_CASE("each lane of a block takes the path of a block of one, in air") {
    for (const AddedLight& light : kAddedLights) {
        CAPTURE(light.name);
        Scene scene = lamp_room();
        light.add(scene);
        scene.air = air_of({0.1f, 0.15f, 0.2f}, {0.9f, 0.95f, 0.99f}, 0.6f);
        scene.air.margin_m = 2.0;
        // The tolerance is that of test_glossy_lanes: the rounding of six directions.
        for (const PathSettings& settings : kFollowedSettings) check_lanes<SceneKind::any>(scene, settings, 2e-4f);
    }
}
