#pragma once
#include "../camera/camera_view.hpp"
#include "film_control_variates.hpp"
#include "sample_range.hpp"

namespace realcam {

/// True if samples also count for wavelengths in other pixels than their own (SampleSharing). All pixels must then draw
/// the same rays equally often, and the contributions of others must be balanced: no layer may need the variance of a
/// pixel's own samples, or those of half the pupil.
inline bool shares_samples(const CameraView& camera, const RenderSettings& settings, const PixelCounts& counts) {
    return camera.effects.share_pixels() && !counts.counts && !camera.pixel_pupils.known && camera.row_time == 0.0f &&
           balances_wavelengths(settings);
}

}  // namespace realcam
