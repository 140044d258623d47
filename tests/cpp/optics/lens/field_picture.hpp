#pragma once
// Picture that a camera takes of a uniform environment, from the camera's own rays and weights, and a check that these
// are finite; and the light on the axis by rays alone.

#include <cmath>
#include <string>
#include <vector>

#include "camera/camera_setup.hpp"
#include "embree/lens_rays.hpp"
#include "pixel_rays.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"

namespace realcam::test {

/// pi n^2 sin^2 of the angles behind the lens between which light reaches the film's middle, in a field of radiance 1:
/// the edges of the light along one meridian are bisected with single rays in double precision. A central obstruction
/// is an edge too.
inline double bisected_irradiance(const LensSystem& lens) {
    const RayTracer trace(lens, LightDirection::to_scene);
    const double n = lens.indices(lens.wavelength_nm).back();
    const auto passes = [&](double sine) {
        return trace({0, 0, lens.film_position()}, {sine, 0, -std::sqrt(1 - sine * sine)}).passed();
    };
    constexpr int kSteps = 4500;  // the narrowest beam, f/22, is a hundred of them wide
    double sum = 0;
    bool before = passes(0);
    for (int i = 1; i < kSteps; ++i) {
        double low = 0.9 * (i - 1) / kSteps, high = 0.9 * i / kSteps;
        const bool here = passes(high);
        if (here == before) continue;
        for (int k = 0; k < 50; ++k) {
            const double middle = 0.5 * (low + high);
            (passes(middle) == before ? low : high) = middle;
        }
        sum += (before ? 1 : -1) * M_PI * n * n * low * low;
        before = here;
    }
    return sum;
}

struct FieldPicture {
    double irradiance = 0;  ///< mean over the film, of a field of radiance 1 all around
    double passed = 0;  ///< share of the rays
    bool finite = true;
};

/// The camera's own rays into a uniform environment.
inline FieldPicture photograph(const LensSystem& lens, double film_mm, int pixels, std::uint32_t spp,
                               CameraModel model = CameraModel::full_lens) {
    Camera camera = camera_with(lens, model);
    camera.film = {film_mm, film_mm, pixels, pixels};
    const std::size_t count = static_cast<std::size_t>(pixels * pixels) * spp;
    std::vector<double> origins(3 * count), times(count);
    std::vector<float> directions(3 * count), weights(count), wavelengths(count);
    generate_camera_rays(CameraSetup(camera, fast_pupil_tracer()), spp, 3, all_rays(pixels, pixels, spp),
                         {origins.data(), directions.data(), weights.data(), wavelengths.data(), times.data()});
    FieldPicture picture;
    for (std::size_t i = 0; i < count; ++i) {
        const double weight = static_cast<double>(weights[i]);
        picture.irradiance += weight / static_cast<double>(count);
        picture.passed += (weight > 0) / static_cast<double>(count);
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
            picture.finite &= std::isfinite(origins[k]) && std::isfinite(directions[k]) && std::isfinite(weight);
    }
    return picture;
}

/// Message of the error of a camera that cannot take the picture.
inline std::string camera_error(const LensSystem& lens, CameraModel model = CameraModel::full_lens) {
    return message_of([&] { photograph(lens, 10, 4, 16, model); });
}

}  // namespace realcam::test
