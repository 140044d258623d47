#pragma once
#include "../scene/glossy_bsdf.hpp"
#include "shade_hits.hpp"

namespace REALCAM_NAMESPACE {

/// Surfaces that the paths of a block have hit in a scene that is not plain. Surfaces that GlossyBsdf describes are
/// stored in lanes; others are stored point by point, and their lanes are black.
template <int N>
struct GlossySurfaces {
    Vec3Lanes<float, N> position, geometric_normal, normal;
    ColorLanes<N> base, f0;
    Lanes<float, N> self_offset, f90, metallic, alpha;
    Lanes<std::int32_t, N> is_glossy;
    Lanes<float, N> lobe_share;  ///< LightLobe::share; set by find_lobes
    Surfaces<N> others;

    REALCAM_INLINE void set(int place, const SurfacePoint& point) {
        position.set(place, point.position);
        geometric_normal.set(place, point.geometric_normal);
        normal.set(place, point.normal);
        self_offset[place] = point.self_offset;
        is_glossy[place] = realcam::is_glossy(point);
        set(place, is_glossy[place] ? glossy_surface(point) : GlossySurface{});
        if (!is_glossy[place]) others.set(place, point);
    }
    /// Fills an unused slot with the values of a slot in use.
    REALCAM_INLINE void copy(int from, int to) {
        position.set(to, position[from]);
        geometric_normal.set(to, geometric_normal[from]);
        normal.set(to, normal[from]);
        self_offset[to] = self_offset[from];
        is_glossy[to] = 0;
        set(to, glossy(from));
    }
    REALCAM_INLINE SurfacePlace operator[](int place) const {
        return {position[place], geometric_normal[place], self_offset[place]};
    }
    REALCAM_INLINE GlossySurface glossy(int place) const {
        return {base[place], f0[place], f90[place], metallic[place], alpha[place]};
    }
    /// Computes the lobes once, because each step down the tree of lights reads them.
    REALCAM_INLINE void find_lobes(const PathState<N>& path) {
        const int places = whole_vectors<N>(path.count);
        REALCAM_LANES
        for (int i = 0; i < places; ++i)
            lobe_share[i] = light_lobe(glossy(i), normal[i], -path.rays.direction[i]).share;
    }
    REALCAM_INLINE LightLobe lobe(int place, Vec3f to_eye) const { return {to_eye, alpha[place], lobe_share[place]}; }
    REALCAM_INLINE bool is_in_lanes(int place) const { return is_glossy[place] != 0; }

private:
    REALCAM_INLINE void set(int place, const GlossySurface& surface) {
        base.set(place, surface.base);
        f0.set(place, surface.f0);
        f90[place] = surface.f90;
        metallic[place] = surface.metallic;
        alpha[place] = surface.alpha;
    }
};

}  // namespace REALCAM_NAMESPACE
