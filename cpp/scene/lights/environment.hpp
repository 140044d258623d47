#pragma once
#include "../../math/cdf.hpp"
#include "../../math/sampling.hpp"
#include "../materials/light_sample.hpp"
#include "../scene_view.hpp"

namespace REALCAM_NAMESPACE {

// Radiance of the environment and sampling of its directions, uniform or by the map's pixels.

struct EnvironmentPixel {
    int row, column;
};

/// Pixel of the environment map in a direction (unit).
REALCAM_INLINE EnvironmentPixel environment_pixel(const EnvironmentView& environment, Vec3f direction) {
    constexpr float kTurnsPerRadian = 0.1591549431f, kHalfTurnsPerRadian = 0.3183098862f;  // 1 / (2 pi), 1 / pi
    const float u = 0.5f + std::atan2(direction.x, -direction.z) * kTurnsPerRadian;
    const float v = std::acos(select(direction.y > 1.0f, 1.0f, select(direction.y < -1.0f, -1.0f, direction.y))) *
                    kHalfTurnsPerRadian;
    const int row = static_cast<int>(v * static_cast<float>(environment.height));
    const int column = static_cast<int>(u * static_cast<float>(environment.width));
    return {select(row < environment.height, row, environment.height - 1),
            select(column < environment.width, column, environment.width - 1)};
}

/// Radiance of a pixel, cd/m^2.
REALCAM_INLINE Color pixel_radiance(const EnvironmentView& environment, EnvironmentPixel pixel) {
    return environment.pixels[static_cast<std::int64_t>(pixel.row) * environment.width + pixel.column];
}

/// Radiance of the environment in a direction, cd/m^2.
REALCAM_INLINE Color environment_radiance(const EnvironmentView& environment, Vec3f direction) {
    if (!environment.pixels) return environment.constant;
    return pixel_radiance(environment, environment_pixel(environment, direction));
}

/// Cumulative probabilities of the pixels of a row: width + 1 values.
REALCAM_INLINE const float* conditional_cdf_of(const EnvironmentView& environment, int row) {
    return environment.conditional_cdf + static_cast<std::int64_t>(row) * (environment.width + 1);
}

/// Solid-angle density of a direction sampled inside a pixel chosen with `probability`; `sine` is the sine of the polar
/// angle.
REALCAM_INLINE float pixel_pdf(const EnvironmentView& environment, float probability, float sine) {
    constexpr float kMapArea = 19.7392088f;  // 2 pi^2, the area of the map in azimuth times polar angle
    const float area = kMapArea / (static_cast<float>(environment.width) * static_cast<float>(environment.height));
    return probability / (area * sine);
}

/// Density of sample_environment_image, per steradian, in a direction inside this pixel.
REALCAM_INLINE float environment_image_pdf(const EnvironmentView& environment, EnvironmentPixel pixel,
                                           Vec3f direction) {
    const float* row = environment.marginal_cdf + pixel.row;
    const float* column = conditional_cdf_of(environment, pixel.row) + pixel.column;
    const float sine = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    return pixel_pdf(environment, (row[1] - row[0]) * (column[1] - column[0]), sine);
}

/// Density of sample_environment_image, per steradian, in any direction.
REALCAM_INLINE float environment_image_pdf(const EnvironmentView& environment, Vec3f direction) {
    return environment_image_pdf(environment, environment_pixel(environment, direction), direction);
}

/// Samples a direction uniformly inside the chosen pixel, with the random numbers that remain of the two choices.
/// `radiance`: of that pixel.
REALCAM_INLINE LightSample sample_in_pixel(const EnvironmentView& environment, CdfChoice row, CdfChoice column,
                                           Color radiance) {
    // Position in the map, 0 to 1 from its upper left corner.
    const float u = (static_cast<float>(column.index) + column.fresh) / static_cast<float>(environment.width);
    const float v = (static_cast<float>(row.index) + row.fresh) / static_cast<float>(environment.height);
    // Cosines and sines of the two angles. The azimuth is counted from the map's left edge, +z.
    const Vec2f azimuth = cos_sin_of_turn(u);
    // v may round to 1, where the sine is zero.
    const Vec2f polar = cos_sin_of_turn(0.5f * select(v < 0.99999994f, v, 0.99999994f));
    const float pdf = pixel_pdf(environment, row.probability * column.probability, polar.y);
    return {{-polar.y * azimuth.y, polar.x, polar.y * azimuth.x}, kFarAway, 1.0f, (1.0f / pdf) * radiance, pdf};
}

/// Samples an environment map: chooses a pixel in proportion to its power (environment_tables), and a direction inside
/// it.
REALCAM_INLINE LightSample sample_environment_image(const EnvironmentView& environment, Vec2f u) {
    const CdfChoice row = choose_from_cdf(environment.marginal_cdf, environment.height, u.y);
    const CdfChoice column = choose_from_cdf(conditional_cdf_of(environment, row.index), environment.width, u.x);
    return sample_in_pixel(environment, row, column, pixel_radiance(environment, {row.index, column.index}));
}

/// Density of sample_environment, per steradian. `normal`: see sample_environment.
REALCAM_INLINE float environment_pdf(const EnvironmentView& environment, Vec3f normal, Vec3f direction) {
    if (environment.pixels) return environment_image_pdf(environment, direction);
    return dot(normal, normal) > 0.0f ? cosine_pdf(normal, direction) : kSpherePdf;
}

/// Samples a direction to the environment: a map by its power, and a constant environment by the cosine at the
/// receiver. `normal`: of the receiver; zero: directions of a constant environment are uniform.
REALCAM_INLINE LightSample sample_environment(const EnvironmentView& environment, Vec3f normal, Vec2f u) {
    if (environment.pixels) return sample_environment_image(environment, u);
    const Vec3f direction = dot(normal, normal) > 0.0f ? sample_cosine(normal, u) : sample_sphere(u);
    const float pdf = environment_pdf(environment, normal, direction);
    return {direction, kFarAway, 1.0f, (pdf > 0.0f ? 1.0f / pdf : 0.0f) * environment.constant, pdf};
}

}  // namespace REALCAM_NAMESPACE
