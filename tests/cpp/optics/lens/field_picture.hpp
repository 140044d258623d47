#pragma once
// Picture that a camera takes of a uniform environment, from the camera's own rays and weights, and a check that these
// are finite.

#include <cmath>
#include <string>
#include <vector>

#include "camera/camera_setup.hpp"
#include "embree/lens_rays.hpp"
#include "pixel_rays.hpp"
#include "refusal.hpp"

namespace realcam::test {

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
