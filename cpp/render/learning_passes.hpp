#pragma once
#include <vector>

#include "../camera/pixel_pupil.hpp"
#include "../math/random.hpp"
#include "sample_range.hpp"

namespace REALCAM_NAMESPACE {

/// Divides a range into passes. Pixels learn after each pass. The knowledge of a sample must not depend on the
/// distribution of samples over threads, and therefore follows from its index alone. Each pass has its own random
/// numbers: samples of one sequence keep their distance from each other, so that those of the first ones would predict
/// where later ones are missing.
std::vector<SampleRange> learning_passes(const SampleRange& range);

}  // namespace REALCAM_NAMESPACE
