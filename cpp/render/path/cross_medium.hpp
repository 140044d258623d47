#pragma once
#include <cmath>

#include "../../scene/lights/attenuation.hpp"
#include "../../scene/lights/light.hpp"
#include "../../scene/materials/phase_function.hpp"

namespace REALCAM_NAMESPACE {

// Scattering of light by a medium, the air or the interior of glass, along one ray of a path. Each ray takes two
// independent samples:
//
// - Light that the medium scatters once: a point on the ray, sampled towards a light (equiangular sampling, Kulla and
//   Fajardo 2012) or by the transmittance, and a light sample there.
// - The continuation of the path: to the surface that the ray hits, or to a point of the medium (distance
//   sampling), where the phase function is sampled.
//
// Emitters that the scattered ray hits are also found by the light samples, and the two are combined by multiple
// importance sampling. Both densities are conditional on the light towards which points are sampled; that light is
// chosen once for both, so that the weights of the two sum to 1.

/// Distance to the next scattering along a ray in a medium, where the ray's length limits the distance: a mixture of
/// the three channels' exponential distributions, in the proportions of the path's throughput.
class FreePath {
public:
    REALCAM_INLINE FreePath(Color extinction, Color throughput, float length)
        : extinction_(extinction), length_(length) {
        const float sum = throughput.r + throughput.g + throughput.b;
        shares_ = sum > 0.0f ? (1.0f / sum) * throughput : grey(1.0f / 3.0f);
        scattered_ = {-std::expm1(-length * extinction.r), -std::expm1(-length * extinction.g),
                      -std::expm1(-length * extinction.b)};
    }

    /// Probability of scattering before the end of the ray.
    REALCAM_INLINE float scattering_probability() const { return sum_of(shares_ * scattered_); }
    /// Density of scattering at a distance, per metre.
    REALCAM_INLINE float density(float distance) const {
        return sum_of(shares_ * extinction_ * transmittance(extinction_, distance));
    }
    /// Samples a distance with the density over the scattering probability, which must not be 0.
    REALCAM_INLINE float sample(float u) const {
        float chance = u * scattering_probability();
        const float red = shares_.r * scattered_.r, green = shares_.g * scattered_.g, blue = shares_.b * scattered_.b;
        if (chance < red) return sample_channel(chance / red, scattered_.r, extinction_.r);
        chance -= red;
        if (chance < green || !(blue > 0.0f)) return sample_channel(chance / green, scattered_.g, extinction_.g);
        return sample_channel((chance - green) / blue, scattered_.b, extinction_.b);
    }
    /// Returns the transmittance to the end of the ray over the probability of reaching it.
    REALCAM_INLINE Color weight_at_end() const {
        const Color passed = transmittance(extinction_, length_);
        const float probability = sum_of(shares_ * passed);
        return (probability > 0.0f ? 1.0f / probability : 0.0f) * passed;
    }

private:
    REALCAM_INLINE static float sum_of(Color c) { return c.r + c.g + c.b; }
    /// Samples the exponential distribution of a channel. `scattered`: its scattering probability.
    REALCAM_INLINE float sample_channel(float u, float scattered, float extinction) const {
        // Rounding may bring u to 1.
        const float distance = -std::log1p(-below_one(u) * scattered) / extinction;
        return select(distance < length_, distance, length_);
    }

    Color extinction_, shares_, scattered_;
    float length_;
};

/// Distribution of points on a ray that is uniform in the angle at which they are seen from a centre, such as a lamp
/// (Kulla and Fajardo 2012).
class Equiangular {
public:
    /// `direction`: unit vector; `length`: of the ray, m; `radius`: size of the lamp, m, at which the angle is limited.
    REALCAM_INLINE Equiangular(Vec3f origin, Vec3f direction, float length, Vec3f centre, float radius) {
        const Vec3f offset = centre - origin;
        nearest_ = dot(offset, direction);
        const Vec3f across = offset - nearest_ * direction;
        // Near the lamp, inside it and behind it, the density need not rise.
        height_ = at_least(std::sqrt(dot(across, across) + radius * radius), 1e-4f * std::fabs(nearest_) + 1e-12f);
        length_ = length;
        first_ = std::atan2(-nearest_, height_);
        range_ = std::atan2(length - nearest_, height_) - first_;
    }

    /// False if the ray is too short or too far away for the angles to be distinct.
    REALCAM_INLINE bool is_useful() const { return range_ > 1e-6f; }
    /// Samples a distance along the ray, m.
    REALCAM_INLINE float sample(float u) const {
        const float distance = nearest_ + height_ * std::tan(first_ + u * range_);
        return select(distance < length_, at_least(distance, 0.0f), length_);
    }
    /// Density of a distance, per metre.
    REALCAM_INLINE float density(float distance) const {
        const float along = distance - nearest_;
        return height_ / (range_ * (height_ * height_ + along * along));
    }

private:
    float nearest_, height_, length_;  ///< distance of the point nearest to the centre, and its distance from it, m
    float first_, range_;  ///< angle from that point to the ray's begin, and to its end less that, seen from the centre
};

/// Random numbers for one ray in a medium.
struct MediumNumbers {
    Vec2f point, light, path;  ///< pairs of random numbers in [0, 1)
    std::uint32_t seed;  ///< random bits
};

/// Result of cross_medium: effect of the medium on a path along one ray.
struct MediumCrossing {
    LightSample light;  ///< sample of a light at `scattering_point`
    Vec3f scattering_point;
    Color from_light = {0, 0, 0};  ///< radiance that the medium scatters from that light along the path, times the
                                   ///< throughput, if nothing occludes the light; black: none
    float scattered_at =
        -1.0f;  ///< distance at which the medium scatters the path, m; negative: it reaches the surface
    Color weight = {1, 1, 1};  ///< factor of the path's throughput
    /// If the path is scattered: density of its scattering point over that of the point with the light sample.
    float density_ratio = 1.0f;
};

/// A ray of a path.
struct MediumRay {
    Vec3f origin, direction;  ///< unit direction
    float length;  ///< m; kFarAway if the ray hits nothing
    float time;  ///< fraction of the exposure
    Color throughput;  ///< of the path
    const Material* interior = nullptr;  ///< PathState::interior
};

namespace cross_medium_detail {

/// Returns the distribution of points towards a light that was picked; it is not useful for lights at infinity.
REALCAM_INLINE Equiangular toward_light(const SceneView& scene, const LightPick& pick, Vec3f start, Vec3f direction,
                                        float length, float time) {
    if (pick.probability > 0.0f && pick.kind == LightKind::point)
        return {start, direction, length, point_light_at(scene, scene.points[pick.index], time).position, 0.0f};
    if (pick.probability > 0.0f && pick.kind == LightKind::area) {
        const AreaLight light = area_light_at<SceneKind::any>(scene, pick.index, time);
        return {start, direction, length, light.corner + (1.0f / 3.0f) * (light.edge_u + light.edge_v),
                std::sqrt(kInvPi * light.area)};
    }
    return {start, direction, 0.0f, start, 1.0f};
}

}  // namespace cross_medium_detail

/// Takes both samples of a ray in the medium around it. `may_scatter`: false if the path ends at the next point that
/// would scatter it; it then goes on to the surface.
REALCAM_GPU_CALL MediumCrossing cross_medium(const SceneView& scene, MediumRay ray, bool may_scatter, MediumNumbers u) {
    using namespace cross_medium_detail;
    const Medium medium = medium_around(scene.air, ray.interior);
    MediumCrossing crossing;
    const MediumInterval inside = medium_interval(scene.air, ray.interior, ray.origin, ray.direction, ray.length);
    const FreePath free_path(medium.extinction, ray.throughput, inside.length);
    const float probability = free_path.scattering_probability();
    if (!(probability > 0.0f)) return crossing;
    const Vec3f start = ray.origin + inside.begin * ray.direction;
    const auto receiver_at = [&](float distance) -> LightReceiver {
        return {start + distance * ray.direction, {0, 0, 0}, ray.time};
    };
    // Light from infinity does not reach the interior of glass along a straight line.
    const bool has_light =
        ray.interior ? scene.light_node_count > 0 : realcam::has_light(scene, SkySampling::chosen, 0);
    // The light towards which points are sampled is chosen by its illuminance at a random point of the ray.
    const LightReceiver middle = receiver_at(free_path.sample(u.point.y));
    LightPick pick{LightKind::environment, 0, 0.0f, {0, 0}};
    if (has_light) {
        const Vec2f number = {unit_float(hash32(u.seed, 1)), 0.0f};
        pick = pick_light(scene, middle, light_kinds(scene, SkySampling::chosen, middle), 0, number, hash32(u.seed, 2));
    }
    const Equiangular toward = toward_light(scene, pick, start, ray.direction, inside.length, ray.time);
    const float share = toward.is_useful() ? 0.5f : 0.0f;  // of points that are sampled towards the light
    const auto point_density = [&](float distance) {
        const float by_transmittance = free_path.density(distance) / probability;
        return share > 0.0f ? share * toward.density(distance) + (1.0f - share) * by_transmittance : by_transmittance;
    };
    if (has_light) {
        const float distance = u.point.x < share ? toward.sample(remapped_random(u.point.x, share))
                                                 : free_path.sample(remapped_random(u.point.x - share, 1.0f - share));
        const LightReceiver receiver = receiver_at(distance);
        crossing.scattering_point = receiver.position;
        crossing.light =
            sample_light<SceneKind::any>(scene, SkySampling::chosen, receiver, 0, u.light, hash32(u.seed, 3));
        crossing.light.irradiance *= transmittance_to_light(scene.air, ray.interior, receiver.position, crossing.light);
        const float density = point_density(distance),
                    phase = henyey_greenstein(medium.anisotropy, dot(ray.direction, crossing.light.direction));
        const float other = may_scatter ? free_path.density(distance) / density * phase : 0.0f;
        crossing.from_light = (mis_weight(crossing.light.pdf, other) * phase / density) * ray.throughput *
                              medium.scattering * transmittance(medium.extinction, distance) *
                              crossing.light.irradiance;
    }
    if (!may_scatter) {
        crossing.weight = transmittance(medium.extinction, inside.length);
    } else if (u.path.x < probability) {
        const float distance = free_path.sample(remapped_random(u.path.x, probability)),
                    density = free_path.density(distance);
        crossing.scattered_at = inside.begin + distance;
        crossing.weight = (1.0f / density) * medium.scattering * transmittance(medium.extinction, distance);
        crossing.density_ratio = density / point_density(distance);
    } else {
        crossing.weight = free_path.weight_at_end();
    }
    return crossing;
}

}  // namespace REALCAM_NAMESPACE
