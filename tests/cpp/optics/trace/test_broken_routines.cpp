// Deliberately broken copies of the routines that test_hard_surfaces.cpp and test_float32_error.py bound, in float32 as
// textbooks print them: each goes past its bound. So those tests can fail, and the core's forms are needed.

#include <cmath>
#include <functional>

#include "backward_error.hpp"
#include "measurement.hpp"
#include "traced_ray.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

constexpr double kUlp = 0x1p-23;

Vec3f float32_of(Vec3d v) {
    return static_cast<Vec3f>(v);
}

/// Ray parameter of the hit with a sphere of radius `radius` around (0, 0, radius), for a unit direction.
using Intersection = std::function<float(Vec3f o, Vec3f d, float radius)>;

float quadratic_formula(Vec3f o, Vec3f d, float radius) {
    const float c = 1 / radius;
    const float A = c * dot(d, d), B = 2 * (c * dot(o, d) - d.z), C = c * dot(o, o) - 2 * o.z;
    return (-B - std::sqrt(B * B - 4 * A * C)) / (2 * A);
}

float from_the_centre(Vec3f o, Vec3f d, float radius) {
    const Vec3f from = {o.x, o.y, o.z - radius};
    const float along = dot(from, d), power = dot(from, from) - radius * radius;
    const float root = std::sqrt(along * along - power);
    return radius > 0 ? -along - root : -along + root;
}

/// Worst distance from the surface, in units in the last place of the scale, over random rays and spheres.
double worst_off_surface(const Intersection& meet, double least_radius, double most_radius) {
    Random random(3);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const double radius = std::exp(random.between(std::log(least_radius), std::log(most_radius)));
        const Surface surface = refracting(radius, 0, Glass::constant(1.7), 20);
        const Vec3f o = float32_of({random.between(-20, 20), random.between(-20, 20), -40});
        const Vec3f d = float32_of(normalized(Vec3d{random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1}));
        const float t = meet(o, d, static_cast<float>(radius));
        const Vec3f at = o + t * d;
        const double off =
            std::fabs(static_cast<double>(OracleSurface(surface).distance(exact(static_cast<Vec3d>(at)))));
        worst = std::isfinite(off) ? std::max(worst, off / (kUlp * 60)) : kInfinity;
    }
    return worst;
}

}  // namespace

TEST_CASE("the quadratic formula as it is taught loses nearly plane surfaces") {
    breaks({"Surfaces", "quadratic formula as it is taught, curvature 1e-12 to 1e-6 per mm", "500 rays", "broken copy",
            "float32", worst_off_surface(quadratic_formula, 1e6, 1e12), 4, "ulp of scale"});
}

TEST_CASE("a sphere met from its far centre of curvature is lost in the distance") {
    breaks({"Surfaces", "from the centre of curvature, radius 1e3 to 1e6 mm", "500 rays", "broken copy", "float32",
            worst_off_surface(from_the_centre, 1e3, 1e6), 12, "ulp of scale"});
}

TEST_CASE("Newton's method without a bracket takes points that are not on the surface") {
    Random random(5);
    double worst = 0;
    for (int s = 0; s < 100; ++s) {
        Surface surface = refracting(random.between(8, 50), 0, Glass::constant(1.7), 6);
        for (int i = 0; i < 8; ++i) surface.aspheric.push_back(random.between(-1, 1) * std::pow(6.0, -3 - 2 * i));
        const LensPath<float> path(lens_of({surface}), LightDirection::to_film, kLineD_nm);
        const SurfaceView<float> step = path.view().surfaces[0];
        for (int i = 0; i < 20; ++i) {
            const Vec3f o = float32_of({random.between(-5, 5), random.between(-5, 5), -10});
            const Vec3f d = float32_of(normalized(Vec3d{random.between(-1, 1), random.between(-1, 1), 1}));
            float t = -o.z / d.z;
            for (int k = 0; k < 20; ++k) {
                const Vec3f at = o + t * d;
                const Sag<float> sag = asphere_sag(step, at.x * at.x + at.y * at.y);
                t -= (at.z - sag.height) / (d.z - 2 * sag.derivative * (at.x * d.x + at.y * d.y));
            }
            const Vec3d at = static_cast<Vec3d>(o + t * d);
            if (std::hypot(at.x, at.y) > surface.clear_semi_diameter) continue;
            worst = std::max(worst, std::fabs(at.z - surface.sag(std::hypot(at.x, at.y))) / (kUlp * 20));
        }
    }
    breaks({"Surfaces", "Newton's method without a bracket, sag that turns back", "2000 rays", "broken copy", "float32",
            worst, 16, "ulp of scale"});
}

TEST_CASE("Snell's law with the source paper's misprint is another law") {
    // Equation 3 prints mu (1 - cos^2) under the root, where mu^2 is needed.
    const double mu = 1 / 1.7, angle = 0.5;
    const Vec3d d{std::sin(angle), 0, std::cos(angle)}, normal{0, 0, 1};
    const Vec3d bent = mu * d + (std::sqrt(1 - mu * (1 - d.z * d.z)) - mu * d.z) * normal;
    const double amiss = length(cross(d, normal) - 1.7 * cross(normalized(bent), normal));
    breaks({"Surfaces", "Snell's law as the source paper prints it", "1 ray", "broken copy", "float64", amiss / 0x1p-52,
            36, "ulp"});
}

TEST_CASE("a refraction that takes the ray's length from the glass table blurs a fast telephoto lens") {
    const LensSystem lens = io::read_lens("telephoto-200mm-inner-focus");
    const LensPath<float> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const std::vector<double> n = lens.indices(lens.wavelength_nm);
    const RayTracer back(lens, LightDirection::to_film);
    Random random(1);
    double worst_um = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d film = point_on_film(lens, random), aim = point_on_last_surface(lens, random);
        Vec3f o = float32_of({film.x, film.y, lens.film_distance});
        const Vec3d start{static_cast<double>(o.x), static_cast<double>(o.y),
                          lens.last_vertex() + static_cast<double>(o.z)};
        Vec3f p = float32_of(normalized(aim - start));
        bool passes = true;
        for (int k = 0; k < path.view().count && passes; ++k) {
            const SurfaceView<float>& step = path.view().surfaces[k];
            const double before = n[static_cast<std::size_t>(step.surface_index) + 1],
                         after = n[static_cast<std::size_t>(step.surface_index)];
            o.z -= step.shift;
            const auto squared = static_cast<float>(before * before);
            const float c = step.curvature, F = c * dot(o, o) - 2 * o.z, G = p.z - c * dot(o, p), A = c * squared;
            const float s = -std::sqrt(G * G - A * F);
            o = o + (G <= 0 ? F / (G + s) : (G - s) / A) * p;
            const float radicand = static_cast<float>((after - before) * (after + before)) + s * s;
            p = p + (-std::sqrt(radicand) - s) * Vec3f{-c * o.x, -c * o.y, 1 - c * o.z};
            passes = radicand > 0 && o.x * o.x + o.y * o.y <= step.rim_squared;
        }
        if (!passes) continue;
        const TracedRay image = back(static_cast<Vec3d>(o), -static_cast<Vec3d>(p));
        if (!image.passed()) continue;
        const Vec3d there = image.at(start.z);
        worst_um = std::max(worst_um, 1000 * std::hypot(there.x - start.x, there.y - start.y));
    }
    breaks({"Bundled lenses", "refraction with the ray's length from the glass table, telephoto-200mm-inner-focus",
            "20000 rays", "broken copy", "float32", worst_um, 0.08, "um"});
}
