#pragma once
#include <cstdint>

namespace realcam {

inline constexpr int kWarpSize = 32;  ///< threads

/// Mapping of a launch's threads to pixels. Each warp covers a small rectangle of pixels, so that its rays traverse the
/// same part of the scene. `lanes` threads share a pixel's samples.
struct WarpTiles {
    int lanes, width, height;  ///< threads per pixel; width and height of a warp's rectangle in pixels

    /// `lanes_per_pixel`: a power of two up to kWarpSize.
    __host__ __device__ explicit WarpTiles(int lanes_per_pixel) : lanes(lanes_per_pixel), width(1), height(1) {
        for (int pixels = kWarpSize / lanes; pixels > 1; pixels /= 2) (width > height ? height : width) *= 2;
    }
    // Numbers of rectangles that cover a part of the picture: along its rows and along its columns.
    __host__ __device__ std::int64_t across(int columns) const { return (columns + width - 1) / width; }
    __host__ __device__ std::int64_t down(int rows) const { return (rows + height - 1) / height; }

    /// Position of a pixel, which may lie beyond the part's last column or row.
    struct Pixel {
        int column, row;
    };
    /// Returns the pixel of a thread of the launch, in a part of the picture with this many columns.
    __device__ Pixel pixel_of(std::int64_t thread, int columns) const {
        const std::int64_t warp = thread / kWarpSize, tiles = across(columns);
        const int index = static_cast<int>(thread % kWarpSize) / lanes;
        return {static_cast<int>(warp % tiles) * width + index % width,
                static_cast<int>(warp / tiles) * height + index / width};
    }
};

/// Returns the sum of a value over the `lanes` consecutive threads of the warp that share a pixel; all threads of the
/// warp must call it.
template <class T>
__device__ T sum_of_neighbours(T value, int lanes) {
    for (int step = lanes / 2; step > 0; step /= 2) value += __shfl_xor_sync(0xffffffffu, value, step);
    return value;
}

}  // namespace realcam
