#pragma once
#include "../scene/environment.hpp"
#include "../scene/scene_view.hpp"

namespace REALCAM_NAMESPACE {

/// sample_environment_image for many random numbers at once, vectorised.
template <int N>
class EnvironmentSamples {
public:
    REALCAM_INLINE EnvironmentSamples(const EnvironmentView& environment, const Vec2Lanes<float, N>& u, int slots)
        : environment_(environment) {
        Lanes<std::int32_t, N> begin;
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) begin[i] = 0;
        choose_from_cdfs(environment.marginal_cdf, begin, environment.height, u.y, slots, row_);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) begin[i] = row_.index[i] * (environment.width + 1);
        choose_from_cdfs(environment.conditional_cdf, begin, environment.width, u.x, slots, column_);
        for (int i = 0; i < slots; ++i)
            radiance_.set(i, pixel_radiance(environment, {row_.index[i], column_.index[i]}));
    }

    REALCAM_INLINE LightSample operator[](int slot) const {
        return sample_in_pixel(environment_, row_[slot], column_[slot], radiance_[slot]);
    }

private:
    const EnvironmentView& environment_;
    CdfChoices<N> row_, column_;
    ColorLanes<N> radiance_;
};

}  // namespace REALCAM_NAMESPACE
