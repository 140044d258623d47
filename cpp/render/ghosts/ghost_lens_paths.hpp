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

/// Ghost samples, counted over the whole film.
struct GhostRange {
    std::uint64_t first_block;
    std::uint32_t seed;
};

/// Properties that the samples of a block share.
struct GhostBlock {
    GhostLensPath path;
    std::int32_t number;  ///< index of that path
    std::uint32_t stream, first_sample;
};

/// The first block of a range. A sequence has 2^32 samples, 2^24 blocks.
REALCAM_INLINE GhostBlock ghost_block(const GhostView& ghosts, GhostRange range) {
    const auto block = static_cast<std::uint32_t>(range.first_block);
    const std::uint32_t round = hash32(range.seed, static_cast<std::uint32_t>(range.first_block >> 24) + 1u);
    const int number = find_in_cdf(ghosts.cdf, ghosts.path_count, sample_2d(round, block, 0).x);
    return {ghosts.paths[number], number, hash32(static_cast<std::uint32_t>(number), round), block * kGhostBlock};
}

namespace ghost_lens_paths_detail {

/// Fractions of the samples that enter in an enlarged entry rectangle, and anywhere on the plane, to find light that
/// the rectangles have missed. The rectangle is enlarged kAroundScale times.
inline constexpr float kAround = 1.0f / 16, kAnywhere = 1.0f / 64, kAroundScale = 3;

}  // namespace ghost_lens_paths_detail

/// Point in the plane of a GhostEntry.
struct EntryPoint {
    float along, across;  ///< radial and tangential coordinates, mm
    float density;  ///< per mm^2
};

REALCAM_INLINE EntryPoint entry_point(const GhostEntry& entry, float reach, Vec2f u) {
    using namespace ghost_lens_paths_detail;
    const bool known = entry.half_width > 0.0f;
    const float middle = 0.5f * (entry.low + entry.high), half_length = 0.5f * (entry.high - entry.low);
    const float anywhere = select(known, kAnywhere, 1.0f), around = select(known, kAround, 0.0f);
    const bool is_anywhere = u.x < anywhere, is_around = u.x < anywhere + around;
    const float begin = select(is_anywhere, 0.0f, select(is_around, anywhere, anywhere + around));
    const float share = select(is_anywhere, anywhere, select(is_around, around, 1.0f - anywhere - around));
    const float scale = select(is_around, kAroundScale, 1.0f), fresh = (u.x - begin) / share;
    const float along =
        select(is_anywhere, 0.0f, middle) + (2.0f * fresh - 1.0f) * select(is_anywhere, reach, scale * half_length);
    const float across = select(is_anywhere, 0.0f, entry.across) +
                         (2.0f * u.y - 1.0f) * select(is_anywhere, reach, scale * entry.half_width);
    const float beside = across - entry.across;
    const auto is_within = [&](float factor) {
        return (std::fabs(along - middle) <= factor * half_length) & (std::fabs(beside) <= factor * entry.half_width);
    };
    const float per_area = 1.0f / select(known, 4.0f * half_length * entry.half_width, 1.0f);
    const float density =
        select(known & is_within(1.0f), (1.0f - anywhere - around) * per_area, 0.0f) +
        select(known & is_within(kAroundScale), around * per_area / (kAroundScale * kAroundScale), 0.0f) +
        select((std::fabs(along) <= reach) & (std::fabs(across) <= reach), anywhere / (4.0f * reach * reach), 0.0f);
    return {along, across, density};
}

/// Traces rays along a ghost path. `variable`: dispersion variable of each ray's wavelength.
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
