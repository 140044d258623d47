#pragma once
#include "../prescription/glass.hpp"

namespace REALCAM_NAMESPACE {

/// The glass of a melt whose index at the d line is larger by `index`, and whose Abbe number is larger by a share
/// `abbe` of itself. Both come out as asked, and between the lines the glass disperses as its formula does. Throws
/// InputError where that is no glass, and for a glass whose dispersion is not known where `abbe` is not 0.
Glass with_melt_error(const Glass& glass, double index, double abbe);

}  // namespace REALCAM_NAMESPACE
