// Derivatives of pictures by the numbers of their camera, against closed forms, and against central differences with
// common random numbers. Each is estimated with 16 seeds, whose spread is its standard error. An estimate is held
// to 4.5 standard errors; the seeds are fixed. Without the term of the pupil's outline, the derivatives by translation
// and stop must fail.

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "doctest/doctest.h"
#include "embree/picture_gradient.hpp"
#include "optics/lens/focus.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kGradientErrors = 4.5;
constexpr int kSeeds = 16;

/// Numbers of a camera behind its variables, as PictureGradient orders them.
enum Number : std::size_t {
    kFilm = 0,
    kRight = 6,
    kUp = 7,
    kBackward = 8,
    kPitch = 9,
    kYaw = 10,
    kRoll = 11,
    kStop = 12
};

struct Estimate {
    double value = 0, error = 0;  ///< mean over the seeds and its standard error
};

/// Mean of f(seed) over the seeds.
Estimate estimate(const std::function<double(std::uint32_t)>& f) {
    double values[kSeeds], sum = 0, squares = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) sum += values[seed] = f(seed);
    for (const double value : values) squares += (value - sum / kSeeds) * (value - sum / kSeeds);
    return {sum / kSeeds, std::sqrt(squares / (kSeeds * (kSeeds - 1)))};
}

RenderSettings direct_light(PixelFilter filter = PixelFilter::tent) {
    RenderSettings settings;
    settings.filter = filter;
    settings.effects = EffectChoice{};
    settings.max_bounces = 0;
    return settings;
}

/// Adds a rectangle in the plane z that faces +z, with the same emission everywhere.
void add_rectangle(Scene& scene, Vec2d low, Vec2d high, double z, Color emission, double turn = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
    const double c = std::cos(turn), s = std::sin(turn);
    for (const Vec2d& at : {low, {high.x, low.y}, high, {low.x, high.y}})
        scene.positions_m.push_back({c * at.x - s * at.y, s * at.x + c * at.y, z});
    Material material;
    material.diffuse = {0, 0, 0};
    material.emission = emission;
    const auto id = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(material);
    scene.triangles.push_back({{first, first + 1, first + 2}, id});
    scene.triangles.push_back({{first, first + 2, first + 3}, id});
}

/// Uniform light from everywhere. The triangle, which a scene must have, lies far behind the camera.
Assembly even_light() {
    Scene scene;
    scene.positions_m = {{0, 0, 900}, {1, 0, 900}, {0, 1, 900}};
    scene.triangles = {{{0, 1, 2}, 0}};
    scene.materials = {Material{}};
    scene.environment.constant = {1, 1, 1};
    return Assembly(scene);
}

/// Stripes at 3 m, and an edge at 1.4 m in front of them that crosses the picture of corner_camera.
Assembly occluded_stripes() {
    Scene scene;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> radiance(0.2f, 2.0f);
    for (int i = 0; i < 24; ++i)
        add_rectangle(scene, {-1.2 + 0.1 * i, -1.5}, {-1.1 + 0.1 * i, 1.5}, -3,
                      {radiance(random), radiance(random), radiance(random)}, 0.1);
    add_rectangle(scene, {-3, -3}, {0.3, 3}, -1.4, {0, 0, 0}, 0.3);
    return Assembly(scene);
}

/// A few pixels of the double Gauss, off its axis, where rims vignette.
Camera corner_camera(double f_number) {
    Camera camera;
    camera.lens = stopped_down(focused(io::read_lens("double-gauss-50mm"), 2000), f_number);
    camera.film = {0.8, 0.8, 8, 8, {10, 6}};
    camera.exposure_time_s = 1;
    return camera;
}

std::vector<float> random_adjoint(const Camera& camera) {
    std::vector<float> adjoint(static_cast<std::size_t>(3 * camera.film.width * camera.film.height));
    std::mt19937 random(1);
    for (float& a : adjoint) a = std::normal_distribution<float>()(random);
    return adjoint;
}

/// 1 in the pixels that are not at the picture's border, and 0 there.
std::vector<float> inner_pixels(const Camera& camera) {
    std::vector<float> adjoint;
    for (int y = 0; y < camera.film.height; ++y)
        for (int x = 0; x < camera.film.width; ++x)
            adjoint.insert(adjoint.end(), 3,
                           x > 0 && y > 0 && x + 1 < camera.film.width && y + 1 < camera.film.height ? 1.0f : 0.0f);
    return adjoint;
}

double product(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

/// Derivatives of sum(adjoint * picture) by some numbers of a camera.
struct Gradients {
    std::vector<Estimate> both, interior;

    Gradients(PictureGradient& of, const std::vector<float>& adjoint, int spp, int outline_spp) {
        std::vector<std::vector<double>> runs[2];
        for (std::uint32_t seed = 0; seed < kSeeds; ++seed)
            for (const bool boundary : {true, false})
                runs[boundary].push_back(
                    of.reverse(adjoint.data(), nullptr,
                               {.seed = seed, .spp = spp, .outline_spp = outline_spp, .boundary = boundary}, {}));
        for (std::size_t i = 0; i < of.number_count(); ++i) {
            both.push_back(estimate([&](std::uint32_t seed) { return runs[true][seed][i]; }));
            interior.push_back(estimate([&](std::uint32_t seed) { return runs[false][seed][i]; }));
        }
    }
};

/// Difference in standard errors.
double errors_between(const Estimate& a, const Estimate& b) {
    return std::fabs(a.value - b.value) / std::hypot(a.error, b.error);
}

using Change = std::function<void(Camera&, double)>;

/// Central difference of sum(adjoint * picture) with common random numbers.
Estimate difference(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                    const std::vector<float>& adjoint, const Change& change, double step, int spp) {
    Camera above = camera, below = camera;
    change(above, step);
    change(below, -step);
    PictureGradient to(scene, above, settings, {}), from(scene, below, settings, {});
    return estimate([&](std::uint32_t seed) {
        const GradientSamples samples{.seed = 1000 + seed, .spp = spp, .pairs = false};
        return (product(adjoint, to.picture(samples, {})) - product(adjoint, from.picture(samples, {}))) / (2 * step);
    });
}

Change translation(Vec3d axis) {
    return [axis](Camera& camera, double h) {
        camera.pose.position_m = h * axis;
        camera.pose.look_at_m = h * axis + Vec3d{0, 0, -1};
    };
}

}  // namespace

TEST_CASE("a picture of even light does not depend on the camera's pose: interior and boundary cancel") {
    const Camera camera = corner_camera(4);
    PictureGradient gradient(even_light(), camera, direct_light(), {});
    const Gradients found(gradient, inner_pixels(camera), 128, 64);
    for (std::size_t number = kRight; number <= kRoll; ++number) {
        CAPTURE(number);
        CHECK(std::fabs(found.both[number].value) < kGradientErrors * found.both[number].error + 1e-12);
    }
    for (const std::size_t number : {std::size_t{kRight}, std::size_t{kUp}, std::size_t{kBackward}}) {
        CAPTURE(number);
        CHECK(std::fabs(found.interior[number].value) > 2 * kGradientErrors * found.interior[number].error);
    }
    CHECK(gradient.unexplained_edges() == 0);
}

TEST_CASE("translation of a camera in front of a plane whose radiance is a linear function of x") {
    // A translation by e changes the radiance of each ray by the slope times e, and so the picture by the slope times
    // that of uniform light.
    constexpr double kSlope = 0.3;  // per metre
    Scene scene;
    scene.positions_m = {{-2, -2, -3}, {2, -2, -3}, {2, 2, -3}, {-2, 2, -3}};
    scene.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
    for (const Vec3d& at : scene.positions_m) {
        const auto radiance = static_cast<float>(1 + kSlope * at.x);
        scene.colors.push_back({{radiance, radiance, radiance}, 1});
    }
    Material material;
    material.diffuse = {0, 0, 0};
    material.emission = {1, 1, 1};
    material.vertex_emission = 1;
    scene.materials = {material};
    const Camera camera = corner_camera(2);
    PictureGradient gradient(Assembly(scene), camera, direct_light(PixelFilter::gaussian), {});
    const std::vector<float> adjoint = inner_pixels(camera);
    const Gradients found(gradient, adjoint, 128, 64);
    const Estimate uniform = estimate([&](std::uint32_t seed) {
        return product(adjoint, gradient.picture({.seed = seed, .spp = 64, .uniform = true}, {}));
    });
    const double per_mm = 1e-3 * kSlope;
    const Estimate wanted{per_mm * uniform.value, per_mm * uniform.error}, zero{0, 0};
    CHECK(errors_between(found.both[kRight], wanted) < kGradientErrors);
    CHECK(errors_between(found.interior[kRight], wanted) > kGradientErrors);
    CHECK(errors_between(found.both[kUp], zero) < kGradientErrors);
}

TEST_CASE("a knife edge in front of a thin lens, by pose, focus and stop") {
    // A lens of focal length f, thickness of 10 um and f/50, so that its aberrations and the cosines change the light
    // by 2e-4. A ray from the film point x through the point u of the lens meets the edge's plane, at the distance D,
    // at u (1 - D / a) - x D / b, where 1/a = 1/f - 1/b.
    constexpr double kFocal = 100, kRadius = 1, kFilm0 = 105, kPlane = 1000, kEdge = 0.02;
    const Glass glass = Glass::constant(1.5);
    const double curvature_radius = kFocal;  // of both faces: 1/f = (n - 1) 2 / r
    Camera camera;
    camera.lens = lens_of({stop_plane(0, 2), refracting(curvature_radius, 0.01, glass, 3),
                           refracting(-curvature_radius, 0, Glass::air(), 3)});
    camera.lens.stop_semi_diameter = kRadius;
    camera.lens.film_distance = kFilm0;
    camera.film = {0.32, 0.32, 8, 8, {0, 0}};
    camera.exposure_time_s = 1;
    // Metres from the film's centre; light on the side of negative x.
    Scene scene;
    const double z = -1e-3 * (kPlane + kFilm0);
    add_rectangle(scene, {-0.5, -0.5}, {1e-3 * kEdge, 0.5}, z, {1, 1, 1});
    const Assembly assembly(scene);
    const std::vector<float> adjoint = random_adjoint(camera);
    // Sum of adjoint times exposure; the picture's columns run against the film's x.
    const auto exposure = [&](double move, double film, double radius) {
        const double plane = kPlane + kFilm0 - film;  // the film's position in the scene is fixed
        const double a = 1 / (1 / kFocal - 1 / film), pitch = camera.film.width_mm / camera.film.width;
        const auto irradiance = [&](double x) {
            // Passing light: u (1 - D / a) - x D / b < edge - move.
            const double c = (kEdge - move + x * plane / film) / (1 - plane / a);
            const double cut = std::clamp(c / radius, -1.0, 1.0);
            const double below = (std::numbers::pi / 2 + std::asin(cut) + cut * std::sqrt(1 - cut * cut));
            return below * radius * radius / (film * film);
        };
        double sum = 0;
        for (int column = 0; column < camera.film.width; ++column) {
            double weight = 0;
            for (int row = 0; row < camera.film.height; ++row)
                for (int channel = 0; channel < 3; ++channel)
                    weight += static_cast<double>(
                        adjoint[static_cast<std::size_t>(3 * (row * camera.film.width + column) + channel)]);
            const double centre = pitch * (0.5 * camera.film.width - column - 0.5);
            constexpr int kSteps = 2000;
            for (int i = 0; i < kSteps; ++i) {
                const double t = 2 * (i + 0.5) / kSteps - 1;
                sum += weight * (1 - std::fabs(t)) * irradiance(centre + pitch * t) * 2 / kSteps;
            }
        }
        return sum;
    };
    const auto rate = [](const auto& f, double step) { return (f(step) - f(-step)) / (2 * step); };
    const double by_right = rate([&](double h) { return exposure(h, kFilm0, kRadius); }, 1e-3),
                 by_film = rate([&](double h) { return exposure(0, kFilm0 + h, kRadius); }, 1e-2),
                 by_stop = rate([&](double h) { return exposure(0, kFilm0, kRadius + h); }, 1e-3);
    PictureGradient gradient(assembly, camera, direct_light(), {{LensQuantity::film_distance, 0}});
    const Gradients found(gradient, adjoint, 256, 256);
    const auto check = [](const Estimate& value, double wanted) {
        CAPTURE(value.value);
        CAPTURE(value.error);
        CAPTURE(wanted);
        CHECK(std::fabs(value.value - wanted) < kGradientErrors * value.error + 1e-3 * std::fabs(wanted));
        CHECK(value.error < 0.1 * std::fabs(wanted));
    };
    check(found.both[1 + kRight], by_right);
    check(found.both[0], by_film);
    check(found.both[1 + kStop], by_stop);
}

TEST_CASE("derivatives of a picture with occlusion, defocus and vignetting equal central differences") {
    const Camera camera = corner_camera(4);
    const Assembly scene = occluded_stripes();
    const std::vector<LensVariable> variables = {{LensQuantity::curvature, 0},
                                                 {LensQuantity::thickness, 1},
                                                 {LensQuantity::index, 0},
                                                 {LensQuantity::film_distance, 0},
                                                 {LensQuantity::decentre, 3, 0}};
    const std::size_t count = variables.size();
    PictureGradient gradient(scene, camera, direct_light(), variables);
    const std::vector<float> adjoint = random_adjoint(camera);
    const Gradients found(gradient, adjoint, 512, 64);  // the interior alone is noisy for translations
    const auto surface = [](auto&& f) { return [f](Camera& c, double h) { f(c.lens.surfaces, h); }; };
    struct Case {
        std::size_t number;
        Change change;
        double step, unit;  ///< step of the change, and its unit in those of the number
        bool needs_boundary = false;
    };
    // Steps of the rotations are 0.05 pixels: steps five times as large have an error of several standard errors.
    const Case cases[] = {
        {0, surface([](auto& s, double h) { s[0].curvature += h; }), 2e-5, 1},
        {1, surface([](auto& s, double h) { s[1].thickness += h; }), 0.02, 1},
        {2, surface([](auto& s, double h) { s[0].material = Glass::constant(s[0].material.index(587.5618) + h); }),
         2e-4, 1},
        {3, [](Camera& c, double h) { c.lens.film_distance += h; }, 0.02, 1},
        {4, surface([](auto& s, double h) {
             s[3].placement.returns = true;
             s[3].placement.decentre.x += h;
         }),
         0.02, 1},
        {count + kFilm, [](Camera& c, double h) { c.film.shift_mm.x -= h; }, 0.02, 1},
        {count + kFilm + 3, [](Camera& c, double h) { c.lens.film_placement.tilt_deg.x += h; }, 0.3, kDegree},
        {count + kRight, translation({1, 0, 0}), 2e-4, 1e3, true},
        {count + kUp, translation({0, 1, 0}), 2e-4, 1e3},
        {count + kBackward, translation({0, 0, 1}), 1e-3, 1e3},
        {count + kPitch, [](Camera& c, double h) { c.pose.look_at_m = {0, std::sin(h), -std::cos(h)}; }, 1e-4, 1},
        {count + kYaw, [](Camera& c, double h) { c.pose.look_at_m = {-std::sin(h), 0, -std::cos(h)}; }, 1e-4, 1},
        {count + kRoll, [](Camera& c, double h) { c.pose.up = {-std::sin(h), std::cos(h), 0}; }, 2e-3, 1},
        {count + kStop, [](Camera& c, double h) { c.lens.stop_semi_diameter += h; }, 0.05, 1, true},
    };
    for (const Case& one : cases) {
        CAPTURE(one.number);
        Estimate wanted = difference(scene, camera, direct_light(), adjoint, one.change, one.step, 512);
        wanted.value /= one.unit;
        wanted.error /= one.unit;
        CHECK(errors_between(found.both[one.number], wanted) < kGradientErrors);
        if (one.needs_boundary) CHECK(errors_between(found.interior[one.number], wanted) > kGradientErrors);
    }
}

TEST_CASE("derivatives of a picture with dispersion equal central differences") {
    const Camera camera = corner_camera(4);
    const Assembly scene = occluded_stripes();
    RenderSettings settings = direct_light();
    settings.effects.dispersion = true;
    PictureGradient gradient(scene, camera, settings, {{LensQuantity::curvature, 0}, {LensQuantity::film_distance, 0}});
    const std::vector<float> adjoint = random_adjoint(camera);
    const Gradients found(gradient, adjoint, 64, 32);
    const auto check = [&](std::size_t number, const Change& change, double step, double unit) {
        CAPTURE(number);
        Estimate wanted = difference(scene, camera, settings, adjoint, change, step, 96);
        wanted.value /= unit;
        wanted.error /= unit;
        CHECK(errors_between(found.both[number], wanted) < kGradientErrors);
    };
    check(0, [](Camera& c, double h) { c.lens.surfaces[0].curvature += h; }, 2e-5, 1);
    check(1, [](Camera& c, double h) { c.lens.film_distance += h; }, 0.02, 1);
    check(2 + kRight, translation({1, 0, 0}), 2e-4, 1e3);
    check(2 + kYaw, [](Camera& c, double h) { c.pose.look_at_m = {-std::sin(h), 0, -std::cos(h)}; }, 5e-4, 1);
    check(2 + kStop, [](Camera& c, double h) { c.lens.stop_semi_diameter += h; }, 0.05, 1);
}
