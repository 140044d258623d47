#pragma once
#include "effects/rays_with_effects.hpp"
#include "models/exposed_rays.hpp"

namespace REALCAM_NAMESPACE {

// A dual pixel has two photodiodes under one micro-lens, which makes an image of the exit pupil on them: one sees the
// left half of the pupil, the other the right one (R. Garg et al., ICCV 2019, section 3). Here that image is ideal:
// micro-lenses are shifted towards the middle of the film, so that light from the axis of the pupil falls between the
// diodes all over the film, and no light is lost between them.

/// Sets `is_right` to 1 for samples that pass the right half of the exit pupil, as the photographer looks through the
/// lens. The paraxial pupil is halved; where rims vignette it, one half gets less light, as in a real camera.
template <Effects effects, int N>
REALCAM_HD inline void find_right_half(const CameraView& camera, const SampleBlock<N>& block,
                                       Lanes<std::int32_t, N>& is_right) {
    WavelengthsWith<N, effects> wavelengths;
    if constexpr (effects.have_wavelengths()) draw_wavelengths(camera.dispersion, block, wavelengths);
    const FilmPointsWith<N, effects> film(camera, block, wavelengths);
    const LaneNumbers<N> u(block, dimension::pupil);
    const bool uses_real_pupil = has_real_pupil(camera.model);
    // Compares slopes instead of points in the pupil, which also holds for a pupil behind the film (negative distance).
    const float inverse_distance = 1.0f / camera.thick.exit_pupil_distance;
    for (int i = 0; i < N; ++i) {
        float right;
        if (uses_real_pupil) {
            const FilmRaySample ray = sample_film_ray<LensKind::any>(camera, film[i], u[i]);
            right = ray.origin.x * inverse_distance - ray.direction.x / ray.direction.z;
        } else {
            right = sample_disc(u[i]).x;
        }
        is_right[i] = right > 0.0f ? 1 : 0;
    }
}

/// Range of a camera's rays, in row-major order of the pixels, with spp rays for each pixel.
struct RayRange {
    std::int64_t first, count;
};

inline RayRange all_rays(int width, int height, std::uint32_t spp) {
    return {0, static_cast<std::int64_t>(width) * height * spp};
}

/// Request for the rays of a camera: the samples of a pixel are consecutive. Arrays are in the memory of the host or
/// device that generates the rays.
struct RayRequest {
    CameraView camera;
    RayRange range;
    std::uint32_t spp, seed;  ///< samples per pixel; seed of the random sequence
    float *origins, *directions;  ///< 3 for each ray: metres in render space; unit vectors
    float* weights;  ///< irradiance on the film for unit radiance; 0: blocked
    float* times;  ///< as fractions of the camera's exposure
    float* wavelengths_nm;  ///< wavelength of each ray
    float design_wavelength_nm;  ///< used for all rays if the camera has no dispersion

    REALCAM_HD std::int64_t count() const { return range.count; }
};

/// Generates N rays of the range, from its `first` on; fewer at the end of the range. `lens_kind`: LensKind::any if
/// needs_general_lens_code(camera), else rotational.
template <LensKind lens_kind, int N>
REALCAM_HD inline void generate_rays_of(const RayRequest& request, std::int64_t first) {
    SampleBlock<N> block;
    CameraRays<N> rays;
    const int used = static_cast<int>(request.count() - first < N ? request.count() - first : N);
    for (int k = 0; k < N; ++k) {
        const std::int64_t ray = request.range.first + first + (k < used ? k : 0);
        const auto pixel = static_cast<std::int32_t>(ray / request.spp);
        block.column[k] = pixel % request.camera.width;
        block.row[k] = pixel / request.camera.width;
        block.used[k] = k < used;
        block.stream[k] = pixel_stream(pixel, request.seed);
        block.sample[k] = static_cast<std::uint32_t>(ray % request.spp);
    }
    float times[N];
    Lanes<float, N> wavelengths_nm;
    if (request.camera.dispersion.cells) {
        SampleWavelengths<N> wavelengths;
        draw_wavelengths(request.camera.dispersion, block, wavelengths);
        generate_rays_with<lens_kind, Effects{.dispersion = true}>(
            request.camera, block, PixelPoints<N>(request.camera, block), wavelengths, rays);
        expose_rays(request.camera, block, rays, times);
        for (int k = 0; k < N; ++k) wavelengths_nm[k] = wavelengths.nm[k];
    } else {
        generate_exposed_rays<lens_kind>(request.camera, block, rays, times);
        for (int k = 0; k < N; ++k) wavelengths_nm[k] = request.design_wavelength_nm;
    }
    for (int k = 0; k < used; ++k) {
        const Vec3f o = rays.origin[k], d = rays.direction[k];
        float* out_origin = request.origins + 3 * (first + k);
        float* out_direction = request.directions + 3 * (first + k);
        out_origin[0] = o.x, out_origin[1] = o.y, out_origin[2] = o.z;
        out_direction[0] = d.x, out_direction[1] = d.y, out_direction[2] = d.z;
        request.weights[first + k] = rays.passed[k] ? rays.weight[k] : 0.0f;
        request.times[first + k] = times[k];
        request.wavelengths_nm[first + k] = wavelengths_nm[k];
    }
}

}  // namespace REALCAM_NAMESPACE
