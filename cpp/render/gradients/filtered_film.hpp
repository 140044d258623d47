#pragma once
#include <array>

#include "../../camera/film/pixel_filter.hpp"
#include "../../math/color.hpp"
#include "../../math/vec3.hpp"

namespace REALCAM_NAMESPACE {

/// Calls f(index of the pixel, value of its filter, derivatives of that value along columns and rows) for each pixel of
/// a picture that a film point counts for. `at`: the film point, in pixels from the picture's upper left corner.
template <class F>
REALCAM_INLINE void for_filtered_pixels(PixelFilter filter, int width, int height, Vec2f at, F&& f) {
    const FilterWeights columns(filter, at.x), rows(filter, at.y);
    for (int j = 0; j < FilterWeights::kMost; ++j) {
        const int row = rows.first + j;
        if (row < 0 || row >= height || rows.of[j].value == 0) continue;
        for (int i = 0; i < FilterWeights::kMost; ++i) {
            const int column = columns.first + i;
            if (column < 0 || column >= width || columns.of[i].value == 0) continue;
            const FilterValue x = columns.of[i], y = rows.of[j];
            f(row * width + column, x.value * y.value, Vec2f{x.slope * y.value, x.value * y.slope});
        }
    }
}

/// Adjoint picture, as a function of the film: the sum over the pixels of their filters times their adjoints, the
/// derivatives of a function of the picture by the pixels.
struct AdjointFilm {
    PixelFilter filter;
    int width, height;
    const float* adjoint;  ///< height x width x 3
    const float* control;  ///< height x width: sum over the channels of the adjoint times a control variate of the
                           ///< radiance; null: none

    /// Returns the first-order change of the function by a sample at a film point, and the gradient of that change
    /// along columns and rows. `light`: the sample's weight times its radiance. If M is 2, the second element is that
    /// of the light less the control variate, which has the same `weight`, and must exist.
    template <int M>
    REALCAM_INLINE std::array<Vec3f, M> changes(Vec2f at, Color light, float weight) const {
        std::array<Vec3f, M> sums{};
        for_filtered_pixels(filter, width, height, at, [&](int pixel, float value, Vec2f slope) {
            const float* a = adjoint + 3 * pixel;
            const float of_light = a[0] * light.r + a[1] * light.g + a[2] * light.b;
            const Vec3f of_filter = {value, slope.x, slope.y};
            sums[0] += of_light * of_filter;
            if constexpr (M == 2) sums[1] += (of_light - weight * control[pixel]) * of_filter;
        });
        return sums;
    }
};

/// True if one of AdjointFilm::changes depends on the film point.
template <std::size_t M>
REALCAM_INLINE bool has_gradient(const std::array<Vec3f, M>& changes) {
    for (const Vec3f& change : changes)
        if (change.y != 0 || change.z != 0) return true;
    return false;
}

}  // namespace REALCAM_NAMESPACE
