#pragma once

#include "../../camera/effects/ghosts/ghost_view.hpp"
#include "../../math/cdf.hpp"
#include "../../math/random.hpp"
#include "../../optics/trace/lens_trace.hpp"

namespace REALCAM_NAMESPACE {

// Ghost paths through the lens, for samples that start at the lights (splat_ghosts.hpp) and at the film
// (gather_ghosts.hpp). All samples of a block take the same path, so that they are vectorised.

/// Number of consecutive samples that take the same ghost path.
inline constexpr std::uint32_t kGhostBlock = 256;

/// Position in the sequence of ghost samples, which are counted over the whole film in blocks of kGhostBlock.
struct GhostRange {
    std::uint64_t first_block;  ///< index of the block
    std::uint32_t seed;
};

/// Properties that the samples of a block share.
struct GhostBlock {
    GhostLensPath path;
    std::int32_t path_index;  ///< index of `path` in GhostView::paths
    std::uint32_t stream, first_sample;  ///< random stream, and index in it of the block's first sample
};

/// Returns the first block of a range, and chooses its ghost path. A random sequence has 2^32 samples, which are 2^24
/// blocks; later blocks use another stream.
REALCAM_INLINE GhostBlock ghost_block(const GhostView& ghosts, GhostRange range) {
    const auto block = static_cast<std::uint32_t>(range.first_block);
    const std::uint32_t round = hash32(range.seed, static_cast<std::uint32_t>(range.first_block >> 24) + 1u);
    const int path_index = find_in_cdf(ghosts.cdf, ghosts.path_count, sample_2d(round, block, 0).x);
    return {ghosts.paths[path_index], path_index, hash32(static_cast<std::uint32_t>(path_index), round),
            block * kGhostBlock};
}

namespace ghost_lens_paths_detail {

/// Defensive mixture for sampling the entrance-pupil bounds (a rectangle), which a search with finitely many rays may
/// have found too small: a fraction kEnlarged of the samples is taken in the rectangle enlarged by kEnlargement about
/// its centre, a fraction kAnywhere in the square that contains the front of the lens, and all others in the rectangle.
inline constexpr float kEnlarged = 1.0f / 16, kAnywhere = 1.0f / 64, kEnlargement = 3;

}  // namespace ghost_lens_paths_detail

/// Point in the plane of a GhostBounds.
struct EntryPoint {
    float along, across;  ///< radial and tangential coordinates, mm
    float density;  ///< density with which the point was sampled, per mm^2
};

/// Samples a point for the bounds `entry` by the mixture above. `reach`: half the side of the square, mm; `u`: random
/// numbers in [0, 1).
REALCAM_INLINE EntryPoint entry_point(const GhostBounds& entry, float reach, Vec2f u) {
    using namespace ghost_lens_paths_detail;
    const bool is_known = entry.half_width > 0.0f;
    const float centre = 0.5f * (entry.low + entry.high), half_length = 0.5f * (entry.high - entry.low);
    const float anywhere = select(is_known, kAnywhere, 1.0f), enlarged = select(is_known, kEnlarged, 0.0f);
    const bool is_anywhere = u.x < anywhere, is_enlarged = u.x < anywhere + enlarged;
    const float begin = select(is_anywhere, 0.0f, select(is_enlarged, anywhere, anywhere + enlarged));
    const float share = select(is_anywhere, anywhere, select(is_enlarged, enlarged, 1.0f - anywhere - enlarged));
    const float scale = select(is_enlarged, kEnlargement, 1.0f), fresh = (u.x - begin) / share;
    const float along =
        select(is_anywhere, 0.0f, centre) + (2.0f * fresh - 1.0f) * select(is_anywhere, reach, scale * half_length);
    const float across = select(is_anywhere, 0.0f, entry.across) +
                         (2.0f * u.y - 1.0f) * select(is_anywhere, reach, scale * entry.half_width);
    const float from_centre = across - entry.across;
    const auto is_within = [&](float factor) {
        return (std::fabs(along - centre) <= factor * half_length) &
               (std::fabs(from_centre) <= factor * entry.half_width);
    };
    const float per_area = 1.0f / select(is_known, 4.0f * half_length * entry.half_width, 1.0f);
    const float density =
        select(is_known & is_within(1.0f), (1.0f - anywhere - enlarged) * per_area, 0.0f) +
        select(is_known & is_within(kEnlargement), enlarged * per_area / (kEnlargement * kEnlargement), 0.0f) +
        select((std::fabs(along) <= reach) & (std::fabs(across) <= reach), anywhere / (4.0f * reach * reach), 0.0f);
    return {along, across, density};
}

/// Traces rays along a ghost path through the lens. `rays`: in the lens frame; replaced by the rays behind the lens, or
/// marked with the reason why they ended. `variable`: dispersion variable of each ray's wavelength; unused without
/// wavelengths. `passed`: receives the fraction of each ray's power that passes.
template <LensKind lens_kind, bool has_wavelengths, int N>
REALCAM_INLINE void pass_ghost_lens_path(const GhostView& ghosts, const GhostLensPath& path, LensRays<float, N>& rays,
                                         const float (&variable)[N], PassedPower<N>& passed) {
    LensView<float> lens{ghosts.surfaces + path.first, path.count, ghosts.kind, ghosts.iris};
    if constexpr (lens_kind == LensKind::any) lens.free = ghosts.free.from(path.first);
    if constexpr (has_wavelengths) {
        if (ghosts.effects.coatings)
            trace_lens<lens_kind>(
                lens, rays, NoRecord{},
                GhostMedia<kGhostSpectrumTerms, N>{ghosts.indices + path.first, ghosts.spectral_coatings + path.first,
                                                   variable, passed});
        else
            trace_lens<lens_kind>(lens, rays, NoRecord{}, ManyWavelengths{ghosts.indices + path.first, variable});
    } else if (ghosts.effects.coatings) {
        trace_lens<lens_kind>(
            lens, rays, NoRecord{},
            GhostMedia<kOneWavelengthTerms, N>{nullptr, ghosts.coatings + path.first, nullptr, passed});
    } else {
        trace_lens<lens_kind>(lens, rays, NoRecord{}, OneWavelength{});
    }
}

}  // namespace REALCAM_NAMESPACE
