// Light from lamps and skies and off surfaces: what the samples' means come to, against numerical quadrature.

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bare_scene.hpp"
#include "chi_square.hpp"
#include "estimator_mean.hpp"
#include "scene/lights/light.hpp"
#include "scene/materials/plain_bsdf.hpp"
#include "scene/render_space/render_space_scene.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

// Adaptive, over the triangle by its barycentric coordinates.
template <class F>
double over_triangle(Vec3d a, Vec3d b, Vec3d c, F&& f) {
    using Rule = boost::math::quadrature::gauss_kronrod<double, 15>;
    const double twice_area = length(cross(b - a, c - a));
    return Rule::integrate(
        [&](double s) {
            return Rule::integrate(
                [&](double t) { return twice_area * s * f((1 - s) * a + (s * (1 - t)) * b + (s * t) * c); }, 0.0, 1.0,
                12, 1e-7);
        },
        0.0, 1.0, 12, 1e-7);
}

Color grey_of_pi() {
    return grey(static_cast<float>(M_PI));
}

/// Light of direct light samples, where an irradiance of E becomes a radiance of E.
double seen(const SceneView& scene, LightReceiver receiver, Vec2f u) {
    const PlainBsdf white{receiver.normal, receiver.normal, receiver.normal, grey_of_pi(), {0, 0, 0}, 0};
    double sum = 0;
    for (int k = 0; k < kLightSampleCount; ++k) {
        if (!has_light(scene, SkySampling::apart, k)) continue;
        const LightSample light = sample_light<SceneKind::plain>(scene, SkySampling::apart, receiver, k, u, 7);
        sum += static_cast<double>((white.eval(light.direction) * light.irradiance).r);
    }
    return sum;
}

LightReceiver receiver_at(Vec3d position, Vec3d normal) {
    return {static_cast<Vec3f>(position), static_cast<Vec3f>(normalized(normal))};
}

Scene scene_of_lamps(const std::vector<Lamp>& lamps) {
    Scene scene;
    add_lamps(scene, lamps);
    return scene;
}

}  // namespace

TEST_CASE("direct light of shining triangles is the integral over them") {
    struct Case {
        std::vector<Lamp> lamps;
        Vec3d position, normal;
    };
    const Vec3d up{0, 0, 1}, far{6e4, -7e4, 4e4};
    const std::vector<Case> cases = {
        {{{{-1, -1, 2}, {-1, 1, 2}, {1, -1, 2}, 3}}, {0.2, 0.1, 0}, up},
        {{{{-1, -1, 0.02}, {-1, 1, 0.02}, {1, -1, 0.02}, 3}}, {-0.4, -0.4, 0}, up},  // a hundredth of its size off
        {{{{1, -1, -1}, {1, 0, 1}, {1, 1, -1}, 3}}, {0, 0, 0}, {0.3, 0, 1}},  // half below the horizon
        {{{{1, 0, 0.1}, {3, 0, 0.1}, {1, 2, 0.12}, 3}, {{1, 0, 0.1}, {1, 2, 0.12}, {3, 0, 0.1}, 3}},
         {0, 0, 0},
         up},  // edge on
        {{{far, far + Vec3d{1e-3, 0, 0}, far + Vec3d{0, -1e-3, 1e-4}, 1e9f}},
         {0, 0, 0},
         far},  // a millimetre, 1e5 m off
        {{{{-1e7, -1e7, 5e6}, {0, 2e7, 5e6}, {1e7, -1e7, 5e6}, 3}}, {0, 0, 0}, {0.2, 0.3, 1}},
        {{{{1, 0, 0}, {1, -1e-6, 1}, {1, 1e-6, 1}, 1e6f}}, {0, 0, 0}, up},  // a sliver
        {{{{-1, -1, 2}, {-1, 1, 2}, {1, -1, 2}, 1e-2f}, {{40, 0, 1}, {40, 0, 2}, {40, 1, 1}, 1e6f}}, {0, 0, 0}, up},
        {{{{-1, -1, 2}, {-1, 1, 2}, {1, -1, 2}, 1}, {{-1, -1, -2}, {-1, 1, -2}, {1, -1, -2}, 1e8f}}, {0, 0, 0}, up}};
    constexpr int kSamples = 1 << 18;
    Worst worst;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        CAPTURE(k);
        const Case& test = cases[k];
        const Vec3d n = normalized(test.normal);
        double truth = 0;
        for (const Lamp& lamp : test.lamps) {
            const Vec3d facing = normalized(cross(lamp.b - lamp.a, lamp.c - lamp.a));
            truth += over_triangle(lamp.a, lamp.b, lamp.c, [&](Vec3d at) {
                const Vec3d way = at - test.position, d = normalized(way);
                return static_cast<double>(lamp.radiance) * std::max(0.0, dot(d, n)) * std::max(0.0, -dot(d, facing)) /
                       dot(way, way);
            });
        }
        REQUIRE(truth > 0);
        const Scene scene = scene_of_lamps(test.lamps);
        const RenderSpaceScene placed(scene, {0, 0, 0});
        const LightReceiver receiver = receiver_at(test.position, test.normal);
        // By which lobe lights are chosen has no say in the mean.
        LightReceiver glossy = receiver;
        glossy.lobe = {static_cast<Vec3f>(normalized(n + 0.9 * normalized(cross(n, Vec3d{0.3, 0.2, 1})))), 0.2f, 0.8f};
        unsigned seed = static_cast<unsigned>(k) + 1;
        for (const LightReceiver& chooses : {receiver, glossy}) {
            Mean mean;
            Uniform uniform(seed);
            double most = 0;
            for (int i = 0; i < kSamples; ++i) {
                const double sample = seen(placed.view(), chooses, uniform.pair());
                mean.add(sample);
                most = std::max(most, sample);
            }
            worst.add(mean, truth);
            // However near a lamp is, no sample brings more than it would from half of all directions.
            if (test.lamps.size() == 1) CHECK(most < 2 * M_PI * static_cast<double>(test.lamps[0].radiance));
            seed += 100;
        }
    }
    hold({"Samplers", "direct light of shining triangles: mean against quadrature",
          "9 cases of 2^18 samples: near, grazing, slivers, 1e-3 to 1e7 m, 1e8 : 1 in light; diffuse and glossy",
          "core", "float32", worst.errors, kErrors, "standard errors"});
}

TEST_CASE("direct light of an environment is the integral over its pixels") {
    constexpr int kHeight = 8, kWidth = 16, kSamples = 1 << 18;
    std::mt19937 engine(7);
    std::normal_distribution<double> normal(0, 2);
    std::vector<std::vector<float>> images(4, std::vector<float>(kHeight * kWidth, 0.0f));
    for (float& v : images[0]) v = engine() % 10 < 3 ? 0.0f : static_cast<float>(std::exp(normal(engine)));
    images[1][2 * kWidth + 5] = 100;
    for (float& v : images[2]) v = 1;
    images[2][6 * kWidth + 3] = 1e8f;  // below the horizon of some of the normals
    images[3][8] = 4;  // at the pole
    Worst worst;
    unsigned seed = 1;
    for (const std::vector<float>& image : images)
        for (const Vec3d& n : {Vec3d{0, 1, 0}, normalized(Vec3d{1, 0.5, -0.3}), normalized(Vec3d{-0.2, -1, 0.4})}) {
            Scene scene = scene_of_lamps({{{0, 0, 9}, {1, 0, 9}, {0, 1, 9}, 0}});
            scene.environment.width = kWidth;
            scene.environment.height = kHeight;
            for (const float v : image) scene.environment.pixels.push_back({v, v, v});
            double truth = 0;
            for (int row = 0; row < kHeight; ++row)
                for (int column = 0; column < kWidth; ++column)
                    // The horizon cuts through pixels: 16 x 16 parts leave 1e-5 of one.
                    truth += static_cast<double>(image[static_cast<std::size_t>(row * kWidth + column)]) *
                             integral(
                                 [&](double polar, double azimuth) {
                                     const double r = std::sin(polar);
                                     const Vec3d d{r * std::sin(azimuth), std::cos(polar), -r * std::cos(azimuth)};
                                     return std::max(0.0, dot(d, n)) * r;
                                 },
                                 M_PI * row / kHeight, M_PI * (row + 1) / kHeight, 2 * M_PI * (column / 16.0 - 0.5),
                                 2 * M_PI * ((column + 1) / 16.0 - 0.5), 16);
            const RenderSpaceScene placed(scene, {0, 0, 0});
            const LightReceiver receiver = receiver_at({0, 0, 0}, n);
            Mean mean;
            Uniform uniform(seed++);
            for (int i = 0; i < kSamples; ++i) mean.add(seen(placed.view(), receiver, uniform.pair()));
            if (truth > 0) {
                worst.add(mean, truth);
            } else {
                CHECK(mean.value() == 0);
            }
        }
    hold({"Samplers", "direct light of an environment: mean against quadrature",
          std::to_string(worst.cases) + " cases of 2^18 samples: uneven, one bright pixel, 1e8 : 1, at the pole",
          "core", "float32", worst.errors, kErrors, "standard errors"});
}

TEST_CASE("no surface reflects more than it gets, and scattered paths carry what the integral says") {
    struct Surface {
        float diffuse, specular, shininess;
    };
    constexpr Surface kSurfaces[] = {{1, 0, 0},       {0, 1, 0},         {0, 1, 1},         {0, 1, 20},
                                     {0.5f, 0.5f, 5}, {0.2f, 0.8f, 100}, {0.3f, 0.7f, 1e4f}};
    constexpr int kSamples = 1 << 17;
    double most = 0, most_by_mean = 0;
    Worst worst;
    unsigned seed = 1;
    for (const Surface& s : kSurfaces)
        for (const double degrees : {0.0, 45.0, 80.0}) {
            CAPTURE(s.shininess);
            CAPTURE(degrees);
            const double a = degrees * M_PI / 180;
            const Vec3f eye = static_cast<Vec3f>(Vec3d{-std::sin(a), std::cos(a), 0}), normal = {0, 1, 0};
            const PlainBsdf bsdf{normal, normal, eye, grey(s.diffuse), grey(s.specular), s.shininess};
            // About the mirrored direction, in rings of the lobe's width; the horizon cuts through them.
            const Vec3d axis = normalized(static_cast<Vec3d>(mirrored_at(normal, eye)));
            const Vec3d x = normalized(cross(axis, Vec3d{0.3, 0.2, 0.9})), y = cross(axis, x);
            const double width = std::sqrt(2 / (static_cast<double>(s.shininess) + 2));
            double truth = 0, from = 0;
            while (from < M_PI) {
                const double to = std::min(from + std::max(0.3 * width, from > 4 * width ? 0.1 : 0.0), M_PI);
                truth += integral(
                    [&](double angle, double turn) {
                        const double r = std::sin(angle);
                        const Vec3d d = (r * std::cos(turn)) * x + (r * std::sin(turn)) * y + std::cos(angle) * axis;
                        return static_cast<double>(bsdf.eval(static_cast<Vec3f>(d)).r) * r;
                    },
                    from, to, -M_PI, M_PI, 12);
                from = to;
            }
            Mean mean;
            Uniform uniform(seed++);
            for (int i = 0; i < kSamples; ++i) mean.add(static_cast<double>(bsdf.sample(uniform.pair(), 0).weight.r));
            worst.add(mean, truth);
            most = std::max(most, truth);
            most_by_mean = std::max(most_by_mean, mean.value() - kErrors * mean.standard_error());
        }
    // 1e-5: rounding of the reflectance, whose power of 1e4 multiplies that of its cosine.
    hold({"Samplers", "white furnace: reflected share of a constant sky, by quadrature",
          "7 surfaces from diffuse to an exponent of 1e4, 3 views", "core", "float32", most, 1 + 1e-5, "of the sky"});
    CHECK(most_by_mean <= 1);
    hold({"Samplers", "reflected light: mean of scattered paths against quadrature",
          std::to_string(worst.cases) + " cases of 2^17 samples", "core", "float32", worst.errors, kErrors,
          "standard errors"});
}
