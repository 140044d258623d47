#pragma once
#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

// Rays of an exposure during which something moves: each has its own time, as a fraction of the exposure, and starts
// from the camera's pose at that time.

/// Sets the time of each lane's ray, as a fraction of the exposure. `within(lane)`: time within the exposure of the
/// lane's row of pixels, from 0 to 1.
template <int N, class Within>
REALCAM_INLINE void set_times(const CameraView& camera, const SampleBlock<N>& block, float (&times)[N],
                              Within&& within) {
    for (int i = 0; i < N; ++i)
        times[i] = static_cast<float>(block.row[i]) * camera.row_time + camera.exposed_time * within(i);
}

/// Moves rays from the camera's pose at the start of the exposure to that at their times.
template <int N>
REALCAM_INLINE void move_rays(const CameraView& camera, const float (&times)[N], CameraRays<N>& rays) {
    if (camera.key_count == 0) return;
    for (int i = 0; i < N; ++i) {
        const CameraFrame moved = camera_at(camera, times[i]);
        const auto rotated = [&](Vec3f v) {
            return dot(v, camera.right) * moved.right + dot(v, camera.up) * moved.up +
                   dot(v, camera.backward) * moved.backward;
        };
        rays.origin.set(i, moved.position + rotated(rays.origin[i] - camera.position));
        rays.direction.set(i, rotated(rays.direction[i]));
    }
}

/// Samples times of rays, stratified over the exposure of each pixel, and moves the rays.
template <int N>
REALCAM_HD inline void expose_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays,
                                   float (&times)[N]) {
    if (camera.exposed_time > 0.0f) {
        const LaneNumbers<N> u(block, dimension::time);
        set_times(camera, block, times, [&](int i) { return u[i].x; });
    } else {
        set_times(camera, block, times, [](int) { return 0.0f; });
    }
    move_rays(camera, times, rays);
}

/// generate_rays, followed by expose_rays.
template <LensKind lens_kind, int N>
REALCAM_HD inline void generate_exposed_rays(const CameraView& camera, const SampleBlock<N>& block, CameraRays<N>& rays,
                                             float (&times)[N]) {
    generate_rays<lens_kind>(camera, block, rays);
    expose_rays(camera, block, rays, times);
}

}  // namespace REALCAM_NAMESPACE
