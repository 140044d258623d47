#pragma once
#include "generate_rays.hpp"

namespace REALCAM_NAMESPACE {

/// generate_rays of a full lens with coatings: the weights are less by what its surfaces do not pass on.
template <LensKind lens_kind = LensKind::any, int N>
REALCAM_HD inline void generate_coated_rays(const CameraView& camera, const SampleBlock<N>& block,
                                            CameraRays<N>& rays) {
    LensRays<float, N> inside;
    PassedPower<N> passed;
    start_lens_rays(camera, block, PixelPoints<N>{camera, block}, inside, rays);
    trace_lens<lens_kind>(
        camera.lens, inside, NoRecord{},
        CoatedMedia<OneWavelength, kOneWavelengthTerms, N>{{}, camera.coatings.one_wavelength, nullptr, passed});
    REALCAM_LANES
    for (int i = 0; i < N; ++i) rays.weight[i] *= select(inside.status[i] == 0, passed.of_unpolarised(i), 0.0f);
    place_lens_rays(camera, inside, rays);
}

}  // namespace REALCAM_NAMESPACE
