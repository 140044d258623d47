#pragma once
#include "dispersed_rays.hpp"

namespace REALCAM_NAMESPACE {

// Light that geometrical optics brings to a film point reaches the points around it, too, as the lens's aperture
// diffracts it. So a sample of a film point looks for light from another one, that far away. The distance grows with
// the wavelength, so each sample has one.

/// Film points from which samples look into the lens.
template <int N>
struct DiffractedPoints {
    Vec2Lanes<float, N> points;  ///< mm
    Vec2Lanes<float, N> kicks;   ///< from them to the places of the samples, mm for each nm of wavelength
    Lanes<std::int32_t, N> from_edge;  ///< 1: see DiffractionKick

    REALCAM_INLINE Vec2f operator[](int lane) const { return points[lane]; }
    REALCAM_INLINE Vec2f landing(int lane, Vec2f at, float nm) const {
        const Vec2f kick = kicks[lane];
        return {at.x + nm * kick.x, at.y + nm * kick.y};
    }
};

/// Draws them. What would come from beyond the film is looked for at the sample's own place instead, so that no light
/// is lost at the margins.
template <int N>
REALCAM_HD inline void diffract(const CameraView& camera, const SampleBlock<N>& block, const float (&nm)[N],
                                DiffractedPoints<N>& film) {
    const DiffractionView view = camera.diffraction;
    const float reach_squared = view.largest_radius * view.largest_radius;
    const PixelPoints<N> samples(camera, block);
    const LaneNumbers<N> u(block, dimension::diffraction), v(block, dimension::diffraction + 1);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f place = samples[i];
        const DiffractionKick kick = draw_kick(view, place, u[i], v[i]);
        const Vec2f from = {place.x - nm[i] * kick.mm_per_nm.x, place.y - nm[i] * kick.mm_per_nm.y};
        const bool on_film = from.x * from.x + from.y * from.y < reach_squared;
        film.points.set(i, {select(on_film, from.x, place.x), select(on_film, from.y, place.y)});
        film.kicks.set(i, {select(on_film, kick.mm_per_nm.x, 0.0f), select(on_film, kick.mm_per_nm.y, 0.0f)});
        film.from_edge[i] = select(on_film, kick.from_edge, 0);
    }
}

}  // namespace REALCAM_NAMESPACE
