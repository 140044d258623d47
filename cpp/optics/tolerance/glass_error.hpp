#pragma once
#include "../prescription/glass.hpp"

namespace REALCAM_NAMESPACE {

/// Returns the glass of a melt whose index at the d line is larger by `index` and whose Abbe number is larger by the
/// fraction `abbe`. Both are met exactly, and between the lines the dispersion follows the glass's formula. Throws
/// InputError if the result is no valid glass, or if `abbe` is not 0 and the glass's dispersion is unknown.
Glass with_melt_error(const Glass& glass, double index, double abbe);

}  // namespace REALCAM_NAMESPACE
