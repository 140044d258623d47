#pragma once
#include <vector>

#include "../camera/pixel_pupil.hpp"
#include "../math/random.hpp"
#include "sample_range.hpp"

namespace REALCAM_NAMESPACE {

/// The passes of a range, after each of which pixels learn. What a sample knows must not depend on how samples are
/// spread over threads, and hangs together with its number alone. Each pass has random numbers of its own: samples of
/// one sequence keep away from each other, and what was learnt from the first of them would tell where the later ones
/// are not.
std::vector<SampleRange> learning_passes(const SampleRange& range);

}  // namespace REALCAM_NAMESPACE
