#pragma once
#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

/// The camera's own rays, sample by sample of pixel by pixel. Arrays lie where the rays are made, on the host or on a
/// device.
struct RayRequest {
    CameraView camera;
    std::int32_t first_pixel, pixel_count;
    std::uint32_t sample_count, seed;
    float *origins, *directions;  ///< 3 for each ray: metres in the placed scene; unit
    float* weights;               ///< irradiance on the film for unit radiance; 0: blocked

    REALCAM_HD std::int64_t count() const { return static_cast<std::int64_t>(pixel_count) * sample_count; }
};

/// Makes the N rays from `first` on; fewer at the end of the arrays.
template <int N>
REALCAM_HD inline void generate_rays_of(const RayRequest& request, std::int64_t first) {
    SampleBlock<N> block;
    CameraRays<N> rays;
    const int used = static_cast<int>(request.count() - first < N ? request.count() - first : N);
    for (int k = 0; k < N; ++k) {
        const std::int64_t ray = first + (k < used ? k : 0);
        const auto pixel = static_cast<std::int32_t>(request.first_pixel + ray / request.sample_count);
        block.column[k] = pixel % request.camera.width;
        block.row[k] = pixel / request.camera.width;
        block.used[k] = k < used;
        block.stream[k] = pixel_stream(pixel, request.seed);
        block.sample[k] = static_cast<std::uint32_t>(ray % request.sample_count);
    }
    generate_rays(request.camera, block, rays);
    for (int k = 0; k < used; ++k) {
        const Vec3f o = rays.origin[k], d = rays.direction[k];
        float* out_origin = request.origins + 3 * (first + k);
        float* out_direction = request.directions + 3 * (first + k);
        out_origin[0] = o.x, out_origin[1] = o.y, out_origin[2] = o.z;
        out_direction[0] = d.x, out_direction[1] = d.y, out_direction[2] = d.z;
        request.weights[first + k] = rays.passed[k] ? rays.weight[k] : 0.0f;
    }
}

}  // namespace REALCAM_NAMESPACE
