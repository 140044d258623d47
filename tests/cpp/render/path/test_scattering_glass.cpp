// Glass whose interior scatters light: attenuation, single and multiple scattering and uniform enclosures against
// closed forms and quadrature.

#include <cmath>
#include <vector>

#include "measurement.hpp"
#include "radiance_in_media.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kGlassSamples = 1 << 17;

/// Smooth glass with this medium inside.
Material glass_of(Color absorption, Color scattering, float anisotropy, float ior) {
    Material glass;
    glass.diffuse = {0, 0, 0};
    glass.transmission = 1;
    glass.ior = ior;
    glass.absorption = absorption;
    glass.scattering = scattering;
    glass.scattering_anisotropy = anisotropy;
    return glass;
}

/// Adds a closed box of glass.
void add_glass(Scene& scene, Vec3d low, Vec3d high, const Material& glass) {
    const auto material = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(glass);
    const auto at = [&](int x, int y, int z) {
        return Vec3d{x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z};
    };
    // Counterclockwise, seen from outside.
    add_quad(scene, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1), material);
    add_quad(scene, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0), material);
    add_quad(scene, at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), material);
    add_quad(scene, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1), material);
    add_quad(scene, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), material);
    add_quad(scene, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), material);
}

/// A slab without refraction below y = 0, which is so wide that its sides are 100 of its thinnest channel's free paths
/// away or more. The extinction must be at least 1 per metre.
Scene slab(double thickness, Color extinction, Color albedo, float anisotropy) {
    const Color scattering = extinction * albedo;
    Scene scene;
    add_glass(scene, {-100, -thickness, -100}, {100, 0, 100},
              glass_of(extinction - scattering, scattering, anisotropy, 1));
    return scene;
}

/// Sets a sky of radiance 1 above the horizon, and black below.
void set_upper_sky(Scene& scene) {
    scene.environment.width = 4;
    scene.environment.height = 2;
    scene.environment.pixels.assign(8, {0, 0, 0});
    std::fill_n(scene.environment.pixels.begin(), 4, Color{1, 1, 1});
}

/// H function of a semi-infinite medium that scatters isotropically, by iteration of Chandrasekhar 1960, chapter V,
/// eq. 11 (1 / H), with a Gauss-Kronrod quadrature of 61 points.
double h_function(double albedo, double mu) {
    std::vector<double> nodes, weights;
    const auto& x = boost::math::quadrature::gauss_kronrod<double, 61>::abscissa();
    const auto& w = boost::math::quadrature::gauss_kronrod<double, 61>::weights();
    for (std::size_t i = 0; i < x.size(); ++i)
        for (const double sign : {-1.0, 1.0}) {
            if (x[i] == 0 && sign < 0) continue;
            nodes.push_back(0.5 * (1 + sign * x[i]));
            weights.push_back(0.5 * w[i]);
        }
    std::vector<double> h(nodes.size(), 1.0);
    const auto next = [&](double at) {
        double sum = std::sqrt(1 - albedo);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            sum += 0.5 * albedo * weights[i] * nodes[i] * h[i] / (at + nodes[i]);
        return 1 / sum;
    };
    for (int iteration = 0; iteration < 300; ++iteration) {
        std::vector<double> improved;
        for (const double node : nodes) improved.push_back(next(node));
        h = improved;
    }
    return next(mu);
}

}  // namespace

TEST_CASE("light that scattering glass neither absorbs nor scatters follows Beer and Lambert") {
    const Color extinction = {0.3f, 0.5f, 1.2f};
    const auto through = [&](float albedo, int max_bounces) {
        const Color scattering = albedo * extinction;
        Scene scene = emitting_box({-50, -50, -11}, {50, 50, -10}, {100, 100, 100});
        add_glass(scene, {-9, -9, -5}, {9, 9, -2}, glass_of(extinction - scattering, scattering, 0, 1));
        return radiance(scene, {{0, 0, 0}, {0, 0, -1}}, max_bounces, kGlassSamples);
    };
    const double truth[] = {100 * std::exp(-3 * 0.3), 100 * std::exp(-3 * 0.5), 100 * std::exp(-3 * 1.2)};
    // The albedo is so small that scattered light does not count.
    const ColorMean sampled = through(1e-6f, 4);
    Worst worst;
    worst.add(sampled.r, truth[0]);
    worst.add(sampled.g, truth[1]);
    worst.add(sampled.b, truth[2]);
    // With one bounce, at the surface of the glass, no path is scattered. The ray starts behind the surface by an
    // offset of 1.5e-6 of 9 m.
    const ColorMean attenuated = through(0.5f, 1);
    CHECK(attenuated.r.value() == doctest::Approx(truth[0]).epsilon(3e-5));
    CHECK(attenuated.g.value() == doctest::Approx(truth[1]).epsilon(3e-5));
    CHECK(attenuated.b.value() == doctest::Approx(truth[2]).epsilon(3e-5));
}

TEST_CASE("light that a slab without refraction scatters once") {
    constexpr float kAlbedo = 1e-4f;  // light scattered twice adds less than 1e-4
    Worst worst;
    for (const float g : {0.0f, 0.7f, -0.4f})
        for (const double thickness : {0.3, 2.0}) {
            CAPTURE(g);
            CAPTURE(thickness);
            Scene scene = slab(thickness, {1, 2, 4}, grey(kAlbedo), g);
            set_upper_sky(scene);
            const ColorMean mean = radiance(scene, {{0, 1, 0}, {0, -1, 0}}, 3, kGlassSamples);
            // Chandrasekhar 1960, chapter VII, section 47: radiance in the direction of the normal of light from mu,
            // mu / (4 pi (mu + 1)) p (1 - exp(-tau (1 + 1 / mu))) per solid angle; the light is turned by more than 90
            // degrees.
            const auto truth = [&](double extinction) {
                const double tau = extinction * thickness;
                return Rule::integrate(
                    [&](double mu) {
                        return 2 * M_PI * phase(static_cast<double>(g), -mu) * mu / (mu + 1) *
                               (1 - std::exp(-tau * (1 + 1 / mu)));
                    },
                    0.0, 1.0, 15, 1e-9);
            };
            const auto over_albedo = [&](Mean channel) {
                channel.sum /= static_cast<double>(kAlbedo);
                channel.squares /= static_cast<double>(kAlbedo) * static_cast<double>(kAlbedo);
                return channel;
            };
            worst.add(over_albedo(mean.r), truth(1));
            worst.add(over_albedo(mean.g), truth(2));
            worst.add(over_albedo(mean.b), truth(4));
        }
    hold({"Samplers", "light that a slab of glass scatters once: mean against quadrature",
          "18 means of 2^17 paths: three phase functions, two thicknesses, three channels", "core", "float32",
          worst.errors, kErrors, "standard errors"});
}

TEST_CASE("light of a point light inside of scattering glass") {
    Worst worst;
    for (const float g : {0.0f, 0.8f}) {
        CAPTURE(g);
        const Color extinction = {0.2f, 0.3f, 0.6f}, scattering = 0.5f * extinction;
        Scene scene;
        add_glass(scene, {-40, -40, -80}, {40, 40, 0}, glass_of(extinction - scattering, scattering, g, 1));
        const Vec3d lamp = {1, 0.5, -3};
        scene.points = {{lamp, {7, 7, 7}}};
        const Vec3d direction = normalized(Vec3d{0.1, 0.05, -1});
        // The ray starts 1 m in front of the glass; one bounce at the glass, and one scattering.
        const Vec3d origin = (-1 / -direction.z) * direction;
        const ColorMean mean =
            radiance(scene, {static_cast<Vec3f>(origin), static_cast<Vec3f>(direction)}, 1, kGlassSamples);
        const auto truth = [&](float sigma) {
            // The light leaves the glass after at least 8 free paths elsewhere.
            return 0.5 * scattered_once({0, 0, 0}, direction, 80, static_cast<double>(sigma), static_cast<double>(g),
                                        lamp, [](Vec3d) { return 7.0; });
        };
        worst.add(mean.r, truth(extinction.r));
        worst.add(mean.g, truth(extinction.g));
        worst.add(mean.b, truth(extinction.b));
    }
}

TEST_CASE("a lamp inside of scattering glass is found by light samples and by paths" * doctest::test_suite("slow")) {
    // With one bounce, only light samples find the lamp. With two, scattered paths find it, too.
    Worst worst;
    for (const float g : {0.0f, 0.9f}) {
        CAPTURE(g);
        constexpr float kAlbedo = 1e-5f;
        Scene scene;
        add_glass(scene, {-40, -40, -80}, {40, 40, 0}, glass_of(grey(0.3f), grey(0.3f * kAlbedo), g, 1));
        scene.materials.push_back({});
        scene.materials[1].diffuse = {0, 0, 0};
        scene.materials[1].emission = {5, 5, 5};
        const Vec3d u{1.5, 0, 0}, v{0, 1.5, 0}, corner{0.5, -0.75, -4};
        add_quad(scene, corner, corner + u, corner + u + v, corner + v, 1);
        const double truth = Rule::integrate(
            [&](double s) {
                return Rule::integrate(
                    [&](double t) {
                        return length(cross(u, v)) * scattered_once({0, 0, 0}, {0, 0, -1}, 4, 0.3 * (1 + 1e-5),
                                                                    static_cast<double>(g), corner + s * u + t * v,
                                                                    [](Vec3d d) { return 5 * std::max(0.0, d.z); });
                    },
                    0.0, 1.0, 5, 1e-6);
            },
            0.0, 1.0, 5, 1e-6);
        for (const int bounces : {1, 2}) {
            Mean mean = radiance(scene, {{0, 0, 1}, {0, 0, -1}}, bounces, 4 * kGlassSamples).g;
            mean.sum /= static_cast<double>(kAlbedo);
            mean.squares /= static_cast<double>(kAlbedo) * static_cast<double>(kAlbedo);
            worst.add(mean, truth);
        }
    }
    hold({"Samplers", "light that glass scatters once from a lamp inside of it: mean against quadrature",
          "4 means of 2^19 paths: light samples, and both samples combined", "core", "float32", worst.errors, kErrors,
          "standard errors"});
}

TEST_CASE("a deep slab without refraction reflects as a semi-infinite medium") {
    Worst worst;
    for (const double mu : {1.0, 0.4}) {
        CAPTURE(mu);
        const Color albedo = {0.3f, 0.7f, 0.9f};
        Scene scene = slab(30, {1, 2, 4}, albedo, 0);
        scene.environment.constant = {1, 1, 1};
        const double sine = std::sqrt(1 - mu * mu);
        const Vec3f direction = static_cast<Vec3f>(Vec3d{sine, -mu, 0});
        const ColorMean mean = radiance(scene, {{0, 1, 0}, direction}, 64, kGlassSamples);
        // Reflectance of uniform light in one direction: Chandrasekhar 1960 by reciprocity, or Hapke 1981, eq. 19. The
        // sides and the bottom are at least 16 diffusion lengths away.
        const auto truth = [&](float a) {
            const double omega = static_cast<double>(a);
            return 1 - std::sqrt(1 - omega) * h_function(omega, mu);
        };
        worst.add(mean.r, truth(albedo.r));
        worst.add(mean.g, truth(albedo.g));
        worst.add(mean.b, truth(albedo.b));
    }
    hold({"Samplers", "light that deep glass scatters any number of times: mean against Chandrasekhar's H function",
          "6 means of 2^17 paths of up to 64 bounces: two directions, three albedos and extinctions", "core", "float32",
          worst.errors, kErrors, "standard errors"});
}

TEST_CASE("the H function has its mean in closed form") {
    // Chandrasekhar 1960, chapter V, theorem 1.
    for (const double albedo : {0.3, 0.7, 0.9})
        CHECK(Rule::integrate([&](double mu) { return h_function(albedo, mu); }, 0.0, 1.0, 5, 1e-9) ==
              doctest::Approx(2 / albedo * (1 - std::sqrt(1 - albedo))).epsilon(1e-6));
}

TEST_CASE("glass that only scatters does not change a uniform enclosure" * doctest::test_suite("slow")) {
    Worst worst;
    for (const float ior : {1.0f, 1.5f})
        for (const float g : {0.0f, 0.8f})
            for (const Color scattering : {Color{1, 1, 1}, Color{0.2f, 1, 3}}) {
                CAPTURE(ior);
                CAPTURE(g);
                Scene box = emitting_box({-2, -2, -2}, {2, 2, 2}, {3, 3, 3});
                add_glass(box, {-0.5, -0.6, -0.4}, {0.5, 0.4, 0.6}, glass_of({0, 0, 0}, scattering, g, ior));
                const Ray ray{{1.4f, 1.1f, 1.3f}, {-1, -0.8f, -0.9f}};
                const ColorMean in_box = radiance(box, ray, 64, kGlassSamples);
                Scene sky;
                add_glass(sky, {-0.5, -0.6, -0.4}, {0.5, 0.4, 0.6}, box.materials[1]);
                sky.environment.constant = {3, 3, 3};
                const ColorMean under_sky = radiance(sky, ray, 64, kGlassSamples);
                for (const ColorMean& mean : {in_box, under_sky}) {
                    worst.add(mean.r, 3);
                    worst.add(mean.g, 3);
                    worst.add(mean.b, 3);
                }
            }
    hold({"Samplers", "glass of albedo 1 in a uniform enclosure",
          "48 means of 2^17 paths: walls and sky, with and without refraction, three channels", "core", "float32",
          worst.errors, kErrors, "standard errors"});
}

TEST_CASE("each lane of a block takes the path of a block of one, in scattering glass") {
    for (const AddedLight& light : kAddedLights) {
        CAPTURE(light.name);
        Scene scene = lamp_room();
        light.add(scene);
        add_glass(scene, {-0.5, 0.1, -0.5}, {0.5, 0.9, 0.5}, glass_of({0.1f, 0, 0}, {1, 2, 3}, 0.3f, 1.4f));
        // The tolerance is that of test_glossy_lanes: the rounding of six directions.
        for (const PathSettings& settings : kFollowedSettings) check_lanes<SceneKind::any>(scene, settings, 2e-4f);
    }
}
