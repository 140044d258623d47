#pragma once
#include "../dispersion/dispersed_rays.hpp"

namespace REALCAM_NAMESPACE {

// The aperture diffracts the light of a film point to the points around it. So the sample of a film point looks through
// the lens from another film point, displaced by a random offset (kick). The offset is proportional to the wavelength,
// so each sample has a wavelength.

/// Film points from which samples look through the lens, displaced by diffraction.
template <int N>
struct DiffractedPoints {
    Vec2Lanes<float, N> points;  ///< mm
    Vec2Lanes<float, N> kicks;  ///< offsets from `points` to the film points of the samples, mm per nm of wavelength
    Lanes<std::int32_t, N> from_edge;  ///< see DiffractionKick

    REALCAM_INLINE Vec2f operator[](int lane) const { return points[lane]; }
    /// Film point that light of a lane's sample and of the wavelength `nm` reaches if geometrical optics brings it to
    /// `at`.
    REALCAM_INLINE Vec2f landing(int lane, Vec2f at, float nm) const {
        const Vec2f kick = kicks[lane];
        return {at.x + nm * kick.x, at.y + nm * kick.y};
    }
};

/// Samples the points. `nm`: wavelength of each sample. If a point lies beyond the film, the sample's own film point
/// replaces it, so that no light is lost at the margins.
template <int N>
REALCAM_HD inline void diffract(const CameraView& camera, const SampleBlock<N>& block, const float (&nm)[N],
                                DiffractedPoints<N>& film) {
    const DiffractionView view = camera.diffraction;
    const float reach_squared = view.largest_radius * view.largest_radius;
    const PixelPoints<N> samples(camera, block);
    const LaneNumbers<N> u(block, dimension::diffraction), v(block, dimension::diffraction + 1);
    REALCAM_LANES
    for (int i = 0; i < N; ++i) {
        const Vec2f point = samples[i];
        const DiffractionKick kick = draw_kick(view, point, u[i], v[i]);
        const Vec2f from = {point.x - nm[i] * kick.mm_per_nm.x, point.y - nm[i] * kick.mm_per_nm.y};
        const bool on_film = from.x * from.x + from.y * from.y < reach_squared;
        film.points.set(i, {select(on_film, from.x, point.x), select(on_film, from.y, point.y)});
        film.kicks.set(i, {select(on_film, kick.mm_per_nm.x, 0.0f), select(on_film, kick.mm_per_nm.y, 0.0f)});
        film.from_edge[i] = select(on_film, kick.from_edge, 0);
    }
}

}  // namespace REALCAM_NAMESPACE
