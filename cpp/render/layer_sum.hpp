#pragma once

#include "../math/color.hpp"

namespace REALCAM_NAMESPACE {

/// What one sample of a pixel saw first.
template <int N>
struct LayerResults {
    Lanes<float, N> weight;  ///< of the sample in the exposure; 0: blocked in the lens
    Lanes<std::int32_t, N> met;  ///< 1 where there is a surface
    Vec3Lanes<float, N> normal;  ///< shading normal, unit, scene axes, on the side from which it is seen
    ColorLanes<N> albedo;
    Lanes<float, N> circle_mm;  ///< of confusion, diameter on the film
};

/// What the layers of one pixel have collected, weighted as the samples are in the exposure.
struct LayerSum {
    double weight;  ///< of all samples that passed the lens
    double met;     ///< of those that met a surface
    double normal[3], albedo[3];  ///< over those that met one
    double circle_mm;             ///< over all

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

/// The nearest surface in a pixel's middle ray.
struct MiddleSurface {
    float depth;   ///< metres along the axis from the film; infinite: nothing there; NaN: no ray passes the lens
    Vec3f normal;  ///< as in LayerResults; 0 where there is no surface
    std::uint32_t triangle;  ///< kNoTriangle where there is no surface
    std::uint32_t instance;  ///< kNoInstance: of static geometry
    std::uint32_t material;  ///< in the list of the scene or object that the triangle is a part of
    Vec3f position;  ///< in the placed scene; where there is no surface, the direction of the ray
};

}  // namespace REALCAM_NAMESPACE
