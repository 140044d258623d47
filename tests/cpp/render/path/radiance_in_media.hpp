#pragma once
// Radiance along a ray in a scene with media, by path tracing, and closed forms to compare it with.

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "../followed_paths.hpp"
#include "estimator_mean.hpp"

namespace realcam::test {

using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;

/// Means of the three channels.
struct ColorMean {
    Mean r, g, b;
    void add(Color c) {
        r.add(static_cast<double>(c.r));
        g.add(static_cast<double>(c.g));
        b.add(static_cast<double>(c.b));
    }
};

struct Ray {
    Vec3f origin, direction;
};

/// Radiance along a ray by independent paths; Sobol' points would make the standard error an overestimate.
inline ColorMean radiance(const Assembly& assembly, const Ray& ray, int max_bounces, int samples) {
    constexpr int kLanes = 128;
    const BothTraversals traversals(assembly);
    const BvhRays rays{traversals.bvh()};
    const SceneView scene = traversals.scene();
    PathSettings settings;
    settings.max_bounces = max_bounces;
    ColorMean mean;
    for (int first = 0; first < samples; first += kLanes) {
        SampleBlock<kLanes> block;
        PathState<kLanes> path;
        PathResults<kLanes> results;
        for (int i = 0; i < kLanes; ++i) {
            block.column[i] = block.row[i] = 0;
            block.used[i] = 1;
            block.stream[i] = hash32(static_cast<std::uint32_t>(first + i));
            block.sample[i] = 0;
            path.rays.origin.set(i, ray.origin);
            path.rays.direction.set(i, normalized(ray.direction));
            path.rays.far[i] = kFarAway;
            path.rays.active[i] = 1;
            path.rays.time[i] = 0;
            path.weight[i] = 1;
            path.throughput.set(i, {1, 1, 1});
            path.pdf[i] = kFromFilm;
            path.interior[i] = nullptr;
            results.irradiance.set(i, {0, 0, 0});
            results.depth[i] = kFarAway;
            results.weight[i] = 1;
        }
        for (int bounce = 0; advance_paths<SceneKind::any>(scene, CameraView{}, settings, block, bounce, rays,
                                                           NoProbe(), path, results);)
            ++bounce;
        for (int i = 0; i < kLanes; ++i) mean.add(results.irradiance[i]);
    }
    return mean;
}

inline Air air_of(Color extinction, Color albedo, float anisotropy) {
    Air air;
    air.extinction = extinction;
    air.albedo = albedo;
    air.anisotropy = anisotropy;
    return air;
}

/// Black walls that emit on their inner side.
inline Scene emitting_box(Vec3d low, Vec3d high, Color radiance) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].diffuse = {0, 0, 0};
    scene.materials[0].emission = radiance;
    scene.materials[0].emits_on_both_sides = 1;
    const auto corner = [&](int x, int y, int z) {
        return Vec3d{x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z};
    };
    for (const int end : {0, 1}) {
        add_quad(scene, corner(end, 0, 0), corner(end, 1, 0), corner(end, 1, 1), corner(end, 0, 1), 0);
        add_quad(scene, corner(0, end, 0), corner(1, end, 0), corner(1, end, 1), corner(0, end, 1), 0);
        add_quad(scene, corner(0, 0, end), corner(1, 0, end), corner(1, 1, end), corner(0, 1, end), 0);
    }
    return scene;
}

/// A black triangle far behind the rays of these tests.
inline Scene nothing_in_view() {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].diffuse = {0, 0, 0};
    scene.positions_m = {{0, 0, 900}, {1, 0, 900}, {0, 1, 900}};
    scene.triangles = {{{0, 1, 2}, 0}};
    return scene;
}

inline double phase(double g, double cosine) {
    return (1 - g * g) / (4 * M_PI * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// Radiance that the air scatters once towards the ray's origin, over the albedo, of a lamp at `at` with the intensity
/// `intensity(direction from the lamp)`.
template <class Intensity>
double scattered_once(Vec3d origin, Vec3d direction, double length, double extinction, double g, Vec3d at,
                      Intensity&& intensity) {
    const Vec3d offset = at - origin;
    const double along = dot(offset, direction), nearest = std::clamp(along, 0.0, length),
                 beyond = std::min(nearest + 2 * std::sqrt(dot(offset, offset) - along * along), length);
    const auto integrand = [&](double t) {
        const Vec3d to_lamp = at - (origin + t * direction);
        const double d = std::sqrt(dot(to_lamp, to_lamp));
        return extinction * std::exp(-extinction * (t + d)) * phase(g, dot(direction, to_lamp) / d) *
               intensity((-1 / d) * to_lamp) / (d * d);
    };
    double sum = 0, from = 0;
    for (const double to : {nearest, beyond, length}) {
        if (to > from) sum += Rule::integrate(integrand, from, to, 15, 1e-9);
        from = to;
    }
    return sum;
}

}  // namespace realcam::test
