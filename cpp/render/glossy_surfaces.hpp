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

    REALCAM_INLINE void set(int slot, const SurfacePoint& point) {
        position.set(slot, point.position);
        geometric_normal.set(slot, point.geometric_normal);
        normal.set(slot, point.normal);
        self_offset[slot] = point.self_offset;
        is_glossy[slot] = realcam::is_glossy(point);
        set(slot, is_glossy[slot] ? glossy_surface(point) : GlossySurface{});
        if (!is_glossy[slot]) others.set(slot, point);
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
    REALCAM_INLINE RaySpawnPoint operator[](int slot) const {
        return {position[slot], geometric_normal[slot], self_offset[slot]};
    }
    REALCAM_INLINE GlossySurface glossy(int slot) const {
        return {base[slot], f0[slot], f90[slot], metallic[slot], alpha[slot]};
    }
    /// Computes the lobes once, because each step down the tree of lights reads them.
    REALCAM_INLINE void find_lobes(const PathState<N>& path) {
        const int slots = whole_vectors<N>(path.count);
        REALCAM_LANES
        for (int i = 0; i < slots; ++i) lobe_share[i] = light_lobe(glossy(i), normal[i], -path.rays.direction[i]).share;
    }
    REALCAM_INLINE LightLobe lobe(int slot, Vec3f to_eye) const { return {to_eye, alpha[slot], lobe_share[slot]}; }
    REALCAM_INLINE bool is_in_lanes(int slot) const { return is_glossy[slot] != 0; }

private:
    REALCAM_INLINE void set(int slot, const GlossySurface& surface) {
        base.set(slot, surface.base);
        f0.set(slot, surface.f0);
        f90[slot] = surface.f90;
        metallic[slot] = surface.metallic;
        alpha[slot] = surface.alpha;
    }
};

}  // namespace REALCAM_NAMESPACE
