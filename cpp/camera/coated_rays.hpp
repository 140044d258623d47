#pragma once
#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

/// Traces rays through the lens. `indices`: OneWavelength or ManyWavelengths. `passed`: transmitted fraction of each
/// ray's power; set only if the lens is `coated`.
template <LensKind lens_kind, bool coated, class Indices, int terms, int N>
REALCAM_HD inline void trace_surfaces(const LensView<float>& lens, LensRays<float, N>& rays, const Indices& indices,
                                      const CoatingPolynomials<terms>* coatings, const float* variable,
                                      float (&passed)[N]) {
    if constexpr (coated) {
        PassedPower<N> power;
        trace_lens<lens_kind>(lens, rays, NoRecord{},
                              CoatedMedia<Indices, terms, N>{indices, coatings, variable, power});
        REALCAM_LANES
        for (int i = 0; i < N; ++i) passed[i] = select(rays.status[i] == 0, power.of_unpolarised(i), 0.0f);
    } else {
        trace_lens<lens_kind>(lens, rays, NoRecord{}, indices);
    }
}

}  // namespace REALCAM_NAMESPACE
