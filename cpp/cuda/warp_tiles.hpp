#pragma once
#include <cstdint>

namespace realcam {

inline constexpr int kWarpSize = 32;

/// Where the threads of a launch stand in the picture. Warps are side by side, each over a small rectangle of pixels,
/// so its rays meet the same part of the scene. `lanes` threads share a pixel's samples.
struct WarpTiles {
    int lanes, width, height;  ///< threads of a pixel; pixels of a warp

    __host__ __device__ explicit WarpTiles(int lanes_per_pixel) : lanes(lanes_per_pixel), width(1), height(1) {
        for (int pixels = kWarpSize / lanes; pixels > 1; pixels /= 2) (width > height ? height : width) *= 2;
    }
    __host__ __device__ std::int64_t across(int columns) const { return (columns + width - 1) / width; }
    __host__ __device__ std::int64_t down(int rows) const { return (rows + height - 1) / height; }

    struct Pixel {
        int column, row;
    };
    /// The pixel of a thread, by its number in the launch, over a part of the picture with so many columns.
    __device__ Pixel pixel_of(std::int64_t thread, int columns) const {
        const std::int64_t warp = thread / kWarpSize, tiles = across(columns);
        const int place = static_cast<int>(thread % kWarpSize) / lanes;
        return {static_cast<int>(warp % tiles) * width + place % width,
                static_cast<int>(warp / tiles) * height + place / width};
    }
};

template <class T>
__device__ T sum_of_neighbours(T value, int lanes) {
    for (int step = lanes / 2; step > 0; step /= 2) value += __shfl_xor_sync(0xffffffffu, value, step);
    return value;
}

}  // namespace realcam
