#pragma once
// A camera around a lens, and the rays of one of its pixels.

#include <cstdint>

#include "camera/film/camera.hpp"
#include "camera/models/generate_rays.hpp"

namespace realcam::test {

inline constexpr int kLanes = 64;
inline constexpr CameraModel kModels[] = {CameraModel::pinhole, CameraModel::thin_lens, CameraModel::thick_lens,
                                          CameraModel::full_lens};

inline Camera camera_with(const LensSystem& lens, CameraModel model) {
    Camera camera;
    camera.lens = lens;
    camera.film = {lens.film_width, lens.film_height, 96, 64};
    camera.model = model;
    return camera;
}

// One block of samples of one pixel.
inline CameraRays<kLanes> rays_of_pixel(const CameraView& view, int column, int row, std::uint32_t first_sample = 0) {
    SampleBlock<kLanes> block;
    for (int i = 0; i < kLanes; ++i) {
        block.column[i] = column;
        block.row[i] = row;
        block.used[i] = 1;
        block.stream[i] = pixel_stream(row * view.width + column, 0);
        block.sample[i] = first_sample + static_cast<std::uint32_t>(i);
    }
    CameraRays<kLanes> rays;
    generate_rays<LensKind::rotational>(view, block, rays);
    return rays;
}

}  // namespace realcam::test
