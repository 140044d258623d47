#pragma once

#include "../../math/color.hpp"

namespace REALCAM_NAMESPACE {

/// First surface that each sample of a block hits, one lane per sample.
template <int N>
struct LayerResults {
    Lanes<float, N> weight;  ///< weight of the sample in the exposure; 0: blocked in the lens
    Lanes<std::int32_t, N> met;  ///< 1 if a surface was hit
    Vec3Lanes<float, N> normal;  ///< shading normal, unit, scene axes, on the visible side
    ColorLanes<N> albedo;
    Lanes<float, N> circle_mm;  ///< diameter of the circle of confusion on the film; also set if no surface was hit
};

/// Accumulated layers of one pixel, weighted as its samples are in the exposure.
struct LayerSum {
    double weight;  ///< sum of the weights of all samples that passed the lens
    double met;     ///< sum of the weights of the samples that hit a surface
    double normal[3], albedo[3];  ///< weighted sums over the samples that hit a surface
    double circle_mm;             ///< weighted sum over all samples that passed the lens

    REALCAM_HD LayerSum& operator+=(const LayerSum& other) {
        weight += other.weight;
        met += other.met;
        for (int c = 0; c < 3; ++c) normal[c] += other.normal[c];
        for (int c = 0; c < 3; ++c) albedo[c] += other.albedo[c];
        circle_mm += other.circle_mm;
        return *this;
    }

    template <int N>
    REALCAM_INLINE void add(const LayerResults<N>& results, int lane) {
        const double w = static_cast<double>(results.weight[lane]);
        if (!(w > 0)) return;
        weight += w;
        circle_mm += w * static_cast<double>(results.circle_mm[lane]);
        if (!results.met[lane]) return;
        met += w;
        normal[0] += w * static_cast<double>(results.normal.x[lane]);
        normal[1] += w * static_cast<double>(results.normal.y[lane]);
        normal[2] += w * static_cast<double>(results.normal.z[lane]);
        albedo[0] += w * static_cast<double>(results.albedo.r[lane]);
        albedo[1] += w * static_cast<double>(results.albedo.g[lane]);
        albedo[2] += w * static_cast<double>(results.albedo.b[lane]);
    }
};

/// Nearest surface on the ray of a pixel's centre.
struct PixelCentreSurface {
    float depth;   ///< metres along the axis from the film; infinite: no surface; NaN: no ray passes the lens
    Vec3f normal;  ///< as in LayerResults; 0 if there is no surface
    std::uint32_t triangle;  ///< kNoTriangle if there is no surface
    std::uint32_t instance;  ///< kNoInstance for static geometry
    std::uint32_t material;  ///< index in the scene or object to which the triangle belongs
    Vec3f position;  ///< in render space; without a surface, the direction of the ray
};

}  // namespace REALCAM_NAMESPACE
