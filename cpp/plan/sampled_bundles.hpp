#pragma once
#include <array>
#include <cmath>

#include "../camera/generate_rays.hpp"
#include "../optics/pupil/pupil_tracer.hpp"

namespace REALCAM_NAMESPACE {

/// Ray bundle of one film point, traced into the scene through one camera model.
struct SampledBundle {
    static constexpr int kRays = PupilTracer::kBlock;

    std::array<LensFrameRay, kRays> rays;
    std::array<bool, kRays> passes{};
    double light = 0;  ///< irradiance for unit radiance
};

/// Intersection of a bundle with a plane of the scene.
struct BundleSpot {
    double x, y;      ///< centre, as the film point at which a lens without aberrations would image it, mm
    double diameter;  ///< of a uniform disc with the same mean square radius, mm on the film
};

namespace sampled_bundles_detail {

inline Vec2f pupil_number(int ray) {
    return sample_2d(0x9e3779b9u, static_cast<std::uint32_t>(ray), dimension::pupil);
}

}  // namespace sampled_bundles_detail

/// `ray_of(u)`: ray of an ideal lens for the pupil sample `u`.
template <class RayOf>
SampledBundle ideal_bundle(RayOf&& ray_of) {
    SampledBundle bundle;
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const auto k = static_cast<std::size_t>(i);
        bundle.rays[k] = ray_of(sampled_bundles_detail::pupil_number(i));
        bundle.passes[k] = true;
        bundle.light += static_cast<double>(bundle.rays[k].weight) / SampledBundle::kRays;
    }
    return bundle;
}

/// Bundle through every surface. `path`: lens from the film to the scene, at one wavelength; `camera`: view that holds
/// the pupil.
inline SampledBundle traced_bundle(const CameraView& camera, const LensView<float>& path, Vec2f film,
                                   const PupilTracer& tracer) {
    PupilTracer::Rays inside;
    float weights[SampledBundle::kRays];
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const Vec2f u = sampled_bundles_detail::pupil_number(i);
        const FilmRaySample ray = sample_film_ray<LensKind::any>(camera, film, u);
        inside.origin.set(i, ray.origin);
        inside.direction.set(i, ray.direction);
        inside.status[i] = ray.weight > 0 ? 0 : static_cast<int>(RayStatus::vignetted);
        weights[i] = ray.weight;
    }
    tracer.trace(path, inside);
    SampledBundle bundle;
    for (int i = 0; i < SampledBundle::kRays; ++i) {
        const auto k = static_cast<std::size_t>(i);
        bundle.passes[k] = inside.status[i] == 0;
        if (!bundle.passes[k]) continue;
        bundle.rays[k] = {inside.origin[i], normalized(inside.direction[i]), weights[i]};
        bundle.light += static_cast<double>(weights[i]) / SampledBundle::kRays;
    }
    return bundle;
}

/// `distance_mm`: distance of the plane from the front vertex; may be infinite. Members are NaN if no light passes.
inline BundleSpot spot_of(const SampledBundle& bundle, const CircleOfConfusion& circle, double distance_mm) {
    const bool is_far = !(distance_mm < 1e30);
    // Size in that plane, or slope at infinity, of a film height of 1 mm.
    const double scale =
        is_far ? static_cast<double>(circle.middle_slope)
               : static_cast<double>(circle.middle) + distance_mm * static_cast<double>(circle.middle_slope);
    double sum = 0, x = 0, y = 0, square = 0;
    for (std::size_t k = 0; k < bundle.rays.size(); ++k) {
        if (!bundle.passes[k]) continue;
        const Vec3d o = static_cast<Vec3d>(bundle.rays[k].origin_mm), d = static_cast<Vec3d>(bundle.rays[k].direction);
        const double slope_x = d.x / -d.z, slope_y = d.y / -d.z, distance = distance_mm + o.z;
        const double at_x = (is_far ? slope_x : o.x + distance * slope_x) / scale;
        const double at_y = (is_far ? slope_y : o.y + distance * slope_y) / scale;
        const auto weight = static_cast<double>(bundle.rays[k].weight);
        sum += weight;
        x += weight * at_x;
        y += weight * at_y;
        square += weight * (at_x * at_x + at_y * at_y);
    }
    x /= sum;
    y /= sum;
    return {x, y, 2 * std::sqrt(2 * std::fmax(square / sum - x * x - y * y, 0.0))};
}

}  // namespace REALCAM_NAMESPACE
